/** Binary frames of the live map: a header, and the records of everybody who has moved. */

import { WireError } from "../../net/errors";

const HEADER_BYTES = 12;
const RECORD_BYTES = 14;
const MAP_FRAME = 1;
const POSITION_M = 0.01;
const HEADING_RAD = (2 * Math.PI) / 256;
const SPEED_MPS = 0.02;

export interface Header {
  /** Whether everybody is in it. */
  whole: boolean;
  tick: number;
  count: number;
}

/** One record; the same object is used for all of a frame. */
export interface MapRecord {
  id: number;
  layer: number;
  reason: number;
  x: number;
  y: number;
  z: number;
  heading: number;
  speed: number;
}

export function readHeader(view: DataView): Header {
  if (view.byteLength < HEADER_BYTES || view.getUint8(0) !== MAP_FRAME) {
    throw new WireError("this is no frame of the map");
  }
  const count = view.getUint32(8, true);
  if (view.byteLength !== HEADER_BYTES + count * RECORD_BYTES) {
    throw new WireError(`${view.byteLength} bytes do not hold ${count} records`);
  }
  return { whole: view.getUint8(1) === 1, tick: view.getUint32(4, true), count };
}

/** Hand each record of a frame on, in world coordinates. */
export function readRecords(
  view: DataView,
  count: number,
  origin: readonly [number, number],
  take: (record: Readonly<MapRecord>) => void,
): void {
  const record: MapRecord = { id: 0, layer: 0, reason: 0, x: 0, y: 0, z: 0, heading: 0, speed: 0 };
  for (let index = 0; index < count; index++) {
    const at = HEADER_BYTES + index * RECORD_BYTES;
    record.id = view.getUint32(at, true);
    record.layer = view.getUint8(at + 4);
    record.reason = view.getUint8(at + 5);
    record.x = view.getUint16(at + 6, true) * POSITION_M + origin[0];
    record.y = view.getUint16(at + 8, true) * POSITION_M + origin[1];
    record.z = view.getInt16(at + 10, true) * POSITION_M;
    record.heading = view.getUint8(at + 12) * HEADING_RAD;
    record.speed = view.getUint8(at + 13) * SPEED_MPS;
    take(record);
  }
}
