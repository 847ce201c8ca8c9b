/** The joints of a body in the world, from its posture: the twin of `actors/locomotion/reference/posing.py`. */

import type { ArmPosture, FootPosture, Posture } from "./posture";
import {
  ARMS_OUT,
  type Build,
  FOOT,
  FOREARM,
  HEAD_UP,
  HIP_ASIDE,
  LUMBAR_UP,
  REACH,
  SHIN,
  SHOULDER_ASIDE,
  SHOULDER_UP,
  THIGH,
  UPPER_ARM,
} from "./skeleton";
import {
  apart,
  carried,
  copy,
  copyRotation,
  headed,
  headingOf,
  mixRotations,
  type Rotation,
  rotation,
  set,
  times,
  type Vector,
  vector,
} from "./vectors";

/** Two bones with a hinge between them. */
export interface Limb {
  /** Hip or shoulder. */
  start: Vector;
  /** Knee or elbow. */
  hinge: Vector;
  /** Ankle or wrist. */
  end: Vector;
  /** The hinge's axis, to the left of the limb. */
  axis: Vector;
}

export interface Foot {
  /** The heel, where the ankle's joint is too. */
  heel: Vector;
  /** The ball, on which it turns when the heel is raised. */
  toe: Vector;
  pitch: number;
  heading: number;
  /** How far the toes bend up against the foot, radians. */
  bend: number;
}

export interface Side {
  readonly leg: Limb;
  readonly foot: Foot;
  readonly arm: Limb;
}

export interface Body {
  root: Vector;
  pelvis: Rotation;
  /** Where the spine bends. */
  lumbar: Vector;
  chest: Rotation;
  neck: Vector;
  /** More upright than the chest, and turned to what is looked at. */
  head: Rotation;
  readonly left: Side;
  readonly right: Side;
}

/** A heel is raised no further on its toe. */
const STEEPEST_RAD = -1.3;
const STRAIGHT_M = 1e-9;
/** How much of the trunk's leaning the neck takes back. */
const HEAD_UPRIGHT = 0.75;

const upright = rotation();

export function body(): Body {
  const limb = (): Limb => ({ start: vector(), hinge: vector(), end: vector(), axis: vector() });
  const foot = (): Foot => ({ heel: vector(), toe: vector(), pitch: 0, heading: 0, bend: 0 });
  const side = (): Side => ({ leg: limb(), foot: foot(), arm: limb() });
  return {
    root: vector(),
    pelvis: rotation(),
    lumbar: vector(),
    chest: rotation(),
    neck: vector(),
    head: rotation(),
    left: side(),
    right: side(),
  };
}

/** Where the ankle is, seen from the toe, of a foot that is pitched and headed so. */
export function heelFromToe(pitch: number, heading: number, footM: number, out: Vector): void {
  const level = footM * Math.cos(pitch);
  set(out, -level * Math.cos(heading), -level * Math.sin(heading), -footM * Math.sin(pitch));
}

/** All joints of `out`; legs that are too short raise the heel, and what is left lowers the hips. */
export function solve(from: Posture, build: Build, out: Body): void {
  copy(from.root, out.root);
  copyRotation(from.pelvis, out.pelvis);
  times(from.pelvis, from.chest, out.chest);
  place(from.left, out.left.foot);
  place(from.right, out.right.foot);
  hips(out, build);
  raiseHeel(from.left, out.left, build);
  raiseHeel(from.right, out.right, build);
  const dropM = Math.max(dropFor(out.left, build), dropFor(out.right, build));
  out.root.z -= dropM;
  out.left.leg.start.z -= dropM;
  out.right.leg.start.z -= dropM;
  const facing = headingOf(from.pelvis);
  bendKnee(out.left, facing, build);
  bendKnee(out.right, facing, build);
  carried(out.root, out.pelvis, 0, 0, LUMBAR_UP * build.trunkM, out.lumbar);
  hangOnChest(from, build, out);
}

/** Neck, head and arms where the chest has them. */
export function hangOnChest(from: Posture, build: Build, out: Body): void {
  const { lumbar, chest, neck, head } = out;
  carried(lumbar, chest, 0, 0, SHOULDER_UP * build.trunkM, neck);
  headed(headingOf(chest), upright);
  mixRotations(chest, upright, HEAD_UPRIGHT, head);
  hangArm(from.leftArm, 1, out, out.left.arm, build);
  hangArm(from.rightArm, -1, out, out.right.arm, build);
}

/** The top of the head. */
export function crown({ neck, head }: Body, { trunkM }: Build, out: Vector): void {
  carried(neck, head, 0, 0, (HEAD_UP - SHOULDER_UP) * trunkM, out);
}

function place(from: FootPosture, foot: Foot): void {
  copy(from.heel, foot.heel);
  foot.pitch = from.pitch;
  foot.heading = from.heading;
}

