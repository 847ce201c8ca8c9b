/**
 * Gestures: hands go where the gesture has them, by inverse kinematics of the arm, and the trunk moves
 * over feet that stay where the gait has them.
 */

import { Quaternion, Vector3 } from "three";
import type { GestureName } from "../net/messages";
import type { Body, Limb } from "./body";
import type { Posture } from "./posture";
import { headingOf, transformPoint, UP } from "./rotations";
import { type Build, FOREARM, SHOULDER_ASIDE, SHOULDER_UP, UPPER_ARM } from "./skeleton";
import { smooth } from "./steps";

const BEGIN_S = 0.45;
const END_S = 0.5;
/** An arm is stretched no further. */
const REACH = 0.985;
const TURN = 2 * Math.PI;

/** A point beside a shoulder, shares of the trunk: forwards, outwards and up. */
type Hand = readonly [ahead: number, aside: number, up: number];

/** The moment of a gesture: what moves, and by how much. */
interface Moment {
  /** The hand that gestures, and the other one; null leaves it to the gait. */
  hand: Hand | null;
  other: Hand | null;
  /** The head is bent forwards, and the chest turned to the left; radians. */
  nod: number;
  twist: number;
  /** The hips move to the left and up, metres. */
  sway: number;
  bob: number;
}

interface Kind {
  readonly seconds: number;
  /** `swing` of an angle is its sine, or 0 for those who want no motion. */
  at(timeS: number, swing: (turns: number) => number): Partial<Moment>;
}

const KINDS: Record<GestureName, Kind> = {
  wave: {
    seconds: 2.6,
    at: (timeS, swing) => ({ hand: [0.14, 0.14 + 0.13 * swing(2 * timeS), 0.46] }),
  },
  nod: { seconds: 1.5, at: (timeS, swing) => ({ nod: 0.16 + 0.2 * swing(1.6 * timeS - 0.25) }) },
  point: { seconds: 3, at: () => ({ hand: [0.6, -0.06, 0.02] }) },
  clap: {
    seconds: 2.4,
    at: (timeS, swing) => {
      const hand: Hand = [0.4, 0.08 + 0.07 * swing(2.8 * timeS) - SHOULDER_ASIDE, -0.06];
      return { hand, other: hand };
    },
  },
  dance: {
    seconds: 8,
    at: (timeS, swing) => ({
      hand: [0.26, 0.1, -0.04 + 0.2 * swing(timeS)],
      other: [0.26, 0.1, -0.04 - 0.2 * swing(timeS)],
      twist: 0.3 * swing(timeS),
      sway: 0.05 * swing(timeS + 0.25),
      bob: -0.03 + 0.03 * swing(2 * timeS),
    }),
  },
  raise_hand: { seconds: 12, at: () => ({ hand: [0.06, 0.02, 0.58] }) },
};

const STILL: Moment = { hand: null, other: null, nod: 0, twist: 0, sway: 0, bob: 0 };
const LEFTWARDS = new Vector3(0, 1, 0);
/** Elbows point outwards, backwards and down. */
const POLE = { ahead: -0.5, aside: 0.7, up: -0.6 } as const;

const turned = new Quaternion();
const goal = new Vector3();
const along = new Vector3();
const pole = new Vector3();
const elbow = new Vector3();

export class Gesturing {
  private kind: Kind | null = null;
  private timeS = 0;
  private calm = false;
  private weight = 0;
  private moment: Moment = STILL;

  get active(): boolean {
    return this.kind !== null;
  }

  /** Begin a gesture; one that is under way ends. `calm` holds it still instead of moving on and on. */
  start(gesture: GestureName, calm: boolean): void {
    this.kind = KINDS[gesture];
    this.timeS = 0;
    this.calm = calm;
  }

  /** Go on by a frame, and move hips and chest of a posture whose joints are to be solved yet. */
  lean(posture: Posture, frameS: number): void {
    const { kind } = this;
    if (!kind) return;
    this.timeS += frameS;
    if (this.timeS >= kind.seconds) {
      this.kind = null;
      return;
    }
    const { timeS, calm } = this;
    this.weight = smooth(Math.min(1, timeS / BEGIN_S, (kind.seconds - timeS) / END_S));
    const swing = (turns: number): number => (calm ? 0 : Math.sin(TURN * turns));
    this.moment = { ...STILL, ...kind.at(timeS, swing) };
    const { twist, sway, bob } = this.moment;
    const heading = headingOf(posture.pelvis);
    posture.root.x -= Math.sin(heading) * sway * this.weight;
    posture.root.y += Math.cos(heading) * sway * this.weight;
    posture.root.z += bob * this.weight;
    posture.chest.premultiply(turned.setFromAxisAngle(UP, twist * this.weight));
  }

  /** Move arms and head of a body whose other joints are solved; `busy` is an arm that points. */
  apply(body: Body, build: Build, busy: Limb | null): void {
    const { hand, other, nod } = this.moment;
    const leads = busy === body.right.arm ? 1 : -1;
    if (hand) this.reach(body, build, leads, hand);
    if (other && busy === null) this.reach(body, build, -leads, other);
    if (nod !== 0) {
      body.head.multiply(turned.setFromAxisAngle(LEFTWARDS, nod * this.weight));
    }
  }

  /** Lead a hand to its place by the cosine law; `side` is 1 for the left one. */
  private reach(
    { lumbar, chest, left, right }: Body,
    { trunkM }: Build,
    side: number,
    [ahead, aside, up]: Hand,
  ): void {
    const { start, hinge, end, axis } = (side > 0 ? left : right).arm;
    const { weight } = this;
    const y = side * (SHOULDER_ASIDE + aside) * trunkM;
    transformPoint(lumbar, chest, ahead * trunkM, y, (SHOULDER_UP + up) * trunkM, goal);
    pole.set(POLE.ahead, side * POLE.aside, POLE.up).applyQuaternion(chest);
    elbow.lerpVectors(start, end, 0.5).sub(hinge).negate().normalize();
    pole.lerp(elbow, 1 - weight);
    goal.lerpVectors(end, goal, weight);
    const [upperM, foreM] = [UPPER_ARM * trunkM, FOREARM * trunkM];
    along.subVectors(goal, start);
    const farM = Math.max(
      1.05 * (upperM - foreM),
      Math.min(along.length(), REACH * (upperM + foreM)),
    );
    along.normalize();
    pole.addScaledVector(along, -pole.dot(along)).normalize();
    const alongM = (farM ** 2 + upperM ** 2 - foreM ** 2) / (2 * farM);
    const asideM = Math.sqrt(Math.max(0, upperM ** 2 - alongM ** 2));
    hinge.copy(start).addScaledVector(along, alongM).addScaledVector(pole, asideM);
    end.copy(start).addScaledVector(along, farM);
    axis.crossVectors(along, pole);
  }
}
