/** Heads: a face that shows where it looks, hair in four fashions, and the hat of actors. */

import { type BufferGeometry, Color, ConeGeometry, SphereGeometry } from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import { type Section, loft, oval, type Oval, skin, WHITE } from "./loft";
import { painted } from "./shapes";

type HairName = "short" | "long" | "bun" | "curls";

const EYE = new Color("#1d1a18");
const BROW = new Color("#5d4a40");
const LIPS = new Color("#b8736a");
const POST = new Color("#3c4148");

/** From the foot of the neck, in shares of the trunk. */
export function head(corners: number): BufferGeometry {
  const skull = loft(
    [
      { z: 0.321, depth: 0.024, width: 0.022, x: -0.008 },
      { z: 0.311, depth: 0.058, width: 0.05, x: -0.008 },
      { z: 0.29, depth: 0.083, width: 0.068, x: -0.006 },
      { z: 0.25, depth: 0.098, width: 0.08, x: -0.004 },
      { z: 0.205, depth: 0.098, width: 0.081, x: 0 },
      { z: 0.165, depth: 0.09, width: 0.075, x: 0.008 },
      { z: 0.13, depth: 0.078, width: 0.064, x: 0.019 },
      { z: 0.1, depth: 0.062, width: 0.05, x: 0.031 },
      { z: 0.082, depth: 0.036, width: 0.032, x: 0.044 },
    ],
    corners,
  );
  const neck = loft(
    [
      { z: 0.15, depth: 0.05, width: 0.049, x: -0.016 },
      { z: 0.07, depth: 0.05, width: 0.049, x: -0.016 },
      { z: 0.02, depth: 0.056, width: 0.06, x: -0.018 },
      { z: -0.02, depth: 0.06, width: 0.075, x: -0.018 },
    ],
    corners,
  );
  const nose = new ConeGeometry(0.02, 0.062, corners > 8 ? 7 : 4, 1)
    .rotateX(Math.PI / 2)
    .rotateY(-0.34)
    .translate(0.096, 0, 0.19);
  const eyes = [-1, 1].flatMap((side) => [
    ball(corners, [0.0885, side * 0.034, 0.213], [0.009, 0.0115, 0.0135], EYE),
    ball(corners, [0.086, side * 0.036, 0.238], [0.01, 0.02, 0.0045], BROW),
    ball(corners, [-0.004, side * 0.081, 0.2], [0.02, 0.009, 0.03], WHITE),
  ]);
  const mouth = ball(corners, [0.092, 0, 0.138], [0.01, 0.026, 0.0065], LIPS);
  return merge([skull, neck, painted(nose, WHITE), ...eyes, mouth]);
}

/** Ovals that slope: the front is higher by `slope` for each metre to the front. */
type Curl = Oval & { slope?: number };

const CROWN: readonly Curl[] = [
  { z: 0.34, depth: 0.024, width: 0.022, x: -0.012 },
  { z: 0.33, depth: 0.064, width: 0.056, x: -0.012, slope: 0.05 },
  { z: 0.306, depth: 0.093, width: 0.079, x: -0.012, slope: 0.12 },
  { z: 0.27, depth: 0.108, width: 0.091, x: -0.012, slope: 0.2 },
];
const SHORT: readonly Curl[] = [
  ...CROWN,
  { z: 0.225, depth: 0.108, width: 0.092, x: -0.014, slope: 0.55 },
  { z: 0.205, depth: 0.1, width: 0.086, x: -0.014, slope: 0.6 },
];
const FASHIONS: Record<HairName, readonly Curl[]> = {
  short: SHORT,
  bun: SHORT,
  long: [
    ...CROWN,
    { z: 0.225, depth: 0.105, width: 0.098, x: -0.02, slope: 0.5 },
    { z: 0.16, depth: 0.072, width: 0.103, x: -0.055, slope: 0.35 },
    { z: 0.08, depth: 0.048, width: 0.1, x: -0.075 },
    { z: 0.0, depth: 0.034, width: 0.086, x: -0.09 },
    { z: -0.03, depth: 0.018, width: 0.06, x: -0.095 },
  ],
  curls: [
    { z: 0.385, depth: 0.03, width: 0.03, x: -0.015 },
    { z: 0.372, depth: 0.085, width: 0.078, x: -0.015, slope: 0.04 },
    { z: 0.335, depth: 0.128, width: 0.118, x: -0.018, slope: 0.12 },
    { z: 0.285, depth: 0.145, width: 0.136, x: -0.022, slope: 0.2 },
    { z: 0.235, depth: 0.14, width: 0.134, x: -0.03, slope: 0.45 },
    { z: 0.185, depth: 0.108, width: 0.118, x: -0.052, slope: 0.5 },
    { z: 0.155, depth: 0.07, width: 0.09, x: -0.062, slope: 0.4 },
  ],
};

