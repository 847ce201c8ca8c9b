/**
 * The posture of a body in the midst of a step: the twin of `actors/locomotion/motion/key_poses.py`.
 *
 * The standing foot follows from its footprint and its pitch alone, so it cannot slide at any frame
 * rate, until a runner's foot pushes off and comes along; all else goes along curves through the keys of the step.
 */

import { type Quaternion, Vector3 } from "three";
import { KEY_NUMBERS, KeyNumber, STEP_KEYS, type StepRecord } from "../net/steps";
import { heelFromToe } from "./body";
import type { FootPosture, Posture } from "./posture";
import { type Build, FOOT } from "./skeleton";

/** Share of a step in which a foot that has left the ground comes over to its curve. */
const SETTLE = 0.1;
/** A standing foot whose toe is down by this angle rises on its toe if the leg is too short. */
const EASE_RAD = 0.1;
/** Share of the way of the hips in flight that the toe behind comes along, and rises of that. */
const TOWED = 0.5;
const TOWED_UP = 0.45;
const LANDING = [
  KeyNumber.ANKLE,
  KeyNumber.ANKLE + 1,
  KeyNumber.ANKLE + 2,
  KeyNumber.SWING_PITCH,
  KeyNumber.SWING_HEADING,
];

const key = new Float64Array(KEY_NUMBERS);
const weights = new Float64Array(STEP_KEYS);
const offset = new Vector3();
const level = new Vector3();
const onToe = new Vector3();
const onCurve = new Vector3();

/** A step that is ready to be drawn: neighbouring quaternions have the same sign. */
export interface Step extends StepRecord {
  /** From the landing footprint to the swing foot's toe at the beginning. */
  readonly firstToe: Vector3;
}

export function readyToDraw(record: StepRecord, build: Build): Step {
  const keys = record.keys.slice();
  for (const at of [KeyNumber.PELVIS, KeyNumber.CHEST]) align(keys, at);
  const heading = number(keys, KeyNumber.SWING_HEADING) + record.landing.heading;
  heelFromToe(number(keys, KeyNumber.SWING_PITCH), heading, FOOT * build.legM, offset);
  return {
    ...record,
    keys,
    firstToe: new Vector3().fromArray(keys, KeyNumber.ANKLE).sub(offset),
  };
}

/** The posture at share `u` of a step. */
export function underWay(step: Step, u: number, build: Build, out: Posture): void {
  const { standing, landing, rightStands, lift } = step;
  const share = Math.max(0, Math.min(1, u));
  between(step.keys, share);
  const at = KeyNumber;
  out.root.fromArray(key, at.ROOT).add(standing);
  turn(key, at.PELVIS, out.pelvis);
  turn(key, at.CHEST, out.chest);
  out.leftArm.shoulder = number(key, at.ARMS);
  out.rightArm.shoulder = number(key, at.ARMS + 1);
  out.leftArm.elbow = number(key, at.ARMS + 2);
  out.rightArm.elbow = number(key, at.ARMS + 3);
  const stands = rightStands ? out.right : out.left;
  stand(step, build, stands);
  tow(step, share, stands);
  const swing = rightStands ? out.left : out.right;
  swing.pitch = number(key, at.SWING_PITCH);
  swing.heading = landing.heading + number(key, at.SWING_HEADING);
  swing.heel.fromArray(key, at.ANKLE).add(landing);
  swing.raised = lift > 0 ? 1 - smooth((share - lift) / SETTLE) : 0;
  if (swing.raised > 0) keepOnToe(step, share, build, swing);
  swing.raised *= smooth(-swing.pitch / EASE_RAD);
}

/** From 0 to 1 with level ends. */
export function smooth(share: number): number {
  const s = Math.max(0, Math.min(1, share));
  return s * s * (3 - 2 * s);
}

/** A foot stands on its heel while the toe is up, else on its toe. */
function stand({ standing }: Step, { legM }: Build, foot: FootPosture): void {
  const { heading } = standing;
  foot.pitch = number(key, KeyNumber.STANDING_PITCH);
  foot.heading = heading;
  foot.raised = smooth(-foot.pitch / EASE_RAD);
  heelFromToe(Math.min(foot.pitch, 0), heading, FOOT * legM, offset);
  heelFromToe(0, heading, FOOT * legM, level);
  foot.heel.addVectors(standing, offset).sub(level);
}

