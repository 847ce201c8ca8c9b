/**
 * The animation of one avatar's body: by its steps where the server sends them, else along its
 * snapshots with the common gait cycle. One takes over from the other by fading, never by a jump.
 */

import { Quaternion } from "three";
import type { StepRecord } from "../net/steps";
import { mixAngles, wrapAngle } from "./angles";
import { type Body, body, solve } from "./body";
import { CycleAnimation } from "./cycleanimation";
import { Gesturing } from "./gestures";
import { copyPose, type Pose } from "./interpolation";
import { mixPostures, type Posture, posture } from "./posture";
import { Pointing } from "./pointing";
import { headingOf, UP } from "./rotations";
import type { Build } from "./skeleton";
import { readyToDraw, smooth, type Step, underWay } from "./steps";

/** This many steps are kept, because the drawn time lies a little in the past. */
const MOST_STEPS = 6;
const FADE_S = 0.3;
/** A step that comes too late begins late, and the body hurries by this part to catch up. */
const HURRY = 0.2;
/** A body waits for a step no longer than this, and fades to it if it comes later. */
const LATEST_S = 0.4;
/** Steps are ignored when they have been over for this long and the avatar is elsewhere. */
const SILENT_S = 0.4;
const ELSEWHERE_M = 0.35;
/** A greater distance is no walk: the avatar was put somewhere else. */
const JUMP_M = 1.5;
const SAME_S = 1e-6;
const SAME_M = 1e-3;
/** A head is turned no further against the chest, and turns with this time constant. */
const LOOK_RAD = 1.1;
const LOOK_S = 0.12;

const turned = new Quaternion();

/** A step and the time at which it begins and ends. */
interface Timed {
  readonly step: Step;
  readonly beginS: number;
  readonly endS: number;
  /** Its beginning was not known in time. */
  readonly missed: boolean;
}

export class Animator {
  readonly body: Body = body();
  /** The posture from which the joints were solved. */
  readonly posture: Posture = posture();
  readonly pointing = new Pointing();
  readonly gesturing = new Gesturing();
  private readonly steps: Timed[] = [];
  private readonly cycle: CycleAnimation;
  private readonly from: Posture = posture();
  /** The step that is drawn; null stands for the common cycle. */
  private drawn: Timed | null = null;
  /** The step that is faded from; null stands for the common cycle. */
  private fading: Timed | null = null;
  private fadeLeftS = 0;
  /** The body is drawn later than it should be by this. */
  private lagS = 0;
  /** The head is turned against the chest by this angle. */
  private gaze = 0;
  private timeS = -Infinity;
  private readonly place: Pose;

  constructor(
    readonly build: Build,
    start: Pose,
  ) {
    this.cycle = new CycleAnimation(build, start);
    this.place = { ...start };
    this.cycle.pose(this.posture);
    solve(this.posture, build, this.body);
  }

  /** The step that is drawn, with both its footprints; null while no steps are known. */
  get step(): Step | null {
    return this.drawn?.step ?? null;
  }

  /** Whether the standing foot is where its step has it, and not on its way there. */
  get planted(): boolean {
    const { drawn, fading } = this;
    if (!drawn) return false;
    return this.fadeLeftS <= 0 || (fading !== null && apartM(fading, drawn, "standing") < SAME_M);
  }

  /** A step begins at `beginS`; one that was known to begin then or later is void. */
  add(record: StepRecord, beginS: number, endS: number): void {
    while ((this.steps.at(-1)?.beginS ?? -Infinity) >= beginS) this.steps.pop();
    const lateS = this.timeS - beginS;
    const waited = this.drawn !== null && this.drawn.endS <= beginS + SAME_S;
    const waits = lateS > 0 && waited && this.lagS + lateS < LATEST_S;
    if (waits) {
      this.lagS += lateS;
      this.timeS = beginS;
    }
    const step = readyToDraw(record, this.build);
    this.steps.push({ step, beginS, endS, missed: lateS > 0 && !waits });
    if (this.steps.length > MOST_STEPS) this.steps.shift();
  }

