/**
 * The parts that figures are put together from, but for heads: +x is forwards, +y to the left, +z up.
 * Limbs hang down from their joint at the origin; lengths are shares of the leg or of the trunk.
 */

import { type BufferGeometry, Color, Float32BufferAttribute, TorusGeometry } from "three";
import { FOOT, FOREARM, SHIN, THIGH, UPPER_ARM } from "../world/skeleton";
import { hair, hat, head, sign } from "./heads";
import { type Section, loft, skin, WHITE } from "./loft";

const BELT = new Color("#4a4038");
/** Half as thick as the hoop is. */
const RAIL = 0.035;
const HEM = new Color("#b9b9b9");

export const PARTS = {
  pelvis,
  torso,
  head,
  short: (corners: number) => hair("short", corners),
  long: (corners: number) => hair("long", corners),
  bun: (corners: number) => hair("bun", corners),
  curls: (corners: number) => hair("curls", corners),
  hat,
  sign,
  upperArm,
  forearm,
  hand,
  thigh,
  shin,
  shoe,
  toes,
  rail,
} satisfies Record<string, (corners: number) => BufferGeometry>;

export type PartName = keyof typeof PARTS;

/** From the middle of the hip joints; in shares of the leg. */
function pelvis(corners: number): BufferGeometry {
  return loft(
    [
      { z: 0.2, depth: 0.093, width: 0.14, color: BELT },
      { z: 0.165, depth: 0.099, width: 0.15, color: BELT },
      { z: 0.163, depth: 0.099, width: 0.15 },
      { z: 0.09, depth: 0.112, width: 0.172, x: -0.004 },
      { z: 0.02, depth: 0.12, width: 0.184, x: -0.012 },
      { z: -0.04, depth: 0.112, width: 0.178, x: -0.012 },
      { z: -0.085, depth: 0.085, width: 0.135, x: -0.008 },
      { z: -0.11, depth: 0.04, width: 0.07 },
    ],
    corners,
  );
}

/** From where the spine bends; in shares of the trunk. */
function torso(corners: number): BufferGeometry {
  return loft(
    [
      { z: 0.408, depth: 0.05, width: 0.052, x: -0.02, color: HEM },
      { z: 0.402, depth: 0.06, width: 0.064, x: -0.02, color: HEM },
      { z: 0.39, depth: 0.064, width: 0.094, x: -0.018 },
      { z: 0.374, depth: 0.066, width: 0.15, x: -0.014 },
      { z: 0.35, depth: 0.068, width: 0.204, x: -0.008, roundness: 0.9 },
      { z: 0.315, depth: 0.086, width: 0.206, x: -0.004, roundness: 0.88 },
      { z: 0.27, depth: 0.105, width: 0.194, roundness: 0.85 },
      { z: 0.21, depth: 0.11, width: 0.18, x: 0.004, roundness: 0.85 },
      { z: 0.13, depth: 0.1, width: 0.162, roundness: 0.85 },
      { z: 0.05, depth: 0.097, width: 0.152, roundness: 0.9 },
      { z: -0.03, depth: 0.106, width: 0.163, roundness: 0.9 },
      { z: -0.085, depth: 0.118, width: 0.18, x: -0.006, roundness: 0.9 },
      { z: -0.1, depth: 0.116, width: 0.178, x: -0.006, roundness: 0.9, color: HEM },
    ],
    corners,
  );
}

function upperArm(corners: number): BufferGeometry {
  return loft(
    [
      { z: 0.034, depth: 0.022, width: 0.02 },
      { z: 0.024, depth: 0.043, width: 0.038 },
      { z: -0.006, depth: 0.058, width: 0.051 },
      { z: -0.07, depth: 0.058, width: 0.052 },
      { z: -0.18, depth: 0.05, width: 0.046 },
      { z: -UPPER_ARM + 0.03, depth: 0.043, width: 0.041 },
      { z: -UPPER_ARM - 0.02, depth: 0.038, width: 0.037 },
      { z: -UPPER_ARM - 0.035, depth: 0.02, width: 0.02 },
    ],
    corners,
  );
}

function forearm(corners: number): BufferGeometry {
  return loft(
    [
      { z: 0.034, depth: 0.02, width: 0.02 },
      { z: 0.018, depth: 0.037, width: 0.037 },
      { z: -0.03, depth: 0.044, width: 0.042 },
      { z: -0.09, depth: 0.042, width: 0.04 },
      { z: -0.18, depth: 0.034, width: 0.031 },
      { z: -FOREARM - 0.01, depth: 0.028, width: 0.024 },
    ],
    corners,
  );
}