function hips({ root, pelvis, left, right }: Body, { legM }: Build): void {
  carried(root, pelvis, 0, HIP_ASIDE * legM, 0, left.leg.start);
  carried(root, pelvis, 0, -HIP_ASIDE * legM, 0, right.leg.start);
}

const heelOffset = vector();

/** Where the leg is too short for a foot on its toe, turn the foot about the toe. */
function raiseHeel({ raised }: FootPosture, { leg, foot }: Side, { legM }: Build): void {
  const { heel, toe, heading } = foot;
  const footM = FOOT * legM;
  heelFromToe(foot.pitch, heading, footM, heelOffset);
  set(toe, heel.x - heelOffset.x, heel.y - heelOffset.y, heel.z - heelOffset.z);
  const reachM = REACH * legM;
  if (raised > 0 && apart(heel, leg.start) > reachM) {
    const x = leg.start.x - toe.x;
    const y = leg.start.y - toe.y;
    const z = leg.start.z - toe.z;
    const along = x * Math.cos(heading) + y * Math.sin(heading);
    // The heel is at -foot (cos p, sin p) from the toe: as far from the hip as the leg reaches.
    const cosine =
      (reachM ** 2 - x * x - y * y - z * z - footM ** 2) / (2 * footM * Math.hypot(along, z));
    const steeper = Math.atan2(z, along) - Math.acos(Math.max(-1, Math.min(1, cosine)));
    foot.pitch += raised * (Math.min(Math.max(steeper, STEEPEST_RAD), foot.pitch) - foot.pitch);
    heelFromToe(foot.pitch, heading, footM, heelOffset);
    set(heel, toe.x + heelOffset.x, toe.y + heelOffset.y, toe.z + heelOffset.z);
  }
  foot.bend = raised * Math.max(0, -foot.pitch);
  copy(heel, leg.end);
}

/** How far the hip has to come down for the leg to reach its foot. */
function dropFor({ leg: { start, end } }: Side, { legM }: Build): number {
  const x = start.x - end.x;
  const y = start.y - end.y;
  const z = start.z - end.z;
  const reach2 = (REACH * legM) ** 2;
  return Math.max(0, z - Math.sqrt(reach2 - Math.min(x * x + y * y, reach2)));
}

/** The knee by the cosine law, bent midway between where the pelvis and the foot point. */
function bendKnee({ leg, foot: { heading } }: Side, facing: number, { legM }: Build): void {
  const { start, hinge, end, axis } = leg;
  const distance = Math.max(apart(start, end), STRAIGHT_M * legM);
  const lx = (end.x - start.x) / distance;
  const ly = (end.y - start.y) / distance;
  const lz = (end.z - start.z) / distance;
  const reached = Math.min(distance, REACH * legM);
  const along = (reached ** 2 + (THIGH ** 2 - SHIN ** 2) * legM ** 2) / (2 * reached);
  const aside = Math.sqrt(Math.max(0, (THIGH * legM) ** 2 - along ** 2));
  let fx = Math.cos(facing) + Math.cos(heading);
  let fy = Math.sin(facing) + Math.sin(heading);
  const dot = fx * lx + fy * ly;
  let fz = -dot * lz;
  fx -= dot * lx;
  fy -= dot * ly;
  const length = Math.hypot(fx, fy, fz);
  fx /= length;
  fy /= length;
  fz /= length;
  set(
    hinge,
    start.x + along * lx + aside * fx,
    start.y + along * ly + aside * fy,
    start.z + along * lz + aside * fz,
  );
  // Up the leg times forwards is to the left.
  set(axis, fy * lz - fz * ly, fz * lx - fx * lz, fx * ly - fy * lx);
}

const SIDEWAYS = Math.sin(ARMS_OUT);
const DOWNWARDS = -Math.cos(ARMS_OUT);
const ORIGIN = vector();

/** An arm that hangs a little outwards and is flexed so; `side` is 1 for the left one. */
function hangArm(
  { shoulder, elbow }: ArmPosture,
  side: number,
  { lumbar, chest }: Body,
  { start, hinge, end, axis }: Limb,
  { trunkM }: Build,
): void {
  carried(lumbar, chest, 0, side * SHOULDER_ASIDE * trunkM, SHOULDER_UP * trunkM, start);
  const upperM = UPPER_ARM * trunkM;
  let down = Math.cos(shoulder) * upperM;
  carried(
    start,
    chest,
    Math.sin(shoulder) * upperM,
    side * SIDEWAYS * down,
    DOWNWARDS * down,
    hinge,
  );
  const foreM = FOREARM * trunkM;
  const flexed = shoulder + elbow;
  down = Math.cos(flexed) * foreM;
  carried(hinge, chest, Math.sin(flexed) * foreM, side * SIDEWAYS * down, DOWNWARDS * down, end);
  // Forwards and the arm hanging down span the plane that it bends in.
  carried(ORIGIN, chest, 0, Math.cos(ARMS_OUT), side * SIDEWAYS, axis);
}
