import { expect, it } from "vitest";
import { whereabouts } from "../../src/ui/whereabouts";

const here = { x: 0, y: 0, z: 0 };
const other = (x: number, y: number, z = 0, away = false): Parameters<typeof whereabouts>[0] => ({
  pose: { x, y, z, layer: 0, heading: 0, speed: 0, reason: 0 },
  away,
});
const NORTH = Math.PI / 2;

it.each([
  [other(0, 3), "3 m, ahead"],
  [other(-4, 0), "4 m, to the left"],
  [other(2, 2), "3 m, ahead to the right"],
  [other(0, -2), "2 m, behind"],
  [other(0, 3, 4), "3 m, ahead, further up"],
  [other(0, 3, 0, true), "3 m, ahead, away from the screen"],
])("says where somebody is", (who, words) => {
  expect(whereabouts(who, here, NORTH)).toBe(words);
});