/** From the wrist, the palm turned inwards, the fingers a little bent. */
function hand(corners: number): BufferGeometry {
  return loft(
    [
      { z: 0.02, depth: 0.02, width: 0.016 },
      { z: -0.01, depth: 0.023, width: 0.017 },
      { z: -0.05, depth: 0.04, width: 0.02, x: 0.006 },
      { z: -0.085, depth: 0.043, width: 0.021, x: 0.008 },
      { z: -0.125, depth: 0.035, width: 0.018, x: 0.008 },
      { z: -0.165, depth: 0.026, width: 0.015, x: 0.014 },
      { z: -0.183, depth: 0.012, width: 0.01, x: 0.018 },
    ],
    corners,
  );
}

function thigh(corners: number): BufferGeometry {
  return loft(
    [
      { z: 0.07, depth: 0.05, width: 0.045 },
      { z: 0.04, depth: 0.088, width: 0.076 },
      { z: -0.02, depth: 0.1, width: 0.09, x: -0.004 },
      { z: -0.12, depth: 0.096, width: 0.088 },
      { z: -0.25, depth: 0.084, width: 0.076, x: 0.004 },
      { z: -0.38, depth: 0.068, width: 0.063, x: 0.003 },
      { z: -THIGH, depth: 0.06, width: 0.057 },
      { z: -THIGH - 0.035, depth: 0.05, width: 0.05 },
      { z: -THIGH - 0.055, depth: 0.025, width: 0.025 },
    ],
    corners,
  );
}

function shin(corners: number): BufferGeometry {
  return loft(
    [
      { z: 0.055, depth: 0.026, width: 0.026 },
      { z: 0.035, depth: 0.051, width: 0.05 },
      { z: -0.02, depth: 0.06, width: 0.056 },
      { z: -0.12, depth: 0.062, width: 0.057, x: -0.008 },
      { z: -0.22, depth: 0.058, width: 0.054, x: -0.008 },
      { z: -0.36, depth: 0.051, width: 0.049 },
      { z: -SHIN + 0.05, depth: 0.052, width: 0.05, x: 0.01 },
      { z: -SHIN + 0.046, depth: 0.04, width: 0.038, x: 0.01, color: HEM },
    ],
    corners,
  );
}

/** From the heel to the ball of the foot, the sole at z = 0; in shares of the leg. */
function shoe(corners: number): BufferGeometry {
  return skin([
    slice({ x: -0.052, width: 0.026, bottom: 0.03, top: 0.062 }, corners),
    slice({ x: -0.042, width: 0.038, bottom: 0.013, top: 0.088 }, corners),
    slice({ x: -0.02, width: 0.046, bottom: 0.002, top: 0.098 }, corners),
    slice({ x: 0.03, width: 0.046, bottom: 0, top: 0.098 }, corners),
    slice({ x: 0.07, width: 0.046, bottom: 0, top: 0.086 }, corners),
    slice({ x: 0.12, width: 0.049, bottom: 0, top: 0.067 }, corners),
    slice({ x: 0.17, width: 0.054, bottom: 0, top: 0.056 }, corners),
    slice({ x: FOOT + 0.004, width: 0.054, bottom: 0.001, top: 0.051 }, corners),
    slice({ x: FOOT + 0.02, width: 0.04, bottom: 0.012, top: 0.038 }, corners),
  ]);
}

/** From the ball of the foot to the tip of the shoe. */
function toes(corners: number): BufferGeometry {
  return skin([
    slice({ x: -0.024, width: 0.044, bottom: 0.01, top: 0.042 }, corners),
    slice({ x: -0.01, width: 0.0535, bottom: 0, top: 0.0525 }, corners),
    slice({ x: 0.02, width: 0.052, bottom: 0, top: 0.048 }, corners),
    slice({ x: 0.05, width: 0.043, bottom: 0.003, top: 0.041 }, corners),
    slice({ x: 0.068, width: 0.028, bottom: 0.009, top: 0.033 }, corners),
    slice({ x: 0.074, width: 0.012, bottom: 0.016, top: 0.025 }, corners),
  ]);
}

/** A hoop around a body that is wider than its figure; in shares of the body's radius. */
function rail(corners: number): BufferGeometry {
  const hoop = new TorusGeometry(1 - RAIL, RAIL, corners, 3 * corners);
  const white = new Float32Array(3 * hoop.getAttribute("position").count).fill(1);
  return hoop.setAttribute("color", new Float32BufferAttribute(white, 3));
}

/** Across a shoe, seen from behind: arched above from right to left, flat below. */
function slice(
  { x, width, bottom, top }: { x: number; width: number; bottom: number; top: number },
  corners: number,
): Section {
  const arch = corners - 4;
  const rim = Math.min(bottom + 0.016, (bottom + top) / 2);
  const points = Array.from({ length: arch + 1 }, (_, i) => {
    const angle = (Math.PI * i) / arch;
    const y = -width * (0.75 * Math.cos(angle) + 0.25 * Math.cos(angle) ** 3);
    return [x, y, rim + (top - rim) * Math.sin(angle) ** 0.8] as const;
  });
  return {
    points: [...points, [x, width, bottom], [x, 0, bottom], [x, -width, bottom]],
    color: WHITE,
  };
}
