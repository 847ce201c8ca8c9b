/** The records of a message of steps (see `protocol/steps.py`). */

import { WireError } from "./errors";
import { number, STEP_KEYS, WHOLE_NUMBERS, Whole, wholeKeys } from "./step_keys";

/** The place of a heel on the ground, metres; `heading` is that of the toe, radians from +x. */
export interface Footprint {
  x: number;
  y: number;
  z: number;
  heading: number;
}

/**
 * One step of a foot. While the standing foot stays on its footprint, the swing foot goes to the
 * landing one, where it will stand during the next step.
 */
export interface StepRecord {
  id: number;
  rightStands: boolean;
  /** Takes the place of the rest of a step that is under way. */
  continues: boolean;
  tick: number;
  /** Duration; 0 for a walker that just stands, in the pose of all its keys. */
  ticks: number;
  standing: Footprint;
  landing: Footprint;
  /** Share of the duration until which the swing foot's toe stays where key 0 has it. */
  lift: number;
  /** Share of the duration, at its end, in which the standing foot is in the air: the body runs. */
  flight: number;
  /** A row of `KEY_NUMBERS` for each key; `KeyNumber` says where each number is. */
  keys: Float64Array;
}

/** Metres, radians, quaternions w, x, y, z; places in the world's axes. */
export const KeyNumber = {
  /** Centre between the hips x, y, z from the standing footprint. */
  ROOT: 0,
  PELVIS: 3,
  /** Ankle of the swing foot x, y, z from the landing footprint. */
  ANKLE: 7,
  /** Toe-up positive, as the next. */
  SWING_PITCH: 10,
  STANDING_PITCH: 11,
  /** From the landing footprint's heading. */
  SWING_HEADING: 12,
  /** Against the pelvis, whose roll it undoes. */
  CHEST: 13,
  /** Flexion of shoulder left, shoulder right, elbow left, elbow right. */
  ARMS: 17,
} as const;

export const KEY_NUMBERS = 21;
export { STEP_KEYS };

/** Every record begins with its kind and its length, so that others than walking steps may come. */
const RECORD_HEAD_BYTES = 3;
const WALKING = 1;
const STEP_BYTES = 140;
const RE_AIMED = 2;
/** The flags above the lowest bits are the share that is flown. */
const FLIGHT_SHIFT = 2;
const FLIGHT = 1 / 128;
const FOOTPRINT_M = 1e-4;
const FOOTPRINT_RAD = (2 * Math.PI) / 65536;
const KEY_M = 1e-4;
const FOOT_RAD = 1e-4;
const TRUNK_RAD = 1 / 512;
const ARM_RAD = 1 / 80;

/**
 * The walking steps of a block, in their order. Records of other kinds are passed over, and so is
 * what later versions add at the end of a walking step.
 */
export function unpackSteps(block: Uint8Array): StepRecord[] {
  const view = new DataView(block.buffer, block.byteOffset, block.byteLength);
  const records: StepRecord[] = [];
  let number = 0;
  for (let at = 0; at < block.byteLength; number++) {
    const left = block.byteLength - at;
    const where = `record ${number} at byte ${at} of a block of steps`;
    if (left < RECORD_HEAD_BYTES) {
      throw new WireError(
        `${where} ends after ${left} of the ${RECORD_HEAD_BYTES} bytes of its head`,
      );
    }
    const kind = view.getUint8(at);
    const length = view.getUint16(at + 1, true);
    const least = kind === WALKING ? STEP_BYTES : RECORD_HEAD_BYTES;
    if (length < least) {
      throw new WireError(
        `${where} says a length of ${length} bytes, one of kind ${kind} has at least ${least}`,
      );
    }
    if (length > left) {
      throw new WireError(`${where} says a length of ${length} bytes, ${left} are left`);
    }
    if (kind === WALKING) records.push(walkingStep(view, at));
    at += length;
  }
  return records;
}

