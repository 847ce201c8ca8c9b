import { describe, expect, it } from "vitest";
import { Obstacles, type Vec2 } from "../../src/world/obstacles";

const RADIUS_M = 0.25;
const ground = {
  bounds: [0, 0, 20, 20] as const,
  polygons: [
    {
      points: [
        [8, 8],
        [12, 8],
        [12, 12],
        [8, 12],
      ] as Vec2[],
    },
  ],
  walls: [{ start: [5, 0] as Vec2, end: [5, 6] as Vec2 }],
};
const obstacles = new Obstacles(ground);

describe("walking", () => {
  it("goes where nothing is in the way", () => {
    const [x, y] = obstacles.walk([1, 1], 1, 0.5, RADIUS_M);
    expect([x, y]).toEqual([expect.closeTo(2), expect.closeTo(1.5)]);
  });

  it("slides along a face and keeps the radius", () => {
    let at: Vec2 = [7, 10];
    for (let i = 0; i < 40; i++) at = obstacles.walk(at, 0.05, 0.05, RADIUS_M);
    expect(at[0]).toBeCloseTo(8 - RADIUS_M);
    expect(at[1]).toBeCloseTo(12, 0);
  });

  it("never gets through a wall, however long the step", () => {
    const [x] = obstacles.walk([4, 3], 10, 0, RADIUS_M);
    expect(x).toBeCloseTo(5 - RADIUS_M);
  });

  it("stays within the bounds", () => {
    expect(obstacles.walk([1, 1], -5, -5, RADIUS_M)).toEqual([0, 0]);
  });

  it("never comes nearer to anything than the radius on a random walk", () => {
    let at: Vec2 = [2, 2];
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
    expect(obstacles.clear(from, to, RADIUS_M)).toBe(expected);
  });
});
