import { Box3, type BufferGeometry } from "three";
import { describe, expect, it } from "vitest";
import { furniture, isHung } from "../../src/render/furniture";
import { box } from "../scenes";

const piece = (lengthM: number, widthM: number, height_m: number) =>
  box([2, 3], [2 + lengthM, 3 + widthM], { kind: "furniture", offset_m: 3.5, height_m });

const extentOf = (parts: BufferGeometry[]): Box3 =>
  parts.reduce((all, part) => {
    part.computeBoundingBox();
    return part.boundingBox ? all.union(part.boundingBox) : all;
  }, new Box3());

describe("a piece of furniture", () => {
  const sizes: [string, number, number, number][] = [
    ["bench", 2, 0.6, 0.45],
    ["table", 1, 1, 0.75],
    ["showcase", 4, 0.75, 0.95],
    ["sculpture", 1, 1, 2.8],
    ["screen", 1.5, 0.75, 2.1],
    ["shelves", 5, 0.75, 2],
    ["picture", 1.6, 0.1, 1.3],
  ];

  it.each(sizes)("is seen where it is in the way: %s", (_what, lengthM, widthM, height_m) => {
    for (let index = 0; index < 12; index++) {
      const { min, max } = extentOf(furniture(piece(lengthM, widthM, height_m), index));
      expect(min.x).toBeCloseTo(2, 1);
      expect(max.x).toBeCloseTo(2 + lengthM, 1);
      expect(min.y).toBeGreaterThan(2.94);
      expect(max.y).toBeLessThan(3.06 + widthM);
      expect(min.z).toBeCloseTo(3.5, 1);
      expect(max.z).toBeGreaterThan(3.5 + 0.85 * height_m);
      expect(max.z).toBeLessThan(3.55 + height_m);
    }
  });

  it("looks the same whenever it is drawn", () => {
    const shelf = piece(5, 0.75, 2);
    expect(furniture(shelf, 4)).toHaveLength(furniture(shelf, 4).length);
  });

  it("hangs on a wall if it is thin", () => {
    expect(isHung(piece(1.6, 0.1, 1.3))).toBe(true);
    expect(isHung(piece(1.6, 0.5, 1.3))).toBe(false);
  });
});