  /** Write the body at `timeS`; returns its pose, given the pose of its snapshots. */
  advance(timeS: number, snapshots: Readonly<Pose>, frameS: number): Pose {
    const fresh = this.timeS === -Infinity;
    this.lagS = Math.max(0, this.lagS - HURRY * frameS);
    this.timeS = timeS - this.lagS;
    // Of somebody who walks by steps, snapshots tell seldom.
    this.cycle.advance(this.walksBySteps ? this.place : snapshots, frameS);
    const next = this.chosen(snapshots);
    if (fresh) this.drawn = next;
    else this.choose(next);
    this.show(this.drawn, this.posture);
    if (this.fadeLeftS > 0) {
      this.fadeLeftS -= frameS;
      this.show(this.fading, this.from);
      const part = smooth(1 - this.fadeLeftS / FADE_S);
      mixPostures(this.from, this.posture, part, this.posture);
    }
    this.gesturing.lean(this.posture, frameS);
    solve(this.posture, this.build, this.body);
    const { pointing, gesturing } = this;
    if (pointing.active) pointing.apply(this.body, this.posture, this.build, frameS);
    if (gesturing.active) gesturing.apply(this.body, this.build, pointing.limb(this.body));
    const { drawn } = this;
    const heading = drawn && this.walksBySteps ? drawn.step.landing.heading : snapshots.heading;
    this.look(heading, frameS);
    return this.placed(snapshots);
  }

  /** Whether a step is under way at the drawn time. */
  private get walksBySteps(): boolean {
    return this.drawn !== null && this.timeS < this.drawn.endS;
  }

  /** Turn the head to the target of pointing, else to where the feet will turn. */
  private look(heading: number, frameS: number): void {
    const { target } = this.pointing;
    const { chest, neck, head } = this.body;
    const wanted = target ? Math.atan2(target.y - neck.y, target.x - neck.x) : heading;
    const aside = Math.max(-LOOK_RAD, Math.min(LOOK_RAD, wrapAngle(wanted - headingOf(chest))));
    this.gaze += (aside - this.gaze) * (1 - Math.exp(-frameS / LOOK_S));
    head.premultiply(turned.setFromAxisAngle(UP, this.gaze));
  }

  private chosen(snapshots: Readonly<Pose>): Timed | null {
    let chosen: Timed | null = null;
    for (const each of this.steps) if (each.beginS <= this.timeS) chosen = each;
    if (!chosen) return null;
    const { landing, standing } = chosen.step;
    const silent = this.timeS > chosen.endS + SILENT_S;
    const awayM = Math.hypot(
      (landing.x + standing.x) / 2 - snapshots.x,
      (landing.y + standing.y) / 2 - snapshots.y,
    );
    return silent && awayM > ELSEWHERE_M ? null : chosen;
  }

  /** Draw another step, or the cycle, from now on; steps that join need no fading. */
  private choose(next: Timed | null): void {
    const before = this.drawn;
    if (next === before) return;
    this.drawn = next;
    if (before && next && joins(before, next)) return;
    this.show(next, this.from);
    const leapM = this.from.root.distanceTo(this.posture.root);
    this.fading = before;
    this.fadeLeftS = leapM < JUMP_M ? FADE_S : 0;
  }

  private show(what: Timed | null, out: Posture): void {
    if (!what) {
      this.cycle.pose(out);
      return;
    }
    const { step, beginS, endS } = what;
    const u = endS > beginS ? (this.timeS - beginS) / (endS - beginS) : 1;
    underWay(step, u, this.build, out);
  }

  /** The pose for labels, camera and map: under the middle of the hips, at the feet's height. */
  private placed(snapshots: Readonly<Pose>): Pose {
    const { place, drawn } = this;
    const { root } = this.body;
    place.layer = snapshots.layer;
    place.speed = snapshots.speed;
    place.reason = snapshots.reason;
    if (!drawn) {
      copyPose(this.cycle.place, place);
      return place;
    }
    const { standing, landing } = drawn.step;
    const u = smooth((this.timeS - drawn.beginS) / Math.max(drawn.endS - drawn.beginS, 1e-6));
    place.x = root.x;
    place.y = root.y;
    place.z = standing.z + (landing.z - standing.z) * u;
    place.heading = mixAngles(standing.heading, landing.heading, u);
    return place;
  }
}

/** Whether the second step goes on where the first ends. */
function joins(first: Timed, second: Timed): boolean {
  if (second.missed) return false;
  return apartM(first, second, second.step.continues ? "standing" : "landing") < SAME_M;
}

/** From one of the first step's footprints to where the second one stands. */
function apartM({ step }: Timed, next: Timed, foot: "standing" | "landing"): number {
  const { x, y, z } = step[foot];
  const { standing } = next.step;
  return Math.hypot(x - standing.x, y - standing.y, z - standing.z);
}
