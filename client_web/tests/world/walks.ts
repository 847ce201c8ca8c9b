/** Steps of a walk along +x, as a server would send them. */

import { KEY_NUMBERS, KeyNumber, STEP_KEYS, type StepRecord } from "../../src/net/steps";
import type { Pose } from "../../src/world/interpolation";

export const STEP_S = 0.5;
export const STEP_M = 0.6;
export const SPEED_MPS = STEP_M / STEP_S;
const ASIDE_M = 0.1;
const HIPS_M = 0.85;

/** Step `index`, 0 first: the body comes from x = 0, half a step for each that it takes. */
export function stepAlong(index: number, change: Partial<StepRecord> = {}): StepRecord {
  const rightStands = index % 2 === 1;
  const side = rightStands ? -1 : 1;
  const standing = { x: index * STEP_M, y: side * ASIDE_M, z: 0, heading: 0 };
  const landing = { x: (index + 1) * STEP_M, y: -side * ASIDE_M, z: 0, heading: 0 };
  const keys = new Float64Array(STEP_KEYS * KEY_NUMBERS);
  for (let k = 0; k < STEP_KEYS; k++) {
    const u = k / (STEP_KEYS - 1);
    const row = k * KEY_NUMBERS;
    keys[row + KeyNumber.PELVIS] = keys[row + KeyNumber.CHEST] = 1;
    keys.set([(u - 0.5) * STEP_M, -side * ASIDE_M, HIPS_M], row + KeyNumber.ROOT);
    keys.set([2 * (u - 1) * STEP_M, 0, 0.1 * Math.sin(Math.PI * u)], row + KeyNumber.ANKLE);
  }
  const record = { id: 1, rightStands, continues: false, tick: 0, ticks: 10, standing, landing };
  return { ...record, lift: 0, flight: 0, keys, ...change };
}

/** The pose in snapshots at a time after the walk began. */
export function placeAt(timeS: number): Pose {
  const x = SPEED_MPS * timeS - STEP_M / 2;
  return { x, y: 0, z: 0, layer: 0, heading: 0, speed: SPEED_MPS, reason: 0 };
}
