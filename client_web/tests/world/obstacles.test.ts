import { describe, expect, it } from "vitest";
import type { Vec2 } from "../../src/world/barriers";
import { Obstacles, type Vec3 } from "../../src/world/obstacles";
import { adult, bare, box, twoFloors, wall } from "../scenes";

const RADIUS_M = 0.25;
const obstacles = new Obstacles(
  {
    ...bare,
    bounds: [0, 0, 20, 20],
    polygons: [box([8, 8], [12, 12])],
    walls: [wall([5, 0], [5, 6])],
  },
  adult,
);

describe("walking", () => {
  it("goes where nothing is in the way", () => {
    const [x, y] = obstacles.walk([1, 1, 0], 1, 0.5, RADIUS_M);
    expect([x, y]).toEqual([expect.closeTo(2), expect.closeTo(1.5)]);
  });

  it("slides along a face and keeps the radius", () => {
    let at: Vec3 = [7, 10, 0];
    for (let i = 0; i < 40; i++) at = obstacles.walk(at, 0.05, 0.05, RADIUS_M);
    expect(at[0]).toBeCloseTo(8 - RADIUS_M);
    expect(at[1]).toBeCloseTo(12, 0);
  });

  it("never gets through a wall, however long the step", () => {
    const [x] = obstacles.walk([4, 3, 0], 10, 0, RADIUS_M);
    expect(x).toBeCloseTo(5 - RADIUS_M);
  });

  it("stays within the bounds", () => {
    expect(obstacles.walk([1, 1, 0], -5, -5, RADIUS_M)).toEqual([0, 0, 0]);
  });

  it("never comes nearer to anything than the radius on a random walk", () => {
    let at: Vec3 = [2, 2, 0];
    let direction = 0;
    for (let i = 0; i < 3000; i++) {
      direction += Math.sin(i * i);
      at = obstacles.walk(at, Math.cos(direction) * 0.12, Math.sin(direction) * 0.12, RADIUS_M);
      const outsideX = Math.max(8 - at[0], at[0] - 12, 0);
      const outsideY = Math.max(8 - at[1], at[1] - 12, 0);
      expect(Math.hypot(outsideX, outsideY)).toBeGreaterThan(RADIUS_M - 0.01);
    }
  });
});

describe("a straight way", () => {
  it.each<[string, Vec2, Vec2, boolean]>([
    ["in the open", [1, 15], [19, 15], true],
    ["through a building", [1, 10], [19, 10], false],
    ["past a corner, too close", [7.9, 1], [7.9, 19], false],
    ["past a corner, wide enough", [7.7, 1], [7.7, 19], true],
    ["round the end of a wall", [4, 6.3], [6, 6.3], true],
    ["through a wall", [4, 3], [6, 3], false],
  ])("%s", (_what, from, to, expected) => {
    expect(obstacles.clear([...from, 0], [...to, 0], RADIUS_M)).toBe(expected);
  });
});

describe("the measures of a body", () => {
  const beam = wall([5, 0], [5, 6], { offset_m: 1.5, height_m: 1 });
  const kerb = box([4, 10], [20, 20], { height_m: 0.4 });
  const ways = { ...bare, walls: [beam], polygons: [kerb] };
  const east = (obstacles: Obstacles, y: number, clearanceM = RADIUS_M): Vec3 => {
    let at: Vec3 = [2, y, 0];
    for (let i = 0; i < 100; i++) at = obstacles.walk(at, 0.05, 0, clearanceM);
    return at;
  };

  it("say what it walks under", () => {
    expect(east(new Obstacles(ways, adult), 3)[0]).toBeCloseTo(5 - RADIUS_M);
    expect(east(new Obstacles(ways, { ...adult, heightM: 1.4 }), 3)[0]).toBeCloseTo(7);
  });

  it("say what it steps on", () => {
    expect(east(new Obstacles(ways, adult), 15)[2]).toBeCloseTo(0.4);
    expect(east(new Obstacles(ways, { ...adult, stepM: 0.3 }), 15)[0]).toBeCloseTo(4 - RADIUS_M);
  });

  it("let nobody through a wall, even one who keeps no distance", () => {
    expect(east(new Obstacles(ways, adult), 3, 0)[0]).toBeLessThan(5);
  });
});

