/**
 * The keys of a walking step as whole numbers: the twin of `protocol/keys_between.py`.
 *
 * A record has both ends, and the keys between as small differences from what the ends foretell.
 */

export const STEP_KEYS = 6;
export const WHOLE_NUMBERS = 17;

/** The place of each number in the row of a key. */
export const Whole = {
  ROOT: 0,
  ANKLE: 3,
  YAW: 6,
  SWING_PITCH: 7,
  STANDING_PITCH: 8,
  SWING_HEADING: 9,
  LEAN: 10,
  ROLL: 11,
  TWIST: 12,
  ARMS: 13,
} as const;

// Where the parts begin in a record.
const FIRST_AT = 36;
const LAST_AT = 55;
const ANKLE_AT = 74;
const HEADING_AT = 80;
const SHIFTS_AT = 82;
const BETWEEN_AT = 86;
const WORDS_AT = 126;

/** Numbers of a key whose differences have a byte each; they are the first. */
const BYTES = 10;
/** The group of each number, which has four bits of the shifts. */
const GROUPS = [0, 0, 0, 1, 1, 1, 2, 3, 4, 5, 6, 6, 6, 7, 7, 7, 7];
/** The share of its way, in 1/256, that a swing foot has before it at each key. */
const FAR = [256, 250, 229, 169, 41, 0];

/** The keys of the record that begins there, a row of `WHOLE_NUMBERS` each. */
export function wholeKeys(view: DataView, at: number, reAimed: boolean): Float64Array {
  const rows = new Float64Array(STEP_KEYS * WHOLE_NUMBERS);
  const lastRow = (STEP_KEYS - 1) * WHOLE_NUMBERS;
  readEnd(view, at + FIRST_AT, rows.subarray(0, WHOLE_NUMBERS));
  readEnd(view, at + LAST_AT, rows.subarray(lastRow));
  for (let i = 0; i < 3; i++) rows[Whole.ANKLE + i] = view.getInt16(at + ANKLE_AT + 2 * i, true);
  rows[Whole.SWING_HEADING] = view.getInt16(at + HEADING_AT, true);
  const shifts = view.getUint32(at + SHIFTS_AT, true);
  for (let column = 0; column < WHOLE_NUMBERS; column++) {
    const first = number(rows, column);
    const change = number(rows, lastRow + column) - first;
    const scale = 2 ** ((shifts >>> (4 * number(GROUPS, column))) & 15);
    for (let k = 1; k < STEP_KEYS - 1; k++) {
      const apart = difference(view, at, k - 1, column) * scale;
      rows[k * WHOLE_NUMBERS + column] = foretold(column, k, first, change, reAimed) + apart;
    }
  }
  return rows;
}

/** An element that is known to be there. */
export function number(from: ArrayLike<number>, at: number): number {
  return from[at] ?? 0;
}

/** The first key or the last one, but for the swing foot, which is on its footprint. */
function readEnd(view: DataView, at: number, row: Float64Array): void {
  for (let i = 0; i < 3; i++) row[Whole.ROOT + i] = view.getInt16(at + 2 * i, true);
  row[Whole.YAW] = view.getUint16(at + 6, true);
  row[Whole.SWING_PITCH] = view.getInt16(at + 8, true);
  row[Whole.STANDING_PITCH] = view.getInt16(at + 10, true);
  for (let i = 0; i < 7; i++) row[Whole.LEAN + i] = view.getInt8(at + 12 + i);
}

function difference(view: DataView, at: number, key: number, column: number): number {
  if (column < BYTES) return view.getInt8(at + BETWEEN_AT + BYTES * key + column);
  const word = view.getUint16(at + WORDS_AT + 2 * (column - BYTES), true);
  return (((word >> (4 * key)) & 15) ^ 8) - 8;
}

function foretold(
  column: number,
  key: number,
  first: number,
  change: number,
  reAimed: boolean,
): number {
  if (column === Whole.STANDING_PITCH) return 0;
  if (column >= Whole.ANKLE && column < Whole.YAW && !reAimed) {
    return Math.floor((first * number(FAR, key)) / 256);
  }
  const way = column === Whole.YAW ? withinHalfATurn(change) : change;
  return first + Math.floor((way * key) / (STEP_KEYS - 1));
}

function withinHalfATurn(yaw: number): number {
  return ((yaw + 0x8000) & 0xffff) - 0x8000;
}
