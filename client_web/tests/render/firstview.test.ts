import { describe, expect, it } from "vitest";
import { firstYaw, namedYaw } from "../../src/render/firstview";

const HERE = { x: 10, y: 10 };
const off = (a: number, b: number): number =>
  Math.abs(Math.atan2(Math.sin(a - b), Math.cos(a - b)));

describe("the first view", () => {
  it("goes to people where all is open", () => {
    const people = [
      { x: 10, y: 2 },
      { x: 11, y: 3 },
    ];
    expect(
      off(
        firstYaw(HERE, people, () => 100),
        -Math.PI / 2,
      ),
    ).toBeLessThan(0.3);
  });

  it("does not go to people behind a wall, but over open ground", () => {
    const wallToTheSouth = (yaw: number): number => (Math.sin(yaw) < 0 ? 1 : 30);
    const yaw = firstYaw(HERE, [{ x: 10, y: 2 }], wallToTheSouth);
    expect(Math.sin(yaw)).toBeGreaterThanOrEqual(0);
  });

  it("goes where one sees furthest when nobody is there", () => {
    const openToTheWest = (yaw: number): number => (off(yaw, Math.PI) < 0.2 ? 20 : 3);
    expect(off(firstYaw(HERE, [], openToTheWest), Math.PI)).toBeLessThan(0.2);
  });
});

describe("the view that a scene names", () => {
  const spawns = [
    {
      position: [10, 9] as [number, number],
      z_m: 0,
      radius_m: 2,
      view: [20, 10] as [number, number],
    },
    { position: [10, 9] as [number, number], z_m: 3.5, radius_m: 2 },
  ];

  it("is that of the spawn in which one stands", () => {
    expect(namedYaw({ ...HERE, z: 0 }, spawns)).toBeCloseTo(0);
  });

  it("is none on another floor, where none is named, and far from all spawns", () => {
    expect(namedYaw({ ...HERE, z: 3.5 }, spawns)).toBeNull();
    expect(namedYaw({ x: 30, y: 10, z: 0 }, spawns)).toBeNull();
  });
});
