import { describe, expect, it } from "vitest";
import { Floors } from "../../src/world/floors";
import { meshParts } from "../../src/world/mesh";
import { Obstacles, type Vec3 } from "../../src/world/obstacles";
import { adult, bare } from "../scenes";

type Corner = [x: number, y: number, z: number];

const quad = (a: Corner, b: Corner, c: Corner, d: Corner): number[] => [a, b, c, a, c, d].flat();

/** A floor at 0 over x of 0 to 10, a ramp from there up to 3 at x = 15, a wall along y = 8. */
const triangles = Float32Array.from([
  ...quad([0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]),
  ...quad([10, 0, 0], [15, 0, 3], [15, 10, 3], [10, 10, 0]),
  ...quad([0, 8, 0], [10, 8, 0], [10, 8, 3], [0, 8, 3]),
]);
const scene = { ...bare, bounds: [0, 0, 20, 10] as const, mesh: "mesh" };
const built = { ...scene, bounds: [...scene.bounds] as [number, number, number, number] };
const { solids, steep } = meshParts(triangles);
const floors = new Floors(built, solids);
const obstacles = new Obstacles(built, adult, floors, steep);

const stroll = (from: Vec3, dx: number, dy: number, metres: number): Vec3 => {
  let at = from;
  for (let i = 0; i < metres / 0.05; i++) at = obstacles.walk(at, dx * 0.05, dy * 0.05, 0.25);
  return at;
};

describe("a building from a mesh", () => {
  it("has floors where its triangles are, and no other ground", () => {
    expect(floors.at(5, 5, 0.4)).toBeCloseTo(0);
    expect(floors.at(12.5, 5, 1)).toBeCloseTo(1.5);
    expect(floors.at(18, 5, 0)).toBeNull();
  });

  it("leads up ramps and ends at its edges", () => {
    expect(stroll([8, 4, 0], 1, 0, 4)[2]).toBeCloseTo(1.2);
    const [x, , z] = stroll([8, 4, 0], 1, 0, 12);
    expect(x).toBeCloseTo(14.75, 1);
    expect(z).toBeCloseTo(2.85, 1);
  });

  it("lets nobody walk on beyond an edge that the server is less exact about", () => {
    expect(stroll([15.1, 4, 3], 1, 0, 3)[0]).toBeLessThan(15.2);
    expect(stroll([15.1, 4, 3], -1, 0, 3)[0]).toBeLessThan(12.2);
  });

  it("holds nobody in the air while it is being fetched", () => {
    const nothing = new Obstacles(built, adult, new Floors(built));
    expect(nothing.walk([5, 5, 2], 0.5, 0, 0.25)).toEqual([expect.closeTo(5.5), 5, 2]);
  });

  it("stops at walls", () => {
    expect(stroll([5, 5, 0], 0, 1, 6)[1]).toBeCloseTo(7.75);
  });

  it("passes over triangles without area", () => {
    expect(meshParts(new Float32Array(9))).toEqual({ solids: [], steep: [] });
  });
});
