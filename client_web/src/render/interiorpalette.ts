/** The colours of rooms and of the exhibits in them. */

import { Color } from "three";
import { pick } from "./palette";

export const PARQUET = new Color("#d9b182");
export const TERRAZZO = new Color("#e9dcc6");
export const CEILING = new Color("#cfc6b6");
export const MARBLE = new Color("#eee9df");
export const GLASS = new Color("#b5d6dc");
export const FRAME = new Color("#4a3728");
export const CANVAS = new Color("#f4efe4");

const BOOKS = ["#8c3b32", "#2f5d62", "#c99a3b", "#3d4f77", "#6b7b4b", "#d8cdb4", "#6d4a5e"];
const WARM = ["#d9673f", "#f0b54a", "#c44b58", "#e8d7b0"];
const COOL = ["#2f6f8f", "#8fb8a8", "#1f3a4d", "#5a7d4f"];
const SCULPTURES = ["#8f6a3c", "#5c8f80", "#b65c42", "#e9e2d4", "#4d5a6b"];

export const bookOf = (index: number): Color => pick(BOOKS, index, 11);
export const artOf = (index: number): Color => pick([...WARM, ...COOL], index, 12);
export const sculptureOf = (index: number): Color => pick(SCULPTURES, index, 13);
