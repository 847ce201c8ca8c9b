import { describe, expect, it } from "vitest";
import { PARTS } from "../../src/render/parts";

describe("the rail around a wide body", () => {
  it.each([6, 12])("is as wide as the body, with %i corners", (corners) => {
    const rail = PARTS.rail(corners);
    const places = rail.getAttribute("position");
    const away = Array.from({ length: places.count }, (_, i) =>
      Math.hypot(places.getX(i), places.getY(i)),
    );
    expect(Math.max(...away)).toBeCloseTo(1, 6);
    expect(Math.min(...away)).toBeGreaterThan(0.9);
    expect(rail.getAttribute("color").count).toBe(places.count);
  });
});

describe("the sign of guides", () => {
  it.each([6, 12])("stands above the head and looks alike from all sides, with %i corners", (n) => {
    const places = PARTS.sign(n).getAttribute("position");
    const heights = Array.from({ length: places.count }, (_, i) => places.getZ(i));
    const away = Array.from({ length: places.count }, (_, i) =>
      Math.hypot(places.getX(i), places.getY(i)),
    );
    expect(Math.min(...heights)).toBeGreaterThan(0.3);
    expect(Math.max(...heights)).toBeGreaterThan(0.9);
    const rim = away.filter((_, i) => heights[i] === Math.fround(0.9) && (away[i] ?? 0) > 0.1);
    expect(rim.length).toBeGreaterThanOrEqual(n);
    for (const radius of rim) expect(radius).toBeCloseTo(0.19, 5);
  });
});
