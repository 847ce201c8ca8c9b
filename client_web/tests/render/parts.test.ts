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
