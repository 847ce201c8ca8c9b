/** The records of a message of steps (see `protocol/steps.py`). */

import { WireError } from "./errors";

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
  /** A row of `KEY_NUMBERS` for each key; `KeyNumber` says where each number is. */
  keys: Float64Array;
}

export const STEP_KEYS = 6;

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
  /** Against the pelvis. */
  CHEST: 13,
  /** Flexion of shoulder left, shoulder right, elbow left, elbow right. */
  ARMS: 17,
} as const;

export const KEY_NUMBERS = 21;

/** Every record begins with its kind and its length, so that others than walking steps may come. */
const RECORD_HEAD_BYTES = 3;
const WALKING = 1;
const STEP_BYTES = 228;
const KEYS_AT = 42;
const KEY_BYTES = 31;
const FOOTPRINT_M = 1e-4;
const FOOTPRINT_RAD = (2 * Math.PI) / 65536;
const KEY_M = 1e-4;
const FOOT_RAD = 1e-4;
const ARM_RAD = 1 / 40;
const SMALLEST_THREE = Math.SQRT1_2 / 16383;
const NEAR_IDENTITY = 0.5 / 127;

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
  return {
    id: view.getUint32(at + 3, true),
    rightStands: (flags & 1) !== 0,
    continues: (flags & 2) !== 0,
    tick: view.getUint32(at + 8, true),
    ticks: view.getUint8(at + 12),
    standing: footprint(view, at + 13),
    landing: footprint(view, at + 27),
    lift: view.getUint8(at + 41) / 255,
    keys: keys(view, at + KEYS_AT),
  };
}

function footprint(view: DataView, at: number): Footprint {
  return {
    x: view.getInt32(at, true) * FOOTPRINT_M,
    y: view.getInt32(at + 4, true) * FOOTPRINT_M,
    z: view.getInt32(at + 8, true) * FOOTPRINT_M,
    heading: view.getUint16(at + 12, true) * FOOTPRINT_RAD,
  };
}

function keys(view: DataView, begin: number): Float64Array {
  const numbers = new Float64Array(STEP_KEYS * KEY_NUMBERS);
  for (let key = 0; key < STEP_KEYS; key++) {
    const at = begin + key * KEY_BYTES;
    const row = numbers.subarray(key * KEY_NUMBERS, (key + 1) * KEY_NUMBERS);
    for (let i = 0; i < 3; i++) {
      row[KeyNumber.ROOT + i] = view.getInt16(at + 2 * i, true) * KEY_M;
      row[KeyNumber.ANKLE + i] = view.getInt16(at + 12 + 2 * i, true) * KEY_M;
    }
    row.set(smallestThree(view, at + 6), KeyNumber.PELVIS);
    row[KeyNumber.SWING_PITCH] = view.getInt16(at + 18, true) * FOOT_RAD;
    row[KeyNumber.STANDING_PITCH] = view.getInt16(at + 20, true) * FOOT_RAD;
    row[KeyNumber.SWING_HEADING] = view.getInt16(at + 22, true) * FOOT_RAD;
    row.set(nearIdentity(view, at + 24), KeyNumber.CHEST);
    for (let i = 0; i < 4; i++) row[KeyNumber.ARMS + i] = view.getInt8(at + 27 + i) * ARM_RAD;
  }
  return numbers;
}

/** The largest of the four is left out; the top bits of the first two words say which it was. */
function smallestThree(view: DataView, at: number): number[] {
  const words = [0, 2, 4].map((offset) => view.getUint16(at + offset, true));
  const others = words.map((word) => ((word & 0x7fff) - 0x4000) * SMALLEST_THREE);
  const place = ((words[0] ?? 0) >> 15) | (((words[1] ?? 0) >> 15) << 1);
  return unit([...others.slice(0, place), missing(others), ...others.slice(place)]);
}

function nearIdentity(view: DataView, at: number): number[] {
  const others = [0, 1, 2].map((offset) => view.getInt8(at + offset) * NEAR_IDENTITY);
  return unit([missing(others), ...others]);
}

/** The component that makes the length 1, not negative. */
function missing(others: number[]): number {
  return Math.sqrt(Math.max(0, 1 - others.reduce((sum, value) => sum + value * value, 0)));
}

function unit(quaternion: number[]): number[] {
  const length = Math.hypot(...quaternion);
  return quaternion.map((value) => value / length);
}