function walkingStep(view: DataView, at: number): StepRecord {
  const flags = view.getUint8(at + 7);
  const standing = whole(view, at + 14);
  const landing = [0, 1, 2].map((i) => number(standing, i) + view.getInt16(at + 28 + 2 * i, true));
  return {
    id: view.getUint32(at + 3, true),
    rightStands: (flags & 1) !== 0,
    continues: (flags & RE_AIMED) !== 0,
    tick: view.getUint32(at + 8, true),
    ticks: view.getUint8(at + 12),
    lift: view.getUint8(at + 13) / 255,
    flight: (flags >> FLIGHT_SHIFT) * FLIGHT,
    standing: footprint(standing, view.getUint16(at + 26, true)),
    landing: footprint(landing, view.getUint16(at + 34, true)),
    keys: keys(wholeKeys(view, at, (flags & RE_AIMED) !== 0)),
  };
}

function whole(view: DataView, at: number): number[] {
  return [0, 4, 8].map((offset) => view.getInt32(at + offset, true));
}

function footprint(place: number[], heading: number): Footprint {
  return {
    x: number(place, 0) * FOOTPRINT_M,
    y: number(place, 1) * FOOTPRINT_M,
    z: number(place, 2) * FOOTPRINT_M,
    heading: heading * FOOTPRINT_RAD,
  };
}

/** Poses from the whole numbers of keys. */
function keys(rows: Float64Array): Float64Array {
  const out = new Float64Array(STEP_KEYS * KEY_NUMBERS);
  for (let k = 0; k < STEP_KEYS; k++) {
    const from = rows.subarray(k * WHOLE_NUMBERS, (k + 1) * WHOLE_NUMBERS);
    const row = out.subarray(k * KEY_NUMBERS, (k + 1) * KEY_NUMBERS);
    for (let i = 0; i < 3; i++) {
      row[KeyNumber.ROOT + i] = number(from, Whole.ROOT + i) * KEY_M;
      row[KeyNumber.ANKLE + i] = number(from, Whole.ANKLE + i) * KEY_M;
    }
    row[KeyNumber.SWING_PITCH] = number(from, Whole.SWING_PITCH) * FOOT_RAD;
    row[KeyNumber.STANDING_PITCH] = number(from, Whole.STANDING_PITCH) * FOOT_RAD;
    row[KeyNumber.SWING_HEADING] = number(from, Whole.SWING_HEADING) * FOOT_RAD;
    for (let i = 0; i < 4; i++) row[KeyNumber.ARMS + i] = number(from, Whole.ARMS + i) * ARM_RAD;
    turnTrunk(from, row);
  }
  return out;
}

/** The pelvis rolls, leans and turns; the spine undoes the roll and twists. */
function turnTrunk(from: Float64Array, row: Float64Array): void {
  const yaw = 0.5 * number(from, Whole.YAW) * FOOTPRINT_RAD;
  const lean = 0.5 * number(from, Whole.LEAN) * TRUNK_RAD;
  const roll = 0.5 * number(from, Whole.ROLL) * TRUNK_RAD;
  const twist = 0.5 * number(from, Whole.TWIST) * TRUNK_RAD;
  const [cz, cy, cx, ct] = [Math.cos(yaw), Math.cos(lean), Math.cos(roll), Math.cos(twist)];
  const [sz, sy, sx, st] = [Math.sin(yaw), Math.sin(lean), Math.sin(roll), Math.sin(twist)];
  row[KeyNumber.PELVIS] = cz * cy * cx + sz * sy * sx;
  row[KeyNumber.PELVIS + 1] = cz * cy * sx - sz * sy * cx;
  row[KeyNumber.PELVIS + 2] = cz * sy * cx + sz * cy * sx;
  row[KeyNumber.PELVIS + 3] = sz * cy * cx - cz * sy * sx;
  row[KeyNumber.CHEST] = cx * ct;
  row[KeyNumber.CHEST + 1] = -sx * ct;
  row[KeyNumber.CHEST + 2] = sx * st;
  row[KeyNumber.CHEST + 3] = cx * st;
}
