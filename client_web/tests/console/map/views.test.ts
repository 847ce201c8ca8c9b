import { describe, expect, it } from "vitest";
import { readOptions, USUAL } from "../../../src/console/map/options";
import { boxOf, isWithin, nearest } from "../../../src/console/map/picking";
import { fullValue, heatColour, valuesOf } from "../../../src/console/map/raster";
import { MapView } from "../../../src/console/map/views";

function view(): MapView {
  const made = new MapView();
  made.width = 800;
  made.height = 400;
  made.setWorld([0, 0, 40, 20], [0, 4, 8]);
  made.fit();
  return made;
}

describe("MapView", () => {
  it("shows all storeys beside each other, within the canvas", () => {
    const made = view();
    for (const storey of [0, 1, 2]) {
      for (const [x, y] of [
        [0.5, 0.5],
        [39.5, 19.5],
      ] as const) {
        const [px, py] = made.toCanvas(x, y, storey);
        expect(px).toBeGreaterThan(0);
        expect(px).toBeLessThan(800);
        expect(py).toBeGreaterThan(0);
        expect(py).toBeLessThan(400);
        const back = made.toWorld(px, py);
        expect(back?.storey).toBe(storey);
        expect(back?.x).toBeCloseTo(x);
        expect(back?.y).toBeCloseTo(y);
      }
    }
  });

  it("shows one storey larger than all", () => {
    const made = view();
    const all = made.scale;
    made.only = 1;
    made.fit();
    expect(made.scale).toBeGreaterThan(all);
    expect(made.isShown(0)).toBe(false);
    expect(made.storeys).toEqual([1]);
  });

  it("finds the storey of somebody on the stairs", () => {
    expect(view().storeyOf(3.1)).toBe(1);
    expect(view().storeyOf(-9)).toBe(0);
  });

  it("keeps what is under the pointer when it zooms", () => {
    const made = view();
    const before = made.toCanvas(12, 7, 0);
    made.zoom(2.5, ...before);
    const after = made.toCanvas(12, 7, 0);
    expect(after[0]).toBeCloseTo(before[0]);
    expect(after[1]).toBeCloseTo(before[1]);
    made.panPx(30, -20);
    expect(made.toCanvas(12, 7, 0)[0]).toBeCloseTo(before[0] + 30);
    expect(made.toCanvas(12, 7, 0)[1]).toBeCloseTo(before[1] - 20);
  });
});

describe("picking", () => {
  it("chooses the nearest that is near enough", () => {
    const points = [
      [0, 0],
      [10, 0],
      [12, 0],
    ] as const;
    expect(nearest(points, [11.5, 0], 14)).toBe(2);
    expect(nearest(points, [40, 0], 14)).toBeNull();
  });

  it("tells who is within a box drawn either way, and within a bent line", () => {
    expect(isWithin([5, 5], boxOf([10, 10], [0, 0]))).toBe(true);
    expect(isWithin([15, 5], boxOf([10, 10], [0, 0]))).toBe(false);
    const hook = [
      [0, 0],
      [10, 0],
      [10, 10],
      [8, 10],
      [8, 2],
      [0, 2],
    ] as const;
    expect(isWithin([9, 8], hook)).toBe(true);
    expect(isWithin([4, 8], hook)).toBe(false);
  });
});

describe("raster", () => {
  it("reads values, and leaves single high ones out of the scale", () => {
    const values = new Float32Array(1000).fill(0.5);
    values[3] = 100;
    values[4] = Number.NaN;
    const text = btoa(String.fromCharCode(...new Uint8Array(values.buffer)));
    const read = valuesOf({ width: 40, height: 25, cell_m: 1, origin_m: [0, 0], values: text });
    expect(read).toHaveLength(1000);
    expect(read[3]).toBe(100);
    expect(fullValue(read)).toBe(0.5);
    expect(fullValue(new Float32Array(4))).toBe(0);
  });

  it("has a stronger colour for more", () => {
    const [, green, , alpha] = heatColour(0.1);
    const [, greener, , stronger] = heatColour(0.9);
    expect(stronger).toBeGreaterThan(alpha);
    expect(greener).toBeLessThan(green);
  });
});

describe("readOptions", () => {
  it("takes what it knows, and the usual for the rest", () => {
    expect(readOptions('{"trailS":10,"heat":"magic","ways":true,"goals":1,"x":2}')).toEqual({
      ...USUAL,
      trailS: 10,
      ways: true,
    });
    expect(readOptions("{")).toEqual(USUAL);
    expect(readOptions(null)).toEqual(USUAL);
  });
});
