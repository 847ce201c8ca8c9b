/** Binary frames of the live map: a header, and the records of everybody who has moved. */

import { WireError } from "../../net/errors";
import type { EntityRecord } from "../../net/messages";
import { readRecord, RECORD_BYTES } from "../../net/records";

const HEADER_BYTES = 12;
const MAP_FRAME = 1;

export interface Header {
  /** Whether everybody is in it. */
  whole: boolean;
  tick: number;
  count: number;
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
  take: (record: EntityRecord) => void,
): void {
  for (let index = 0; index < count; index++) {
    take(readRecord(view, HEADER_BYTES + index * RECORD_BYTES, origin));
  }
}
