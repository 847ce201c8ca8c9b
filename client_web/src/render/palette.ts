/** The colours of the world, and how chance picks among colours. */

import { Color } from "three";

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
export const GUIDE = new Color("#e0402f");

const FACADES = ["#e2d3b8", "#d9b79a", "#c98f73", "#e8e0d0", "#b9c2c4", "#d7c7a0", "#cfa98c"];
const LEAVES = ["#5f8f45", "#6f9f4c", "#4f7f40", "#7fa655"];
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
