/** A body that points at something: the arm first, then the trunk, blended with what the gait does. */

import { type Body, hangOnChest, type Limb } from "./body";
import { Chain, type Frame, type Hinge } from "./hinges";
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
import {
  carried,
  copy,
  copyRotation,
  rotation,
  set,
  setRotation,
  times,
  type Vector,
  vector,
} from "./vectors";

/** Time to raise the arm, and to let it down. */
const RAISE_S = 0.6;
/** The arm goes over to where it is to point in this time. */
const FOLLOW_S = 0.25;
/** A pointing arm is not quite straight. */
const STRAIGHT = 0.985;
/** The other arm is taken when the target is so far on its side, radians. */
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

/** Hinges of the chain from which these hang. */
const AT_CHEST = 3;
const AT_SHOULDER = 6;
const AT_ELBOW = 9;
const AT_HAND = 10;

const X = { x: 1, y: 0, z: 0 };
const Y = { x: 0, y: 1, z: 0 };
const Z = { x: 0, y: 0, z: 1 };
const MINUS_X = { x: -1, y: 0, z: 0 };
const NOWHERE = { x: 0, y: 0, z: 0 };

const lumbar = vector();
const chest = rotation();
const turned = rotation();
const seen = vector();
const goal = vector();
const solved = new Float64Array(10);

export class Pointing {
  /** What is pointed at; null lets the arm down. */
  target: Vector | null = null;
  /** In the world: where the gait has the hand, and where it is to be. */
  readonly before = vector();
  readonly wanted = vector();
  private readonly chains = { left: new Chain(arm(1)), right: new Chain(arm(-1)) };
  private side: "left" | "right" = "left";
  private raised = 0;
  /** Where it points, from the foot of the spine: left, up, forward. */
  private readonly direction = vector();

  /** Whether any of it is to be seen. */
  get active(): boolean {
    return this.target !== null || this.raised > 0;
  }

  /** The hand that points, or last did. */
  hand(body: Body): Vector {
    return body[this.side].arm.end;
  }

  /** Move the trunk, the arm and the head of a body whose other joints are solved. */
  apply(body: Body, posture: Posture, build: Build, frameS: number): void {
    copy(body.lumbar, lumbar);
    copyRotation(body.chest, chest);
    this.follow(build, frameS);
    const chain = this.chains[this.side];
    const left = this.side === "left";
    const limb = body[this.side].arm;
    copy(limb.end, this.before);
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
        copy(seen, this.direction);
      } else if (wrong) up = false;
      const part = 1 - Math.exp(-frameS / FOLLOW_S);
      const { direction } = this;
      direction.x += (seen.x - direction.x) * part;
      direction.y += (seen.y - direction.y) * part;
      direction.z += (seen.z - direction.z) * part;
    }
    const step = frameS / RAISE_S;
    this.raised = Math.max(0, Math.min(1, this.raised + (up ? step : -step)));
  }

  /** Solve for a hand that is stretched out towards what is pointed at; writes `goal`. */
  private stretchOut(chain: Chain): void {
    const { direction } = this;
    chain.place();
    const shoulder = chain.pivots[AT_SHOULDER] ?? NOWHERE;
    const level = Math.hypot(direction.x, direction.z);
    const aside = Math.max(-SIDEWAYS, Math.min(SIDEWAYS, Math.atan2(direction.x, direction.z)));
    const x = level * Math.sin(aside) - shoulder.x;
    const y = direction.y - shoulder.y;
    const z = level * Math.cos(aside) - shoulder.z;
    const far = Math.max(1e-6, Math.hypot(x, y, z));
    const part = Math.min(far, STRAIGHT * (UPPER_ARM + FOREARM)) / far;
    set(goal, shoulder.x + x * part, shoulder.y + y * part, shoulder.z + z * part);
    chain.reach(goal, TOLERANCE, SWEEPS);
  }
}

/** Where the gait has trunk and arm, as far as `part` says. */
function relax(chain: Chain, { shoulder, elbow }: ArmPosture, side: number, part: number): void {
  const { angles } = chain;
  for (let k = 0; k < angles.length; k++) angles[k] = (angles[k] ?? 0) * (1 - part);
  angles[7] = (angles[7] ?? 0) + side * ARMS_OUT * part;
  angles[8] = (angles[8] ?? 0) + shoulder * part;
  angles[9] = (angles[9] ?? 0) + elbow * part;
  chain.place();
}

/** The body as the chain has it: first the chest, and what hangs on it, then the arm. */
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
  turnOf(upper);
  times(chest, turned, body.chest);
  // The spine bends in two places; the chest is drawn from where the upper one has it.
  inWorld(joint, build, body.lumbar);
  carried(body.lumbar, body.chest, 0, 0, -CHEST_UP * build.trunkM, body.lumbar);
  hangOnChest(posture, build, body);
  inWorld(start, build, limb.start);
  inWorld(hinge, build, limb.hinge);
  inWorld(end, build, limb.end);
  const [{ x, y, z }] = elbow;
  carried(NOWHERE, chest, z, x, y, limb.axis);
}

/** A point of the chain in the world. */
function inWorld({ x, y, z }: Vector, { trunkM }: Build, out: Vector): void {
  carried(lumbar, chest, z * trunkM, x * trunkM, y * trunkM, out);
}

/** A point of the world as the chain sees it. */
function inBody({ x, y, z }: Vector, { trunkM }: Build, out: Vector): void {
  setRotation(turned, chest.w, -chest.x, -chest.y, -chest.z);
  carried(NOWHERE, turned, x - lumbar.x, y - lumbar.y, z - lumbar.z, out);
  set(out, out.y / trunkM, out.z / trunkM, out.x / trunkM);
}

/** The rotation of a frame that is less than half turned, into `turned`. */
function turnOf([left, up, forward]: Frame): void {
  const w = Math.sqrt(Math.max(1e-6, 1 + forward.z + left.x + up.y)) / 2;
  setRotation(
    turned,
    w,
    (left.y - up.x) / (4 * w),
    (up.z - forward.y) / (4 * w),
    (forward.x - left.z) / (4 * w),
  );
}

/** From the foot of the spine by the chest to the hand; `side` is 1 for the left one. */
function arm(side: number): Hinge[] {
  const mirrored = ([low, high]: Limits): Limits => (side > 0 ? [low, high] : [-high, -low]);
  const spine = ([turn, lean, aside]: readonly Limits[], offset: Vector): Hinge[] => [
    hinge(Y, turn),
    hinge(X, lean),
    hinge(Z, aside, offset),
  ];
  return [
    ...spine(LUMBAR, { x: 0, y: CHEST_UP, z: 0 }),
    ...spine(CHEST, { x: side * SHOULDER_ASIDE, y: SHOULDER_UP - CHEST_UP, z: 0 }),
    hinge(Y, mirrored(TURN)),
    hinge(Z, mirrored(ASIDE)),
    hinge(MINUS_X, FLEXION, { x: 0, y: -UPPER_ARM, z: 0 }),
    hinge(MINUS_X, ELBOW, { x: 0, y: -FOREARM, z: 0 }),
  ];
}

function hinge(axis: Vector, limits: Limits | undefined, offset: Vector = NOWHERE): Hinge {
  const [low, high] = limits ?? [0, 0];
  return { axis, offset, low: (low * Math.PI) / 180, high: (high * Math.PI) / 180 };
}
