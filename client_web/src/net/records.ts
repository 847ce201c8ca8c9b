/** The packed record of one avatar (see `protocol/snapshot.py`), as snapshots and maps have it. */

import type { EntityRecord } from "./messages";

export const RECORD_BYTES = 14;
const POSITION_M = 0.01;
const HEADING_RAD = (2 * Math.PI) / 256;
const SPEED_MPS = 0.02;

/** The record that begins at `at`, in world coordinates. */
export function readRecord(
  view: DataView,
  at: number,
  origin: readonly [number, number],
): EntityRecord {
  return {
    id: view.getUint32(at, true),
    layer: view.getUint8(at + 4),
    reason: view.getUint8(at + 5),
    x: view.getUint16(at + 6, true) * POSITION_M + origin[0],
    y: view.getUint16(at + 8, true) * POSITION_M + origin[1],
    z: view.getInt16(at + 10, true) * POSITION_M,
    heading: view.getUint8(at + 12) * HEADING_RAD,
    speed: view.getUint8(at + 13) * SPEED_MPS,
  };
}
