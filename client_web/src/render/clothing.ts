/** The clothes, hair and skin of avatars: what people can choose, and what follows from an id. */

import { Color } from "three";
import type { Look } from "../net/messages";
import { unlikeness } from "./likeness";
import { pick, scatter } from "./palette";

/** Something that can be chosen: its name, by which people are told of it in their language, and how it looks. */
export type Choice<T> = readonly [name: string, looks: T];

/** The number of a choice on the wire is its place here, from 1 on. */
export const SHIRTS = [
  ["red", "#c8413b"],
  ["blue", "#2f6fb5"],
  ["amber", "#e0a031"],
  ["green", "#4b8f5a"],
  ["violet", "#7d56a8"],
  ["linen", "#d9d4c9"],
  ["slate", "#37474f"],
  ["rose", "#d9728f"],
  ["teal", "#2a9bb0"],
  ["brown", "#8a5a3b"],
  ["black", "#1f2124"],
  ["lime", "#a8bf3f"],
] as const satisfies readonly Choice<string>[];
export const TROUSERS = [
  ["ink", "#2c3440"],
  ["greyBlue", "#4a5568"],
  ["khaki", "#6b5b4a"],
  ["navy", "#26324d"],
  ["grey", "#55524d"],
  ["stone", "#7b7264"],
  ["rust", "#8c4a32"],
  ["cream", "#d8cdb8"],
] as const satisfies readonly Choice<string>[];
export const HAIR_COLOURS = [
  ["darkBrown", "#2b1d14"],
  ["brown", "#4f3421"],
  ["chestnut", "#8a5a2b"],
  ["blond", "#c79a55"],
  ["grey", "#6e6a66"],
  ["black", "#1a1a1f"],
  ["red", "#a3481f"],
  ["white", "#dcd8d2"],
] as const satisfies readonly Choice<string>[];
/** From light to dark. */
export const SKINS = [
  ["skin1", "#f8dfc8"],
  ["skin2", "#f1c9a5"],
  ["skin3", "#e0ac80"],
  ["skin4", "#c68a5e"],
  ["skin5", "#b07a50"],
  ["skin6", "#9a643f"],
  ["skin7", "#6f452b"],
  ["skin8", "#4a2d1e"],
] as const satisfies readonly Choice<string>[];
/** The parts of figures; null is none at all. */
export const HAIRDOS = [
  ["short", "short"],
  ["long", "long"],
  ["bun", "bun"],
  ["curls", "curls"],
  ["shaven", null],
] as const satisfies readonly Choice<string | null>[];
type Hairdo = (typeof HAIRDOS)[number][1];

/** The colours and fashions that ids lead to, each as often as it stands here. */
const OF_IDS = {
  shirts: colours(SHIRTS.slice(0, 10)),
  trousers: colours(TROUSERS.slice(0, 6)),
  skins: ["#f1c9a5", "#e0ac80", "#c68a5e", "#9a643f", "#6f452b"],
  hairs: colours(HAIR_COLOURS.slice(0, 6)),
  hairdos: ["short", "short", "short", "long", "long", "bun"] as const,
};
const SHOES = ["#3a2a20", "#26262b", "#e6e2da", "#6d4a2f", "#8c2f2b", "#2f4a63"];

/** The shares of avatars with short sleeves and with short trousers. */
const SHORT_SLEEVES = 0.45;
const SHORT_TROUSERS = 0.15;

/** Cloth that is less unlike the skin than this looks like skin. */
const LIKE_SKIN = 0.1;

export interface Clothing {
  shirt: Color;
  trousers: Color;
  skin: Color;
  hair: Color;
  shoes: Color;
  /** From the elbow and from the knee down. */
  forearm: Color;
  shin: Color;
  hairdo: Hairdo;
}

/**
 * The clothes of an avatar: what its person has chosen, and the rest always the same for the same
 * id. Sleeves go with a shirt that is chosen, and shoes with trousers, so that they stay the same
 * from one visit to the next.
 */
export function clothingOf(id: number, look: Look | null = null): Clothing {
  const [shirtNo, trousersNo, hairNo, hairColourNo, skinNo] = look ?? [0, 0, 0, 0, 0];
  const skin = chosen(SKINS, skinNo) ?? pick(OF_IDS.skins, id, 3);
  const shirt = chosen(SHIRTS, shirtNo) ?? pick(unlike(skin, OF_IDS.shirts), id, 1);
  const trousers = chosen(TROUSERS, trousersNo) ?? pick(unlike(skin, OF_IDS.trousers), id, 2);
  const [shirtSeed, trousersSeed] = [shirtNo || id, trousersNo || id];
  const { hairdos } = OF_IDS;
  const natural = hairdos[Math.floor(scatter(id, 10) * hairdos.length)] ?? "short";
  const hairdo = HAIRDOS[hairNo - 1];
  return {
    shirt,
    trousers,
    skin,
    hair: chosen(HAIR_COLOURS, hairColourNo) ?? pick(OF_IDS.hairs, id, 4),
    shoes: pick(SHOES, trousersSeed, 7),
    forearm: scatter(shirtSeed, 8) < SHORT_SLEEVES ? skin : shirt,
    shin: scatter(trousersSeed, 9) < SHORT_TROUSERS ? skin : trousers,
    hairdo: hairdo ? hairdo[1] : natural,
  };
}

/** The colour of that number; null if none is chosen, or one of a later version. */
function chosen(from: readonly Choice<string>[], number: number): Color | null {
  const choice = from[number - 1];
  return choice ? new Color(choice[1]) : null;
}

/** The colours of cloth that nobody takes for the skin. */
function unlike(skin: Color, cloth: readonly string[]): string[] {
  return cloth.filter((colour) => unlikeness(new Color(colour), skin) > LIKE_SKIN);
}

function colours(choices: readonly Choice<string>[]): string[] {
  return choices.map(([, colour]) => colour);
}
