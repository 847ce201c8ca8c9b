import { describe, expect, it } from "vitest";
import { Floors } from "../../src/world/floors";
import { storeyAt } from "../../src/world/storeys";
import { bare, box, twoFloors } from "../scenes";

const floors = new Floors(twoFloors);

describe("the floor", () => {
  it.each<[string, [number, number, number], number | null]>([
    ["is the ground in the open", [25, 25, 0.3], 0],
    ["is the ground below a slab", [15, 15, 1.2], 0],
    ["is the slab for who is nearer to it", [15, 15, 1.8], 3],
    ["is a tread, not the ground that it fills", [5, 13, 0], 3 / 17],
    ["is the last tread at the head", [9.9, 13, 2.9], 3],
    ["slopes on a ramp", [15, 5, 1.4], 1.5],
    ["is not in the room below a ramp's upper end", [15, 9.9, 0], 2.97],
    ["is a kerb", [2.5, 12, 0], 0.4],
    ["ends with the bounds", [-0.1, 5, 0], null],
  ])("%s", (_what, [x, y, z], expected) => {
    const found = floors.at(x, y, z);
    if (expected === null) expect(found).toBeNull();
    else expect(found).toBeCloseTo(expected);
  });

  it("is no plant and no water", () => {
    const garden = { ...bare, polygons: [box([1, 1], [3, 3], { kind: "water", height_m: 0.4 })] };
    expect(new Floors(garden).at(2, 2, 0)).toBeNull();
  });

  it("needs room above it", () => {
    const low = { ...bare, polygons: [box([1, 1], [3, 3], { offset_m: 0.9, height_m: 0.1 })] };
    expect(new Floors(low).at(2, 2, 0)).toBe(1);
  });
});

describe("being covered", () => {
  it.each<[string, [number, number, number], boolean]>([
    ["under a slab", [15, 15, 0], true],
    ["on the slab", [15, 15, 3], false],
    ["beside it", [25, 15, 0], false],
    ["with the head through an opening", [15, 15, 1.7], false],
  ])("%s", (_what, [x, y, z], expected) => {
    expect(floors.covered(x, y, z)).toBe(expected);
  });
});

describe("storeys", () => {
  it("have everybody on the nearest one", () => {
    expect([-0.2, 1.4, 1.6, 9].map((z) => storeyAt([0, 3, 6], z))).toEqual([0, 0, 1, 2]);
  });
});
