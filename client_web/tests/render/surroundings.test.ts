import { describe, expect, it } from "vitest";
import { treesAround } from "../../src/render/surroundings";

describe("trees around", () => {
  const bounds: [number, number, number, number] = [-4, -11, 44, 32];
  const middles = treesAround(bounds, 0).map((part) => {
    const middle = part.getAttribute("middle");
    return [middle.getX(0), middle.getY(0)] as const;
  });

  it("stand where nobody walks", () => {
    const [x0, y0, x1, y1] = bounds;
    const near = middles.filter(
      ([x, y]) => x > x0 - 3.9 && x < x1 + 3.9 && y > y0 - 3.9 && y < y1 + 3.9,
    );
    expect(middles.length).toBeGreaterThan(100);
    expect(near).toEqual([]);
  });

  it("stand on all sides", () => {
    const [x0, y0, x1, y1] = bounds;
    for (const side of [
      middles.filter(([x]) => x < x0),
      middles.filter(([x]) => x > x1),
      middles.filter(([, y]) => y < y0),
      middles.filter(([, y]) => y > y1),
    ]) {
      expect(side.length).toBeGreaterThan(20);
    }
  });
});
