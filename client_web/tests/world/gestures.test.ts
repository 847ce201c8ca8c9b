import { describe, expect, it } from "vitest";
import type { GestureName } from "../../src/net/messages";
import { Animator } from "../../src/world/animator";
import type { Body } from "../../src/world/body";
import type { Pose } from "../../src/world/interpolation";
import { buildOf, FOREARM, UPPER_ARM } from "../../src/world/skeleton";

const FRAME_S = 1 / 60;
const HERE: Pose = { x: 0, y: 0, z: 0, layer: 0, heading: 0, speed: 0, reason: 0 };
const BUILD = buildOf(0.9, 1.7);
const ALL: GestureName[] = ["wave", "nod", "point", "clap", "dance", "raise_hand"];

/** Draw a gesture for so long, and look at each frame. */
function make(
  gesture: GestureName,
  seconds: number,
  look: (body: Body, animator: Animator) => void = () => undefined,
  calm = false,
): Animator {
  const animator = new Animator(BUILD, HERE);
  animator.advance(0, HERE, FRAME_S);
  animator.gesturing.start(gesture, calm);
  for (let k = 1; k * FRAME_S < seconds; k++) {
    animator.advance(k * FRAME_S, HERE, FRAME_S);
    look(animator.body, animator);
  }
  return animator;
}

describe.each(ALL)("%s", (gesture) => {
  it("keeps bones as long as they are, and feet where they stand", () => {
    const before = new Animator(BUILD, HERE).body;
    make(gesture, 13, ({ left, right }) => {
      for (const { arm } of [left, right]) {
        expect(arm.start.distanceTo(arm.hinge)).toBeCloseTo(UPPER_ARM * BUILD.trunkM, 6);
        expect(arm.hinge.distanceTo(arm.end)).toBeCloseTo(FOREARM * BUILD.trunkM, 6);
      }
      expect(left.foot.heel.distanceTo(before.left.foot.heel)).toBeLessThan(1e-3);
      expect(right.foot.heel.distanceTo(before.right.foot.heel)).toBeLessThan(1e-3);
    });
  });

  it("moves no hand by a jump, and ends at rest", () => {
    let before = new Animator(BUILD, HERE).body.right.arm.end.clone();
    const animator = make(gesture, 13, ({ right }) => {
      expect(right.arm.end.distanceTo(before)).toBeLessThan(0.09);
      before = right.arm.end.clone();
    });
    expect(animator.gesturing.active).toBe(false);
    const rest = new Animator(BUILD, HERE).body.right.arm.end;
    expect(animator.body.right.arm.end.distanceTo(rest)).toBeLessThan(1e-6);
  });

  it("is held still for those who want little motion", () => {
    const hands: number[] = [];
    make(
      gesture,
      1,
      ({ right, root }, { gesturing }) => {
        if (gesturing.active) hands.push(right.arm.end.z, root.z);
      },
      true,
    );
    const later = hands.slice(-40);
    for (let k = 2; k < later.length; k++) expect(later[k]).toBeCloseTo(later[k - 2] ?? 0, 6);
  });
});

describe("a hand", () => {
  it.each<[GestureName, number]>([
    ["wave", 0.15],
    ["raise_hand", 0.3],
  ])("of %s is above the shoulder", (gesture, aboveM) => {
    const { right } = make(gesture, 1).body;
    expect(right.arm.end.z - right.arm.start.z).toBeGreaterThan(aboveM);
  });

  it("of somebody who points goes on pointing, and the other one waves", () => {
    const animator = make("wave", 0.1);
    animator.pointing.target = { x: 2, y: -4, z: 1 };
    animator.gesturing.start("wave", false);
    for (let k = 0; k < 60; k++) animator.advance(1 + k * FRAME_S, HERE, FRAME_S);
    const { left, right } = animator.body;
    expect(left.arm.end.z - left.arm.start.z).toBeGreaterThan(0.1);
    expect(right.arm.end.z - right.arm.start.z).toBeLessThan(0.05);
  });
});
