/**
 * The gait of those who are too far away for steps of their own: eight postures of a cycle, the same
 * for everybody, which `esplanade gait cycle` makes.
 */

import cycle from "./cycle.json";
import { mixPostures, type Posture, posture } from "./posture";

type Numbers = readonly number[];

interface FootData {
  readonly heel: Numbers;
  readonly pitch: number;
  readonly raised: number;
}

/** A posture of a body that faces +x over the origin; leg lengths. */
interface PostureData {
  readonly root: Numbers;
  readonly pelvis: Numbers;
  readonly chest: Numbers;
  readonly left: FootData;
  readonly right: FootData;
  readonly leftArm: Posture["leftArm"];
  readonly rightArm: Posture["rightArm"];
}

interface Key {
  readonly phase: number;
  readonly posture: Posture;
}

const STAND = read(cycle.stand);
const KEYS: readonly Key[] = cycle.keys.map((key) => ({ phase: key.phase, posture: read(key) }));
/** Steps are drawn at most this much longer than those of the cycle: legs would not reach. */
const LONGEST = 1.18;

/** The length of a step at a speed, in leg lengths and leg lengths a second. */
export function stepAt(speed: number): number {
  return Math.min(Math.sqrt(cycle.timing * speed), cycle.step * LONGEST);
}

/** The posture at a phase, a fraction of a cycle, for steps of this length. */
export function cyclePosture(phase: number, step: number, out: Posture): void {
  const share = Math.min(1, step / cycle.step);
  let before = KEYS.length - 1;
  while (before > 0 && (KEYS[before]?.phase ?? 0) > phase) before--;
  const a = KEYS[before];
  const b = KEYS[(before + 1) % KEYS.length];
  if (!a || !b) return;
  const length = b.phase > a.phase ? b.phase - a.phase : b.phase + 1 - a.phase;
  mixPostures(a.posture, b.posture, (phase - a.phase) / length, out);
  mixPostures(STAND, out, share, out);
}

function read(data: PostureData): Posture {
  const read = posture();
  read.root.set(at(data.root, 0), at(data.root, 1), at(data.root, 2));
  for (const part of ["pelvis", "chest"] as const) {
    const q = data[part];
    read[part].set(at(q, 1), at(q, 2), at(q, 3), at(q, 0));
  }
  for (const side of ["left", "right"] as const) {
    const { heel, pitch, raised } = data[side];
    read[side].heel.set(at(heel, 0), at(heel, 1), at(heel, 2));
    Object.assign(read[side], { pitch, raised });
  }
  Object.assign(read.leftArm, data.leftArm);
  Object.assign(read.rightArm, data.rightArm);
  return read;
}

function at(numbers: Numbers, index: number): number {
  const value = numbers[index];
  if (value === undefined) throw new RangeError("the cycle's numbers are incomplete");
  return value;
}
