import { beforeEach, describe, expect, it } from "vitest";
import type { StepRecord } from "../../src/net/steps";
import type { Foot } from "../../src/world/body";
import { buildOf } from "../../src/world/skeleton";
import { Animator } from "../../src/world/animator";
import { placeAt, SPEED_MPS, STEP_M, STEP_S, stepAlong } from "./walks";

const FRAME_S = 1 / 60;
/** More than somebody who walks moves in a frame, and less than a jump. */
const NO_JUMP_M = 3.2 * SPEED_MPS * FRAME_S;

let animator: Animator;
let timeS: number;

beforeEach(() => {
  animator = new Animator(buildOf(0.9, 1.7), placeAt(0));
  timeS = -FRAME_S;
});

/** Tell of a step that is to begin when `index` steps are over. */
function tell(index: number, record: StepRecord = stepAlong(index)): void {
  animator.add(record, index * STEP_S, (index + 1) * STEP_S);
}

/** Draw frames until a time, and look at each. */
function drawUntil(endS: number, look: () => void = () => undefined, snapshots = placeAt): void {
  while (timeS + FRAME_S < endS) {
    timeS += FRAME_S;
    animator.advance(timeS, snapshots(timeS), FRAME_S);
    look();
  }
}

/** Watches how far a point goes from frame to frame; says the farthest. */
function farthest(point: () => { x: number; y: number; z: number }): () => number {
  let before: { x: number; y: number; z: number } | null = null;
  let most = 0;
  return () => {
    const { x, y, z } = point();
    if (before) most = Math.max(most, Math.hypot(x - before.x, y - before.y, z - before.z));
    before = { x, y, z };
    return most;
  };
}

const standing = (): Foot => {
  const { left, right } = animator.body;
  return animator.step?.rightStands ? right.foot : left.foot;
};

describe("a walker", () => {
  it("keeps the standing foot where it is", () => {
    tell(0);
    drawUntil(0.1);
    for (let index = 0; index < 6; index++) {
      const { x, y } = stepAlong(index).standing;
      tell(index + 1);
      drawUntil((index + 1) * STEP_S, () => {
        if (timeS <= index * STEP_S + FRAME_S) return;
        expect(Math.hypot(standing().heel.x - x, standing().heel.y - y)).toBeLessThan(1e-6);
      });
    }
  });

  it("is where its hips are, for camera and labels", () => {
    tell(0);
    drawUntil(0.4);
    const pose = animator.advance(timeS, placeAt(timeS), 0);
    expect(pose.x).toBe(animator.body.root.x);
    expect(pose.z).toBe(0);
  });

  it("waits for a step that is late, and catches up without a jump", () => {
    tell(0);
    const hips = farthest(() => animator.body.root);
    drawUntil(STEP_S + 0.12, hips);
    tell(1);
    expect(animator.body.root.x).toBeCloseTo(STEP_M / 2);
    drawUntil(2 * STEP_S - 0.05, hips);
    tell(2);
    drawUntil(2.8 * STEP_S, hips);
    expect(hips()).toBeLessThan(1.3 * SPEED_MPS * FRAME_S);
    expect(animator.body.root.x).toBeCloseTo(placeAt(timeS).x, 2);
  });

  it("fades to a step that is far too late", () => {
    tell(0);
    const hips = farthest(() => animator.body.root);
    drawUntil(STEP_S + 0.45, hips, () => ({ ...placeAt(0), x: STEP_M / 2, speed: 0 }));
    tell(1);
    drawUntil(2 * STEP_S, hips);
    expect(hips()).toBeLessThan(4 * SPEED_MPS * FRAME_S);
  });

  it("begins with steps in the midst of one without a jump", () => {
    const hips = farthest(() => animator.body.root);
    drawUntil(1.3 * STEP_S, hips);
    tell(1);
    drawUntil(2 * STEP_S, hips);
    expect(animator.step).not.toBeNull();
    expect(hips()).toBeLessThan(NO_JUMP_M);
  });

  it("goes on along its snapshots when no more steps are told", () => {
    tell(0);
    const hips = farthest(() => animator.body.root);
    const heel = farthest(() => animator.body.left.foot.heel);
    drawUntil(5 * STEP_S, () => {
      hips();
      heel();
    });
    expect(animator.step).toBeNull();
    expect(animator.body.root.x).toBeCloseTo(placeAt(timeS).x, 0);
    // The missed part is walked in the time of the fading.
    expect(hips()).toBeLessThan(0.12);
    expect(heel()).toBeLessThan(0.2);
  });

  it("stands in the pose in which its last step ended", () => {
    tell(0);
    const stopped = { ...placeAt(0), x: STEP_M / 2, speed: 0 };
    drawUntil(20 * STEP_S, undefined, () => stopped);
    expect(animator.step).not.toBeNull();
    expect(animator.body.root.x).toBeCloseTo(STEP_M / 2);
  });

  it("takes another way in the midst of a step", () => {
    tell(0);
    drawUntil(0.2);
    const aimed = stepAlong(0, {
      continues: true,
      landing: { x: 0.4, y: 0.2, z: 0, heading: 0.5 },
    });
    animator.add(aimed, 0.25, STEP_S);
    drawUntil(STEP_S + 0.1);
    expect(animator.body.right.foot.heel.x).toBeCloseTo(0.4);
    expect(animator.body.right.foot.heel.y).toBeCloseTo(0.2);
  });

  it("is put elsewhere at once", () => {
    tell(0);
    drawUntil(0.3);
    const away = stepAlong(0, { ticks: 0, standing: { x: 20, y: 5.1, z: 3, heading: 0 } });
    away.landing = { x: 20, y: 4.9, z: 3, heading: 0 };
    animator.add(away, 0.3, 0.3);
    drawUntil(0.34);
    expect(animator.body.root.z).toBeGreaterThan(3.5);
    expect(standing().heel.x).toBeCloseTo(20);
  });
});
