import { expect, it, vi } from "vitest";

import { Trails } from "../../../src/console/map/trails";
import { MapView } from "../../../src/console/map/views";
import type { Scheme } from "../../../src/console/state/scheme";

const drawn = vi.hoisted(() => ({ count: 0, shown: "" }));

// The picture without a canvas: it is drawn anew where its key, or the view, is another.
vi.mock("../../../src/console/map/offscreen", () => ({
  Offscreen: class {
    show(pen: unknown, view: { key: string }, _: number, of: string, draw: (p: unknown) => void) {
      const now = `${view.key} ${of}`;
      if (now === drawn.shown) return;
      drawn.shown = now;
      drawn.count++;
      draw(pen);
    }
  },
}));

it("draws trails anew as seldom after a map was moved as before", () => {
  const trails = new Trails();
  const view = new MapView();
  const stroke = vi.fn();
  const pen = { stroke } as unknown as CanvasRenderingContext2D;
  vi.stubGlobal("Path2D", Object);
  const scheme = { dark: false, colour: () => "" } as unknown as Scheme;
  const frames = (from: number) => {
    for (let k = from; k < from + 60; k++)
      trails.draw(pen, view, 1, new Map(), k / 60, 10, new Set(), scheme);
  };
  frames(0);
  const still = drawn.count;
  expect(still).toBeGreaterThan(1);
  view.centreX += 3;
  frames(60);
  expect(drawn.count).toBeLessThanOrEqual(2 * still + 1);
});
