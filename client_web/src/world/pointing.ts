/** A body that points at something: first the arm, then the trunk, both blended with the gait. */

import { Quaternion, Vector3, type Vector3Like } from "three";
import { type Body, hangOnChest, type Limb } from "./body";
import { Chain, type Hinge } from "./hinges";
import { transformPoint } from "./rotations";
import { smooth } from "./steps";
import type { ArmPosture, Posture } from "./posture";
import {
  ARMS_OUT,
  type Build,
  CHEST_UP,
  FOREARM,
  SHOULDER_ASIDE,
  SHOULDER_UP,
  UPPER_ARM,
} from "./skeleton";

/** Time to raise the arm, and to let it down. */
const RAISE_S = 0.6;
/** The arm goes over to where it is to point in this time. */
const FOLLOW_S = 0.25;
/** A pointing arm is not quite straight. */
const STRAIGHT = 0.985;
/** The other arm is taken when the target is this far on its side, radians. */
const OTHER_ARM = 0.4;
/** Further round than this nobody points without turning the feet, radians. */
const SIDEWAYS = 2;
const TOLERANCE = 1e-3;
const SWEEPS = 4;

type Limits = readonly [low: number, high: number];

/** Turn, lean forward and bend aside of the spine, at its foot and at the chest; degrees. */
const LUMBAR: readonly Limits[] = [
  [-30, 30],
  [-20, 45],
  [-20, 20],
];
const CHEST: readonly Limits[] = [
  [-30, 30],
  [-20, 40],
  [-20, 20],
];
/** Turn and lead aside of the left shoulder; flexion; the elbow. */
const TURN: Limits = [-70, 70];
const ASIDE: Limits = [-30, 90];
const FLEXION: Limits = [-50, 170];
const ELBOW: Limits = [0, 145];

/** Indices in the chain of the first hinge of each joint, and of the hand. */
const AT_CHEST = 3;
const AT_SHOULDER = 6;
const AT_ELBOW = 9;
const AT_HAND = 10;

const X = new Vector3(1, 0, 0);
const Y = new Vector3(0, 1, 0);
const Z = new Vector3(0, 0, 1);
const MINUS_X = new Vector3(-1, 0, 0);
const NOWHERE = new Vector3();

const lumbar = new Vector3();
const chest = new Quaternion();
const turned = new Quaternion();
const seen = new Vector3();
const goal = new Vector3();
const solved = new Float64Array(10);

export class Pointing {
  /** The target; null lets the arm down. */
  target: Vector3Like | null = null;
  /** The places in the world where the gait has the hand, and where it is to be. */
  readonly before = new Vector3();
  readonly wanted = new Vector3();
  private readonly chains = { left: new Chain(arm(1)), right: new Chain(arm(-1)) };
  private side: "left" | "right" = "left";
  private raised = 0;
  /** The direction from the foot of the spine to the target: left, up, forward. */
  private readonly direction = new Vector3();

  /** Whether any of it is to be seen. */
  get active(): boolean {
    return this.target !== null || this.raised > 0;
  }

  /** The arm that points; null while none does. */
  limb(body: Body): Limb | null {
    return this.active ? body[this.side].arm : null;
  }

  /** The hand that points, or last did. */
  hand(body: Body): Vector3 {
    return body[this.side].arm.end;
  }

  /** Move the trunk, the arm and the head of a body whose other joints are solved. */
  apply(body: Body, posture: Posture, build: Build, frameS: number): void {
    lumbar.copy(body.lumbar);
    chest.copy(body.chest);
    this.follow(build, frameS);
    const chain = this.chains[this.side];
    const left = this.side === "left";
    const limb = body[this.side].arm;
    this.before.copy(limb.end);
    this.stretchOut(chain);
    inWorld(goal, build, this.wanted);
    solved.set(chain.angles);
    relax(chain, left ? posture.leftArm : posture.rightArm, left ? 1 : -1, 1 - smooth(this.raised));
    takeOver(chain, body, limb, posture, build);
    // The next frame goes on from what was found, so that the arm moves evenly.
    chain.angles.set(solved);
  }

  /** Raise or lower the arm; another arm only when this one hangs. */
  private follow(build: Build, frameS: number): void {
    let up = this.target !== null;
    if (this.target) {
      inBody(this.target, build, seen);
      const aside = Math.atan2(seen.x, seen.z);
      const wrong = this.side === "left" ? aside < -OTHER_ARM : aside > OTHER_ARM;
      if (this.raised === 0) {
        this.side = aside > 0 ? "left" : "right";
        this.chains[this.side].angles.fill(0);
        this.direction.copy(seen);
      } else if (wrong) up = false;
      this.direction.lerp(seen, 1 - Math.exp(-frameS / FOLLOW_S));
    }
    const step = frameS / RAISE_S;
    this.raised = Math.max(0, Math.min(1, this.raised + (up ? step : -step)));
  }

