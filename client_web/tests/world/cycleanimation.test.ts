import { describe, expect, it } from "vitest";
import { body, solve } from "../../src/world/body";
import { CycleAnimation } from "../../src/world/cycleanimation";
import type { Pose } from "../../src/world/interpolation";
import { posture } from "../../src/world/posture";
import { buildOf } from "../../src/world/skeleton";

const BUILD = buildOf(0.9, 1.7);
const FRAME_S = 1 / 60;
const START: Pose = { x: 2, y: 3, z: 0, layer: 0, heading: 0, speed: 0, reason: 0 };

/** The frames that are drawn while somebody goes along x at a speed. */
function frames(speed: number, count: number): ReturnType<typeof body>[] {
  const cycle = new CycleAnimation(BUILD, START);
  return Array.from({ length: count }, (_, i) => {
    cycle.advance({ ...START, x: START.x + speed * i * FRAME_S }, FRAME_S);
    const [from, joints] = [posture(), body()];
    cycle.pose(from);
    solve(from, BUILD, joints);
    return joints;
  });
}

describe("a body without steps of its own", () => {
  it("stands on both feet when it does not move", () => {
    const last = frames(0, 30).at(-1);
    for (const foot of [last?.left.foot, last?.right.foot]) {
      expect(foot?.heel.z).toBeCloseTo(0, 2);
      expect(foot?.pitch).toBeCloseTo(0, 2);
    }
  });

  it.each([0.7, 1.3, 1.8])("swings the legs in turn at %f m/s", (speed) => {
    const ahead = frames(speed, 180)
      .slice(60)
      .map(({ left, right }) => left.foot.heel.x - right.foot.heel.x);
    expect(Math.max(...ahead)).toBeGreaterThan(0.3);
    expect(Math.min(...ahead)).toBeLessThan(-0.3);
  });

  it("keeps feet about where they come down, and out of the ground", () => {
    const walk = frames(1.3, 240).slice(60);
    const slides = walk.slice(1).flatMap(({ left: { foot } }, i) => {
      const before = walk[i]?.left.foot;
      const flat = Math.abs(foot.pitch) < 0.02 && foot.heel.z < 0.02;
      return before && flat ? [Math.abs(foot.heel.x - before.heel.x)] : [];
    });
    expect(slides.length).toBeGreaterThan(10);
    expect(slides.toSorted((a, b) => a - b)[slides.length >> 1]).toBeLessThan(0.006);
    for (const { left, right } of walk) {
      expect(Math.min(left.foot.toe.z, right.foot.toe.z)).toBeGreaterThan(-0.03);
    }
  });

  it("is lifted from tread to tread without a jump", () => {
    const cycle = new CycleAnimation(BUILD, START);
    let before = 0;
    for (let i = 0; i < 240; i++) {
      cycle.advance({ ...START, z: Math.floor(i / 20) * 0.17 }, FRAME_S);
      expect(cycle.place.z - before).toBeLessThan(0.04);
      before = cycle.place.z;
    }
  });
});
