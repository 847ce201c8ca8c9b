import { beforeEach, describe, expect, it } from "vitest";
import type { EntityInfo, EntityRecord } from "../../src/net/messages";
import { World } from "../../src/world/world";
import { WELCOME } from "../net/sockets";

const info = (id: number, kind: EntityInfo["kind"] = "actor"): EntityInfo => ({
  id,
  kind,
  name: `N${id}`,
  layer: 0,
  x: 2,
  y: 2,
  z: 0,
  heading: 0,
  radius: 0.25,
  leg_m: 0.9,
  stature_m: 1.72,
  points_at: null,
});
const record = (id: number, x: number): EntityRecord => ({
  id,
  layer: 0,
  reason: 1,
  x,
  y: 2,
  z: 0,
  heading: 0,
  speed: 1,
});
/** Server time of a tick: tick 100 was at 5 s, 20 ticks a second. */
const timeOf = (tick: number): number => 5 + (tick - 100) / 20;

let world: World;

beforeEach(() => {
  world = new World(WELCOME);
  world.enter(100, [info(7, "person"), info(8)]);
});

describe("World", () => {
  it("draws the others a little behind, between two snapshots", () => {
    for (let tick = 101; tick <= 140; tick++) {
      world.snapshot(tick, 0, [record(8, 2 + (tick - 100) * 0.05)], timeOf(tick) + 0.02);
      world.advance(timeOf(tick) + 0.02, 0.05);
    }
    const drawn = world.avatars.get(8)?.pose.x ?? 0;
    expect(drawn).toBeCloseTo(2 + 40 * 0.05 - world.delayS + 0.02, 1);
  });

  it("lets those stand of whom a snapshot says nothing", () => {
    world.snapshot(101, 0, [record(8, 2.05)], timeOf(101));
    for (let tick = 102; tick <= 140; tick++) world.snapshot(tick, 0, [], timeOf(tick));
    world.advance(timeOf(140), 0.05);
    expect(world.avatars.get(8)?.pose.x).toBeCloseTo(2.05);
  });

  it("moves the own avatar ahead of the server", () => {
    world.command({ kind: "move", seq: 1, direction: 0, speed: 1 });
    world.advance(5, 0.1);
    expect(world.own?.pose.x).toBeCloseTo(2.1);
  });

  it("draws another body of the same avatar, which still points where it did", () => {
    world.point(8, [4, 2, 1]);
    const body = { radius: 0.4, leg_m: 0.6, stature_m: 1.2 };
    world.reshape({ id: 8, ...body });
    world.reshape({ id: 99, ...body });
    const avatar = world.avatars.get(8);
    expect(avatar?.radius).toBe(0.4);
    expect(avatar?.animator.build.legM).toBe(0.6);
    expect(avatar?.animator.pointing.target).toEqual({ x: 4, y: 2, z: 1 });
    expect(world.avatars.size).toBe(2);
  });

  it("lets somebody walk on who only looks otherwise", () => {
    const before = world.avatars.get(7)?.animator;
    const look = [1, 2, 3, 4, 5, 171] as const;
    world.reshape({ id: 7, radius: 0.25, leg_m: 0.9, stature_m: 1.72, look });
    expect(world.avatars.get(7)?.look).toEqual(look);
    expect(world.avatars.get(7)?.animator).toBe(before);
    world.reshape({ id: 7, radius: 0.25, leg_m: 0.9, stature_m: 1.72 });
    expect(world.avatars.get(7)?.look).toBeNull();
  });

  it("forgets who has left, and their plan", () => {
    world.plan = {
      type: "plan",
      tick: 100,
      id: 8,
      reason: 1,
      behaviour: "wander",
      goal: null,
      path: [],
      people: [],
      since_s: 0,
      blocker: null,
      outcome: null,
      in_the_way: null,
    };
    world.leave([8]);
    expect(world.avatars.has(8)).toBe(false);
    expect(world.plan).toBeNull();
  });

  it("passes over records of avatars that are not in view", () => {
    world.snapshot(101, 0, [record(99, 1)], timeOf(101));
    expect(world.avatars.has(99)).toBe(false);
  });

  it("lifts somebody on stairs from tread to tread without a jump", () => {
    const heights: number[] = [];
    for (let tick = 101; tick <= 160; tick++) {
      const z = Math.floor((tick - 100) / 4) * 0.17;
      world.snapshot(tick, 0, [{ ...record(8, 2), z }], timeOf(tick));
      for (let frame = 0; frame < 3; frame++) {
        world.advance(timeOf(tick), 0.05 / 3);
        heights.push(world.avatars.get(8)?.pose.z ?? 0);
      }
    }
    const rises = heights.map((z, i) => z - (heights[i - 1] ?? 0));
    expect(Math.max(...rises)).toBeLessThan(0.04);
    expect(Math.min(...rises)).toBeGreaterThanOrEqual(0);
  });

  it("puts somebody on another floor at once", () => {
    world.snapshot(101, 0, [{ ...record(7, 2), z: 3 }], timeOf(101));
    world.advance(timeOf(101), 1 / 60);
    expect(world.own?.pose.z).toBe(3);
  });

  it("keeps which doors stand open", () => {
    world.doorsMoved({ gate: false });
    world.doorsMoved({ porch: true });
    expect(world.doors).toEqual({ gate: false, porch: true });
  });
});
