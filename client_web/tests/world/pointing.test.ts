import { describe, expect, it } from "vitest";
import type { Pose } from "../../src/world/interpolation";
import { buildOf, FOREARM, UPPER_ARM } from "../../src/world/skeleton";
import { Animator } from "../../src/world/animator";

const FRAME_S = 1 / 60;
const HERE: Pose = { x: 0, y: 0, z: 0, layer: 0, heading: 0, speed: 0, reason: 0 };

type Place = [x: number, y: number, z: number];

/** A body that has pointed at something for some seconds. */
function pointingAt([x, y, z]: Place, seconds = 3): Animator {
  const animator = new Animator(buildOf(0.9, 1.7), HERE);
  animator.pointing.target = { x, y, z };
  advance(animator, seconds);
  return animator;
}

function advance(animator: Animator, seconds: number): void {
  for (let i = 0; i * FRAME_S < seconds; i++) animator.advance(i * FRAME_S, HERE, FRAME_S);
}

describe("pointing", () => {
  it.each<[string, Place, "left" | "right"]>([
    ["ahead to the left", [5, 2, 1.5], "left"],
    ["to the right and up", [2, -4, 3], "right"],
    ["down before the feet", [1.5, 0.5, 0], "left"],
    ["to the side", [0, -5, 1.2], "right"],
  ])("stretches the arm out to what is %s", (_what, target, side) => {
    const { arm } = pointingAt(target).body[side];
    const [x, y, z] = target;
    const along = [arm.end.x - arm.start.x, arm.end.y - arm.start.y, arm.end.z - arm.start.z];
    const there = [x - arm.start.x, y - arm.start.y, z - arm.start.z];
    const dot = along.reduce((sum, value, i) => sum + value * (there[i] ?? 0), 0);
    const cosine = dot / (Math.hypot(...along) * Math.hypot(...there));
    expect(cosine).toBeGreaterThan(Math.cos(0.1));
  });

  it("keeps the bones of the arm as long as they are while it hangs", () => {
    const build = buildOf(0.9, 1.7);
    const { left, right } = pointingAt([5, 2, 1.5]).body;
    for (const { arm } of [left, right]) {
      expect(arm.start.distanceTo(arm.hinge)).toBeCloseTo(UPPER_ARM * build.trunkM);
      expect(arm.hinge.distanceTo(arm.end)).toBeCloseTo(FOREARM * build.trunkM);
    }
  });

  it("turns the trunk when the arm alone does not reach round", () => {
    const { chest } = pointingAt([-2, 4, 1.4]).body;
    expect(2 * Math.asin(chest.z)).toBeGreaterThan(0.1);
  });

  it("leaves legs and the other arm to the gait", () => {
    const animator = pointingAt([5, 2, 1.5]);
    const idle = new Animator(buildOf(0.9, 1.7), HERE);
    advance(idle, FRAME_S);
    expect(animator.body.left.leg).toEqual(idle.body.left.leg);
    expect(animator.body.right.arm.end.z).toBeCloseTo(idle.body.right.arm.end.z, 1);
  });

  it("raises the arm evenly, and lets it down", () => {
    const animator = new Animator(buildOf(0.9, 1.7), HERE);
    advance(animator, FRAME_S);
    const { end } = animator.body.left.arm;
    const hanging = end.clone();
    animator.pointing.target = { x: 5, y: 2, z: 1.5 };
    let before = hanging;
    let farthest = 0;
    const watch = (): void => {
      animator.advance(0, HERE, FRAME_S);
      farthest = Math.max(farthest, end.distanceTo(before));
      before = end.clone();
    };
    for (let i = 0; i < 120; i++) watch();
    animator.pointing.target = null;
    for (let i = 0; i < 120; i++) watch();
    expect(farthest).toBeLessThan(0.05);
    expect(animator.pointing.active).toBe(false);
    expect(end.z).toBeCloseTo(hanging.z);
  });

  it("looks at it", () => {
    const { head } = pointingAt([3, 2, 1.5]).body;
    expect(2 * Math.atan2(head.z, head.w)).toBeGreaterThan(0.4);
  });
});
