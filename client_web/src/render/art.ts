/** The exhibits of a gallery: framed pictures and sculptures, a different one for every place. */

import {
  type BufferGeometry,
  type Color,
  IcosahedronGeometry,
  SphereGeometry,
  TorusGeometry,
} from "three";
import { type Block, within } from "./blocks";
import { artOf, CANVAS, FRAME, MARBLE, sculptureOf } from "./interiorpalette";
import { scatter } from "./palette";
import { column, painted } from "./shapes";

const FRAME_M = 0.06;

/** A frame, a mount, and fields of colour on it, to be seen from both sides. */
export function painting(block: Block, index: number): BufferGeometry[] {
  const { lengthM, widthM, heightM } = block;
  const [l, h] = [lengthM - 2 * FRAME_M, heightM - 2 * FRAME_M];
  const parts = [
    within(block, [0, 0, heightM / 2], [lengthM, widthM, heightM], FRAME),
    within(block, [0, 0, heightM / 2], [l, widthM + 0.02, h], CANVAS),
  ];
  // Bands of a landscape: each next one begins where the last one ended.
  const bands = 3 + Math.floor(scatter(index, 40) * 3);
  let from = 0;
  for (let band = 0; band < bands; band++) {
    const last = band === bands - 1;
    const to = last ? 1 : from + ((1 - from) * (0.25 + 0.4 * scatter(index, 50 + band))) / 1.2;
    const up = FRAME_M + h * (0.06 + 0.44 * (from + to));
    const size = [l * 0.88, widthM + 0.03, h * 0.88 * (to - from)] as const;
    parts.push(within(block, [0, 0, up], size, artOf(index * 5 + band)));
    from = to;
  }
  const sun = 0.12 + 0.1 * scatter(index, 60);
  const at = (scatter(index, 61) - 0.5) * l * 0.5;
  const size = [l * sun, widthM + 0.04, l * sun] as const;
  parts.push(within(block, [at, 0, heightM * 0.68], size, artOf(index * 7 + 3)));
  return parts;
}

/** A plinth, and on it one of some abstract figures. */
export function sculpture(block: Block, index: number): BufferGeometry[] {
  const { x, y, z, lengthM, widthM, heightM } = block;
  const plinthM = Math.min(0.8, heightM * 0.36);
  const side = Math.min(lengthM, widthM);
  const foot = z + plinthM;
  const tallM = heightM - plinthM;
  const color = sculptureOf(index);
  const figure = FIGURES[Math.floor(scatter(index, 71) * FIGURES.length)] ?? needle;
  return [
    within(block, [0, 0, plinthM / 2], [lengthM, widthM, plinthM], MARBLE),
    ...figure([x, y, foot], { tallM, wideM: side * 0.8 }, color),
  ];
}

type At = readonly [x: number, y: number, z: number];
interface Extent {
  tallM: number;
  wideM: number;
}
type Figure = (at: At, extent: Extent, color: Color) => BufferGeometry[];

/** Stones that lie on each other. */
const cairn: Figure = ([x, y, z], { tallM, wideM }, color) => {
  const radii = [0.26, 0.2, 0.14].map((part) => part * tallM);
  let top = z;
  return radii.map((radius, i) => {
    const ball = new IcosahedronGeometry(radius, 1);
    ball.scale(Math.min(1, wideM / 2 / radius), Math.min(1, wideM / 2 / radius), 0.85);
    ball.rotateZ(i * 1.1).translate(x, y, top + radius * 0.85);
    top += radius * 1.6;
    return painted(ball, color);
  });
};

/** A ring that stands upright. */
const ring: Figure = ([x, y, z], { tallM, wideM }, color) => {
  const radius = Math.min(tallM / 2, wideM / 2) * 0.8;
  const torus = new TorusGeometry(radius, radius * 0.22, 8, 24);
  torus.scale(1, tallM / (2.44 * radius), 1).rotateX(Math.PI / 2);
  torus.rotateZ(0.6).translate(x, y, z + tallM / 2);
  return [painted(torus.toNonIndexed(), color)];
};

/** Somebody in a long coat. */
const walker: Figure = ([x, y, z], { tallM, wideM }, color) => {
  const head = new SphereGeometry(tallM * 0.09, 12, 8).translate(x, y, z + tallM * 0.9);
  return [
    column([x, y, z], { top: wideM * 0.16, bottom: wideM * 0.42 }, tallM * 0.72, color),
    column(
      [x, y, z + tallM * 0.72],
      { top: wideM * 0.1, bottom: wideM * 0.24 },
      tallM * 0.1,
      color,
    ),
    painted(head.toNonIndexed(), color),
  ];
};

const needle: Figure = ([x, y, z], { tallM, wideM }, color) => [
  column([x, y, z], { top: wideM * 0.22, bottom: wideM * 0.4 }, tallM * 0.86, color),
  column([x, y, z + tallM * 0.86], { top: 0.01, bottom: wideM * 0.22 }, tallM * 0.14, color),
];

const FIGURES: readonly Figure[] = [cairn, ring, walker, needle];
