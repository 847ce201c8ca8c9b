/** The colours of the world and of avatars' clothes. */

import { Color } from "three";
import { unlikeness } from "./likeness";

export const SKY_TOP = new Color("#5d9bd3");
export const SKY_LOW = new Color("#dbe9f2");
export const PAVING = new Color("#cfc6b6");
export const STONE = new Color("#bdb3a3");
export const PLASTER = new Color("#e6dccb");
export const FLOOR = new Color("#dccaa9");
export const TREAD = new Color("#d3c7b3");
export const DARK_STONE = new Color("#8d8578");
export const WOOD = new Color("#9a6b43");
export const IRON = new Color("#3c4148");
export const BARK = new Color("#6b4f38");
export const WATER = new Color("#4ea3c4");
export const ACCENT = new Color("#ffc233");
export const ACTOR = new Color("#0f9d92");

const FACADES = ["#e2d3b8", "#d9b79a", "#c98f73", "#e8e0d0", "#b9c2c4", "#d7c7a0", "#cfa98c"];
const LEAVES = ["#5f8f45", "#6f9f4c", "#4f7f40", "#7fa655"];
const SHIRTS = [
  "#c8413b",
  "#2f6fb5",
  "#e0a031",
  "#4b8f5a",
  "#7d56a8",
  "#d9d4c9",
  "#37474f",
  "#d9728f",
  "#2a9bb0",
  "#8a5a3b",
];
const TROUSERS = ["#2c3440", "#4a5568", "#6b5b4a", "#26324d", "#55524d", "#7b7264"];
const SKINS = ["#f1c9a5", "#e0ac80", "#c68a5e", "#9a643f", "#6f452b"];
const HAIRS = ["#2b1d14", "#4f3421", "#8a5a2b", "#c79a55", "#6e6a66", "#1a1a1f"];
const SHOES = ["#3a2a20", "#26262b", "#e6e2da", "#6d4a2f", "#8c2f2b", "#2f4a63"];

/** Fashions of hair, as parts of figures are named. */
const HAIRDOS = ["short", "short", "short", "long", "long", "bun"] as const;
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
  hairdo: (typeof HAIRDOS)[number];
}

/** The clothes of an avatar, always the same for the same id. */
export function clothingOf(id: number): Clothing {
  const skin = pick(SKINS, id, 3);
  const shirt = pick(unlike(skin, SHIRTS), id, 1);
  const trousers = pick(unlike(skin, TROUSERS), id, 2);
  return {
    shirt,
    trousers,
    skin,
    hair: pick(HAIRS, id, 4),
    shoes: pick(SHOES, id, 7),
    forearm: scatter(id, 8) < SHORT_SLEEVES ? skin : shirt,
    shin: scatter(id, 9) < SHORT_TROUSERS ? skin : trousers,
    hairdo: HAIRDOS[Math.floor(scatter(id, 10) * HAIRDOS.length)] ?? "short",
  };
}

/** The colours of cloth that nobody takes for the skin. */
function unlike(skin: Color, cloth: readonly string[]): string[] {
  return cloth.filter((colour) => unlikeness(new Color(colour), skin) > LIKE_SKIN);
}

export function facadeOf(index: number): Color {
  return pick(FACADES, index, 5);
}

export function leavesOf(index: number): Color {
  return pick(LEAVES, index, 6);
}

/** A number in [0, 1) that belongs to `id` and `salt`. */
export function scatter(id: number, salt: number): number {
  let bits = Math.imul(id + 1, 0x9e3779b1) ^ Math.imul(salt + 1, 0x85ebca6b);
  bits = Math.imul(bits ^ (bits >>> 15), 0x2c1b3c6d);
  bits = Math.imul(bits ^ (bits >>> 12), 0x297a2d39);
  return ((bits ^ (bits >>> 15)) >>> 0) / 0x1_0000_0000;
}

export function pick(from: readonly string[], id: number, salt: number): Color {
  return new Color(from[Math.floor(scatter(id, salt) * from.length)] ?? "#888888");
}
