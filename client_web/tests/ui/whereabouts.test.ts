import { afterEach, expect, it } from "vitest";
import type { World } from "../../src/world/world";
import { plain } from "../../src/language/phrase";
import { speak } from "../../src/language/words";
import { surroundings, whereIs } from "../../src/ui/whereabouts";

const here = { x: 0, y: 0, z: 0 };
const other = (x: number, y: number, z = 0, away = false): Parameters<typeof whereIs>[0] => ({
  pose: { x, y, z, layer: 0, heading: 0, speed: 0, reason: 0 },
  away,
});
const NORTH = Math.PI / 2;

afterEach(() => speak("en"));

it.each([
  [other(0, 3), "3 m, ahead"],
  [other(-4, 0), "4 m, to the left"],
  [other(2, 2), "3 m, ahead to the right"],
  [other(0, -2), "2 m, behind"],
  [other(0, 3, 4), "3 m, ahead, further up"],
  [other(0, 3, 0, true), "3 m, ahead, away from the screen"],
])("says where somebody is", (who, words) => {
  expect(plain(whereIs(who, here, NORTH))).toBe(words);
});

it("says who and what is around, the nearest first", () => {
  const avatar = (name: string, x: number, y: number, heading = 0, speed = 0): object => ({
    name,
    own: false,
    away: false,
    pose: { x, y, z: 0, layer: 0, heading, speed, reason: 0 },
  });
  const around = {
    own: { pose: { ...here, heading: 0 } },
    avatars: new Map([
      [1, { own: true, pose: here }],
      [2, avatar("Far", 0, 9, NORTH, 1)],
      [3, avatar("Maple", -3, 0, 0, 1)],
    ]),
    scene: { places: [{ name: "fountain", position: [0, -4], z_m: 0 }] },
  };
  expect(plain(surroundings(around as unknown as World, NORTH))).toBe(
    "The place fountain is 4 m behind. Maple, 3 m, to the left, comes nearer. " +
      "Far, 9 m, ahead, goes away.",
  );
  const alone = { ...around, avatars: new Map(), scene: { places: [] } } as unknown as World;
  expect(plain(surroundings(alone, NORTH))).toBe("Nobody is near.");
});

it("says it in the language of the page", async () => {
  await speak("de");
  const metres = plain(whereIs(other(2, 2, 4), here, NORTH)).replace(/\s/gu, " ");
  expect(metres).toBe("3 m, rechts vor dir, weiter oben");
  await speak("zh-Hant");
  expect(plain(whereIs(other(-4, 0), here, NORTH)).replace(/\s/gu, " ")).toBe("4 公尺，左邊");
});