/** In a flight the foot behind comes along, its way growing with the square of the time. */
function tow({ keys, flight }: Step, share: number, foot: FootPosture): void {
  if (flight <= 0 || share <= 1 - flight) return;
  const last = (STEP_KEYS - 1) * KEY_NUMBERS;
  const x = number(keys, last) - number(keys, 0);
  const y = number(keys, last + 1) - number(keys, 1);
  const part = flight * ((share - 1 + flight) / flight) ** 2;
  foot.heel.x += TOWED * part * x;
  foot.heel.y += TOWED * part * y;
  foot.heel.z += TOWED_UP * part * Math.hypot(x, y);
}

/** Until it lifts the swing foot turns on its toe; then what is missing to its curve fades. */
function keepOnToe(step: Step, share: number, { legM }: Build, foot: FootPosture): void {
  const { keys, landing, lift } = step;
  between(keys, Math.min(share, lift));
  const heading = landing.heading + number(key, KeyNumber.SWING_HEADING);
  heelFromToe(number(key, KeyNumber.SWING_PITCH), heading, FOOT * legM, offset);
  onToe.addVectors(step.firstToe, offset);
  foot.heel.addScaledVector(onToe.sub(onCurve.fromArray(key, KeyNumber.ANKLE)), foot.raised);
}

/** Interpolate the keys at a share of the step, into `key`, all numbers with the same weights. */
function between(keys: Float64Array, share: number): void {
  weigh(share);
  key.fill(0);
  for (let k = 0; k < STEP_KEYS; k++) {
    const weight = number(weights, k);
    if (weight === 0) continue;
    const row = k * KEY_NUMBERS;
    for (let i = 0; i < KEY_NUMBERS; i++) key[i] = number(key, i) + weight * number(keys, row + i);
  }
  comeToRest(keys, share);
}

/** The swing foot lands: its numbers end level, not on the parabola that `weigh` ends with. */
function comeToRest(keys: Float64Array, share: number): void {
  const s = share * (STEP_KEYS - 1) - (STEP_KEYS - 2);
  if (s <= 0) return;
  const weight = s * s * (1 - s);
  const row = (STEP_KEYS - 3) * KEY_NUMBERS;
  for (const i of LANDING) {
    const slope =
      0.5 * number(keys, row + i) -
      2 * number(keys, row + KEY_NUMBERS + i) +
      1.5 * number(keys, row + 2 * KEY_NUMBERS + i);
    key[i] = number(key, i) + weight * slope;
  }
}

/** The weight of each key: cubic Hermite curves, parabolas at the ends. */
function weigh(share: number): void {
  weights.fill(0);
  const place = share * (STEP_KEYS - 1);
  const k = Math.min(Math.floor(place), STEP_KEYS - 2);
  const s = place - k;
  const after = smooth(s);
  add(k, 1 - after);
  add(k + 1, after);
  addSlope(k, s * (1 - s) ** 2);
  addSlope(k + 1, -s * s * (1 - s));
}

/** The slope at a key, per interval. */
function addSlope(k: number, weight: number): void {
  const last = STEP_KEYS - 1;
  if (k === 0 || k === last) {
    const inwards = k === 0 ? 1 : -1;
    add(k, -1.5 * inwards * weight);
    add(k + inwards, 2 * inwards * weight);
    add(k + 2 * inwards, -0.5 * inwards * weight);
  } else {
    add(k + 1, 0.5 * weight);
    add(k - 1, -0.5 * weight);
  }
}

function add(k: number, weight: number): void {
  weights[k] = number(weights, k) + weight;
}

/** Give each quaternion the sign that is nearest to the key before. */
function align(keys: Float64Array, at: number): void {
  for (let row = KEY_NUMBERS; row < keys.length; row += KEY_NUMBERS) {
    let dot = 0;
    for (let i = at; i < at + 4; i++) {
      dot += number(keys, row + i) * number(keys, row - KEY_NUMBERS + i);
    }
    if (dot >= 0) continue;
    for (let i = row + at; i < row + at + 4; i++) keys[i] = -number(keys, i);
  }
}

/** The quaternion w, x, y, z that stands there. */
function turn(from: Float64Array, at: number, out: Quaternion): void {
  out
    .set(number(from, at + 1), number(from, at + 2), number(from, at + 3), number(from, at))
    .normalize();
}

/** An element that is known to be there. */
function number(from: Float64Array, at: number): number {
  return from[at] ?? 0;
}