export function hair(name: HairName, corners: number): BufferGeometry {
  const cut = skin(FASHIONS[name].map((curl) => sloped(curl, corners)));
  if (name !== "bun") return cut;
  return merge([cut, ball(corners, [-0.115, 0, 0.29], [0.042, 0.045, 0.042], WHITE)]);
}

/** The green cap of actors. */
export function hat(corners: number): BufferGeometry {
  const crown = skin(
    (
      [
        { z: 0.362, depth: 0.03, width: 0.028, x: -0.008 },
        { z: 0.353, depth: 0.07, width: 0.062, x: -0.008, slope: 0.02 },
        { z: 0.325, depth: 0.1, width: 0.086, x: -0.01, slope: 0.06 },
        { z: 0.268, depth: 0.116, width: 0.1, x: -0.01, slope: 0.1 },
        { z: 0.26, depth: 0.1, width: 0.09, x: -0.01, slope: 0.1 },
      ] satisfies Curl[]
    ).map((curl) => sloped(curl, corners)),
  );
  const peak = skin(
    (
      [
        { z: 0.282, depth: 0.07, width: 0.07, x: 0.085, slope: -0.22 },
        { z: 0.278, depth: 0.083, width: 0.078, x: 0.09, slope: -0.22 },
        { z: 0.27, depth: 0.08, width: 0.075, x: 0.09, slope: -0.22 },
      ] satisfies Curl[]
    ).map((curl) => sloped(curl, corners)),
  );
  return merge([crown, peak]);
}

/** The lantern that guides hold over their heads, to be found by from all sides. */
export function sign(corners: number): BufferGeometry {
  const round = (z: number, radius: number, color?: Color): Section =>
    oval({ z, depth: radius, width: radius, ...(color && { color }) }, corners);
  return skin([
    round(0.36, 0.012, POST),
    round(0.62, 0.012, POST),
    round(0.62, 0.08),
    round(0.68, 0.19),
    round(0.9, 0.19),
    round(0.96, 0.08),
    round(0.98, 0.02, POST),
  ]);
}

function sloped({ slope = 0, ...rest }: Curl, corners: number): Section {
  const { points, color } = oval(rest, corners);
  return { points: points.map(([x, y, z]) => [x, y, z + slope * x] as const), color };
}

/** Details of a face have this part of a limb's corners. */
const DETAIL = 0.55;

function ball(
  corners: number,
  [x, y, z]: readonly [number, number, number],
  [sx, sy, sz]: readonly [number, number, number],
  color: Color,
): BufferGeometry {
  const around = Math.max(4, Math.round(corners * DETAIL));
  return painted(
    new SphereGeometry(1, around, Math.max(3, around - 2)).scale(sx, sy, sz).translate(x, y, z),
    color,
  );
}

/** One geometry of shapes with and without texture coordinates. */
function merge(shapes: BufferGeometry[]): BufferGeometry {
  for (const shape of shapes) shape.deleteAttribute("uv");
  return mergeGeometries(shapes);
}
