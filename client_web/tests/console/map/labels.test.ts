import { describe, expect, it } from "vitest";
import { boxAt, spots } from "../../../src/console/map/labels";

describe("spots", () => {
  it("puts a name to the right of its point", () => {
    expect(spots([{ x: 10, y: 20, width: 30 }])).toEqual([{ x: 18, y: 14 }]);
  });

  it("prints no name over another, and leaves one out where no room is left", () => {
    const wishes = Array.from({ length: 6 }, () => ({ x: 100, y: 100, width: 40 }));
    const found = spots(wishes);
    expect(found.filter((spot) => spot !== null)).toHaveLength(4);
    const boxes = found.flatMap((spot) => (spot ? [boxAt(spot, 40)] : []));
    for (const [index, [left, top, right, bottom]] of boxes.entries()) {
      for (const [l, t, r, b] of boxes.slice(index + 1)) {
        expect(left < r && right > l && top < b && bottom > t).toBe(false);
      }
    }
  });

  it("keeps whole names within the map where there is room", () => {
    const wish = { x: 370, y: 100, width: 40 };
    expect(spots([wish], [], [0, 0, 390, 800])).toEqual([{ x: 322, y: 94 }]);
    expect(spots([wish], [], [0, 0, 39, 800])).toEqual([{ x: 378, y: 94 }]);
    // Places are rather printed over than names cut.
    expect(spots([wish], [[0, 0, 370, 300]], [0, 0, 390, 800])).toEqual([{ x: 322, y: 94 }]);
  });

  it("keeps away from names of places only where it can", () => {
    const wish = { x: 100, y: 100, width: 40 };
    const right = boxAt({ x: 108, y: 94 }, 40);
    expect(spots([wish], [right])).toEqual([{ x: 52, y: 94 }]);
    expect(spots([wish], [[0, 0, 300, 300]])).toEqual([{ x: 108, y: 94 }]);
  });
});
