import { describe, expect, it } from "vitest";
import { WalkKeys, type Wish } from "../../src/input/keyboard";
import { type Heading, headingOf, Steering } from "../../src/input/steering";
import { gait } from "../scenes";

const EAST = 0;
const NORTH = Math.PI / 2;
const REST: Wish = { forward: 0, right: 0, turn: 0, hurry: false };

describe("keys", () => {
  it("walk by their place on the keyboard", () => {
    const keys = new WalkKeys();
    expect(keys.press("KeyW")).toBe(true);
    expect(keys.press("ArrowRight")).toBe(true);
    expect(keys.press("KeyX")).toBe(false);
    expect(keys.wish).toEqual({ forward: 1, right: 1, turn: 0, hurry: false });
    keys.release("KeyW");
    expect(keys.wish.forward).toBe(0);
  });

  it("turn the camera", () => {
    const keys = new WalkKeys();
    keys.press("KeyQ");
    expect(keys.wish.turn).toBe(1);
  });

  it("that oppose each other cancel out", () => {
    const keys = new WalkKeys();
    keys.press("KeyA");
    keys.press("KeyD");
    expect(keys.wish.right).toBe(0);
  });

  it("are all let go at once", () => {
    const keys = new WalkKeys();
    keys.press("KeyS");
    keys.press("ShiftLeft");
    keys.releaseAll();
    expect(keys.wish).toEqual(REST);
  });
});

describe("headingOf", () => {
  it.each<[string, Partial<Wish>, number, number]>([
    ["forward, camera to the north", { forward: 1 }, NORTH, Math.PI / 2],
    ["right, camera to the north", { right: 1 }, NORTH, 0],
    ["back, camera to the east", { forward: -1 }, EAST, Math.PI],
    ["forward and left, camera to the east", { forward: 1, right: -1 }, EAST, Math.PI / 4],
  ])("%s", (_what, wish, yaw, direction) => {
    const heading = headingOf({ ...REST, ...wish }, null, yaw, gait);
    expect(Math.cos(heading.direction - direction)).toBeCloseTo(1);
    expect(heading.speed).toBe(1.4);
  });

  it("stands still without a wish", () => {
    expect(headingOf(REST, null, NORTH, gait).speed).toBe(0);
    expect(headingOf(REST, { x: 0.05, y: 0.05 }, NORTH, gait).speed).toBe(0);
  });

  it("hurries with shift or a stick that is pushed all the way, within what is allowed", () => {
    expect(headingOf({ ...REST, forward: 1, hurry: true }, null, NORTH, gait).speed).toBe(2.5);
    expect(headingOf(REST, { x: 0, y: 1 }, NORTH, gait).speed).toBe(2.5);
    expect(headingOf(REST, { x: 0, y: 0.5 }, NORTH, gait).speed).toBeCloseTo(0.7);
    const slow = { ...gait, maxSpeedMps: 1, walkSpeedMps: 0.8 };
    expect(headingOf({ ...REST, forward: 1 }, null, NORTH, slow).speed).toBe(0.8);
  });
});

describe("Steering", () => {
  const walk = (direction: number): Heading => ({ direction, speed: 1.6 });
  const stand: Heading = { direction: 0, speed: 0 };

  function steer(wishes: (ms: number) => Heading, untilMs: number): { ms: number; to: Heading }[] {
    const sent: { ms: number; to: Heading }[] = [];
    let now = 0;
    const steering = new Steering((to) => sent.push({ ms: now, to }));
    for (; now <= untilMs; now += 16) steering.update(wishes(now), now);
    return sent;
  }

  it("says nothing while nothing is wished", () => {
    expect(steer(() => stand, 5000)).toEqual([]);
  });

  it("says a change at once and repeats it slowly", () => {
    const sent = steer(() => walk(1), 3500);
    expect(sent[0]?.ms).toBe(0);
    expect(sent).toHaveLength(4);
  });

  it("sends no more than 15 a second while the camera turns", () => {
    expect(steer((ms) => walk(ms / 300), 2000).length).toBeLessThanOrEqual(31);
  });

  it("stops at once, and only once", () => {
    const sent = steer((ms) => (ms < 40 ? walk(1) : stand), 3000);
    expect(sent.map(({ to }) => to.speed)).toEqual([1.6, 0]);
    expect(sent[1]?.ms).toBeLessThan(60);
  });

  it("does not call off a walk to a point", () => {
    const sent: Heading[] = [];
    const steering = new Steering((to) => sent.push(to));
    steering.update(walk(1), 0);
    steering.reset();
    steering.update(stand, 100);
    expect(sent).toHaveLength(1);
  });
});