describe("several floors", () => {
  const { walls } = twoFloors;
  const built = new Obstacles(twoFloors, adult);
  /** Walk on and on in one direction. */
  const stroll = (from: Vec3, dx: number, dy: number, metres: number): Vec3 => {
    let at = from;
    for (let i = 0; i < metres / 0.05; i++) at = built.walk(at, dx * 0.05, dy * 0.05, RADIUS_M);
    return at;
  };

  it("climbs stairs and goes down again", () => {
    const above = stroll([3.5, 13, 0], 1, 0, 8);
    expect(above).toEqual([expect.closeTo(11.5), expect.closeTo(13), expect.closeTo(3)]);
    const below = stroll(above, -1, 0, 8);
    expect(below).toEqual([expect.closeTo(3.5), expect.closeTo(13), expect.closeTo(0)]);
  });

  it("goes up a ramp", () => {
    expect(stroll([15, 1, 0.3], 0, 1, 4.5)[2]).toBeCloseTo(1.65);
    expect(stroll([15, 1, 0.3], 0, 1, 11)).toEqual([
      expect.closeTo(15),
      expect.closeTo(12),
      expect.closeTo(3),
    ]);
  });

  it("passes under a slab and on it", () => {
    expect(stroll([12, 25, 0], 0, -1, 0.3)[2]).toBe(0);
    expect(stroll([12, 22, 0], 0, -1, 10)).toEqual([12, expect.closeTo(12), 0]);
    expect(stroll([12, 12, 3], 0, 1, 5)).toEqual([12, expect.closeTo(17), 3]);
  });

  it("does not fall from a ledge, but slides along it", () => {
    const [x, y, z] = stroll([17, 17, 3], 1, 0.5, 6);
    expect(x).toBeCloseTo(20 - RADIUS_M);
    expect(y).toBeGreaterThan(19);
    expect(z).toBe(3);
  });

  it("does not fall from the side of stairs", () => {
    const [, y, z] = stroll([8, 13, 1.9], 0, 1, 3);
    expect(y).toBeCloseTo(14 - RADIUS_M);
    expect(z).toBeGreaterThan(1.5);
  });

  it("is held by a railing above and passes under it below", () => {
    expect(walls).toHaveLength(1);
    expect(stroll([12, 18, 3], 0, 1, 5)[1]).toBeCloseTo(20 - RADIUS_M);
    expect(stroll([12, 18, 0], 0, 1, 4)[1]).toBeCloseTo(22);
  });

  it("steps onto a kerb and off it", () => {
    expect(stroll([1.5, 12, 0], 1, 0, 1)[2]).toBeCloseTo(0.4);
    expect(stroll([2.5, 12, 0.4], 1, 0, 1)[2]).toBe(0);
  });

  it("is stopped by a closed door", () => {
    expect(stroll([12, 25, 0], 0, -1, 2)[1]).toBeCloseTo(23);
    built.doors = { gate: false };
    expect(stroll([12, 25, 0], 0, -1, 2)[1]).toBeCloseTo(24 + RADIUS_M);
    built.doors = {};
  });

  it.each<[string, Vec3, Vec3, boolean]>([
    ["up the stairs", [4, 13, 0], [12, 13, 3], true],
    ["to the floor below where the stairs lead above", [4, 13, 0], [12, 13, 0], false],
    ["through under the slab", [12, 22, 0], [12, 11, 0], true],
    ["over a ledge", [18, 15, 3], [22, 15, 0], false],
  ])("sees a straight way or none: %s", (_what, from, to, expected) => {
    expect(built.clear(from, to, RADIUS_M)).toBe(expected);
  });
});
