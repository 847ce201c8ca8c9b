/** Furniture: the looks of a prism of that kind follow from its measures. */

import type { BufferGeometry } from "three";
import type { ScenePolygon } from "../net/messages";
import { painting, sculpture } from "./art";
import { type Block, blockOf, within } from "./blocks";
import { bookOf, GLASS, MARBLE } from "./interiorpalette";
import { IRON, scatter, WOOD } from "./palette";
import { orientation } from "./shapes";

const BENCH_M = 0.55;
const TABLE_M = 0.9;
const SHOWCASE_M = 1.25;
/** Thinner panels hang on a wall. */
const PICTURE_M = 0.2;
/** A piece that is this much longer than wide stands like a wall. */
const SLENDER = 1.8;
const SHELVES_M = 2.5;
const BOARD_M = 0.04;
const BOOKS_M = 0.42;

export function furniture(polygon: ScenePolygon, index: number): BufferGeometry[] {
  const block = blockOf(polygon);
  const { lengthM, widthM, heightM } = block;
  if (isHung(polygon)) return painting(block, index);
  if (heightM <= BENCH_M) return bench(block);
  if (heightM <= TABLE_M) return table(block);
  if (heightM <= SHOWCASE_M) return showcase(block);
  if (lengthM < SLENDER * widthM) return sculpture(block, index);
  return lengthM >= SHELVES_M ? shelves(block, index) : screen(block, index);
}

/** A picture on a wall. */
export function isHung({ points, height_m }: ScenePolygon): boolean {
  return orientation(points).widthM <= PICTURE_M && height_m > PICTURE_M;
}

/** Three slats on two feet. */
function bench(block: Block): BufferGeometry[] {
  const { lengthM, widthM, heightM } = block;
  const slats = [-1, 0, 1].map((slat) =>
    within(block, [0, (slat * widthM) / 3, heightM - 0.04], [lengthM, widthM * 0.28, 0.08], WOOD),
  );
  const feet = [-1, 1].map((end) =>
    within(
      block,
      [end * (lengthM / 2 - 0.2), 0, (heightM - 0.08) / 2],
      [0.1, widthM * 0.85, heightM - 0.08],
      IRON,
    ),
  );
  return [...slats, ...feet];
}

function table(block: Block): BufferGeometry[] {
  const { lengthM, widthM, heightM } = block;
  const legs = [-1, 1].flatMap((end) =>
    [-1, 1].map((side) =>
      within(
        block,
        [end * (lengthM / 2 - 0.1), side * (widthM / 2 - 0.1), heightM / 2],
        [0.07, 0.07, heightM],
        IRON,
      ),
    ),
  );
  return [within(block, [0, 0, heightM - 0.03], [lengthM, widthM, 0.06], WOOD), ...legs];
}

/** A case on a base, under glass. */
function showcase(block: Block): BufferGeometry[] {
  const { lengthM, widthM, heightM } = block;
  const baseM = heightM * 0.72;
  const [l, w] = [lengthM - 0.06, widthM - 0.06];
  return [
    within(block, [0, 0, 0.04], [l - 0.1, w - 0.1, 0.08], IRON),
    within(block, [0, 0, 0.08 + (baseM - 0.08) / 2], [lengthM, widthM, baseM - 0.08], MARBLE),
    within(block, [0, 0, (baseM + heightM) / 2], [l, w, heightM - baseM - 0.03], GLASS),
    within(block, [0, 0, heightM - 0.015], [lengthM, widthM, 0.03], IRON),
  ];
}

/** Boards full of books on both sides. */
function shelves(block: Block, index: number): BufferGeometry[] {
  const { lengthM, widthM, heightM } = block;
  const rows = Math.max(2, Math.round((heightM - 0.1) / BOOKS_M));
  const rowM = (heightM - 0.1) / rows;
  const parts = [within(block, [0, 0, heightM / 2], [lengthM, widthM - 0.24, heightM], WOOD)];
  for (const end of [-1, 1]) {
    const at = (end * (lengthM - BOARD_M)) / 2;
    parts.push(within(block, [at, 0, heightM / 2], [BOARD_M, widthM, heightM], WOOD));
  }
  for (let row = 0; row <= rows; row++) {
    const up = 0.05 + row * rowM;
    parts.push(within(block, [0, 0, up], [lengthM, widthM, BOARD_M], WOOD));
    if (row === rows) continue;
    for (const side of [-1, 1]) {
      let at = -lengthM / 2 + 0.08;
      for (let book = 0; ; book++) {
        const salt = 100 * row + 2 * book + side;
        const thickM = 0.18 + 0.4 * scatter(index, salt);
        if (at + thickM > lengthM / 2 - 0.08) break;
        const tallM = rowM * (0.6 + 0.28 * scatter(index, salt + 7));
        parts.push(
          within(
            block,
            [at + thickM / 2, side * (widthM / 2 - 0.07), up + tallM / 2],
            [thickM - 0.02, 0.1, tallM],
            bookOf(index * 31 + salt),
          ),
        );
        at += thickM + (scatter(index, salt + 3) < 0.15 ? 0.3 : 0);
      }
    }
  }
  return parts;
}

/** A wall of its own with a picture on both sides. */
function screen(block: Block, index: number): BufferGeometry[] {
  const { lengthM, widthM, heightM, x, y, z, angle } = block;
  const parts = [within(block, [0, 0, heightM / 2], [lengthM, widthM, heightM], MARBLE)];
  for (const side of [-1, 1]) {
    const out = (side * widthM) / 2;
    const picture: Block = {
      ...block,
      x: x - out * Math.sin(angle),
      y: y + out * Math.cos(angle),
      z: z + 0.75,
      lengthM: lengthM * 0.72,
      widthM: 0.06,
      heightM: heightM - 1,
    };
    parts.push(...painting(picture, index + side));
  }
  return parts;
}