  /** Solve for a hand that is stretched out towards the target; writes `goal`. */
  private stretchOut(chain: Chain): void {
    const { direction } = this;
    chain.place();
    const shoulder = chain.pivots[AT_SHOULDER] ?? NOWHERE;
    const level = Math.hypot(direction.x, direction.z);
    const aside = Math.max(-SIDEWAYS, Math.min(SIDEWAYS, Math.atan2(direction.x, direction.z)));
    goal.set(level * Math.sin(aside), direction.y, level * Math.cos(aside)).sub(shoulder);
    const far = Math.max(1e-6, goal.length());
    const part = Math.min(far, STRAIGHT * (UPPER_ARM + FOREARM)) / far;
    goal.multiplyScalar(part).add(shoulder);
    chain.reach(goal, TOLERANCE, SWEEPS);
  }
}

/** Blend trunk and arm with the gait's, by the share `part`. */
function relax(chain: Chain, { shoulder, elbow }: ArmPosture, side: number, part: number): void {
  const { angles } = chain;
  for (let k = 0; k < angles.length; k++) angles[k] = (angles[k] ?? 0) * (1 - part);
  angles[7] = (angles[7] ?? 0) + side * ARMS_OUT * part;
  angles[8] = (angles[8] ?? 0) + shoulder * part;
  angles[9] = (angles[9] ?? 0) + elbow * part;
  chain.place();
}

/** Write the chain's pose into the body: first the chest and everything on it, then the arm. */
function takeOver(
  { pivots, frames }: Chain,
  body: Body,
  limb: Limb,
  posture: Posture,
  build: Build,
): void {
  const [joint, upper, elbow] = [pivots[AT_CHEST], frames[AT_SHOULDER], frames[AT_ELBOW]];
  const [start, hinge, end] = [pivots[AT_SHOULDER], pivots[AT_ELBOW], pivots[AT_HAND]];
  if (!joint || !upper || !elbow || !start || !hinge || !end) return;
  turned.set(upper.z, upper.x, upper.y, upper.w);
  body.chest.multiplyQuaternions(chest, turned);
  // The spine bends in two places; the chest is drawn from where the upper one has it.
  inWorld(joint, build, body.lumbar);
  transformPoint(body.lumbar, body.chest, 0, 0, -CHEST_UP * build.trunkM, body.lumbar);
  hangOnChest(posture, build, body);
  inWorld(start, build, limb.start);
  inWorld(hinge, build, limb.hinge);
  inWorld(end, build, limb.end);
  forwardsFirst(limb.axis.copy(X).applyQuaternion(elbow), limb.axis).applyQuaternion(chest);
}

/** A point of the chain in the world. */
function inWorld(point: Vector3, { trunkM }: Build, out: Vector3): void {
  forwardsFirst(point, out).multiplyScalar(trunkM).applyQuaternion(chest).add(lumbar);
}

/** A point of the world as the chain sees it. */
function inBody(point: Vector3Like, { trunkM }: Build, out: Vector3): void {
  out.subVectors(point, lumbar).applyQuaternion(turned.copy(chest).conjugate());
  out.set(out.y, out.z, out.x).divideScalar(trunkM);
}

/** From the chain's axes, which are left, up, forward, to a body's: forward, left, up. */
function forwardsFirst({ x, y, z }: Vector3, out: Vector3): Vector3 {
  return out.set(z, x, y);
}

/** From the foot of the spine by the chest to the hand; `side` is 1 for the left one. */
function arm(side: number): Hinge[] {
  const mirrored = ([low, high]: Limits): Limits => (side > 0 ? [low, high] : [-high, -low]);
  const spine = ([turn, lean, aside]: readonly Limits[], offset: Vector3): Hinge[] => [
    hinge(Y, turn),
    hinge(X, lean),
    hinge(Z, aside, offset),
  ];
  return [
    ...spine(LUMBAR, new Vector3(0, CHEST_UP, 0)),
    ...spine(CHEST, new Vector3(side * SHOULDER_ASIDE, SHOULDER_UP - CHEST_UP, 0)),
    hinge(Y, mirrored(TURN)),
    hinge(Z, mirrored(ASIDE)),
    hinge(MINUS_X, FLEXION, new Vector3(0, -UPPER_ARM, 0)),
    hinge(MINUS_X, ELBOW, new Vector3(0, -FOREARM, 0)),
  ];
}

function hinge(axis: Vector3, limits: Limits | undefined, offset: Vector3 = NOWHERE): Hinge {
  const [low, high] = limits ?? [0, 0];
  return { axis, offset, low: (low * Math.PI) / 180, high: (high * Math.PI) / 180 };
}
