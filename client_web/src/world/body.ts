/** The joints of a body from its posture: the twin of `actors/locomotion/reference/posing.py`. */

import { Quaternion, Vector3 } from "three";
import type { ArmPosture, FootPosture, Posture } from "./posture";
import { headingOf, nlerp, transformPoint, UP } from "./rotations";
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

/** Two bones with a hinge between them. */
export interface Limb {
  /** Hip or shoulder. */
  start: Vector3;
  /** Knee or elbow. */
  hinge: Vector3;
  /** Ankle or wrist. */
  end: Vector3;
  /** The hinge's axis, to the left of the limb. */
  axis: Vector3;
}

export interface Foot {
  /** The heel, where the ankle's joint is too. */
  heel: Vector3;
  /** The ball, on which it turns when the heel is raised. */
  toe: Vector3;
  pitch: number;
  heading: number;
  /** The angle by which the toes bend up against the foot, radians. */
  bend: number;
}

export interface Side {
  readonly leg: Limb;
  readonly foot: Foot;
  readonly arm: Limb;
}

export interface Body {
  root: Vector3;
  pelvis: Quaternion;
  /** The joint of the spine. */
  lumbar: Vector3;
  chest: Quaternion;
  neck: Vector3;
  /** It is more upright than the chest, and turned to the target of the gaze. */
  head: Quaternion;
  readonly left: Side;
  readonly right: Side;
}

/** A heel is raised no further on its toe. */
const STEEPEST_RAD = -1.3;
const STRAIGHT_M = 1e-9;
/** The neck takes back this share of the trunk's lean. */
const HEAD_UPRIGHT = 0.75;

const upright = new Quaternion();

export function body(): Body {
  const limb = (): Limb => ({
    start: new Vector3(),
    hinge: new Vector3(),
    end: new Vector3(),
    axis: new Vector3(),
  });
  const foot = (): Foot => ({
    heel: new Vector3(),
    toe: new Vector3(),
    pitch: 0,
    heading: 0,
    bend: 0,
  });
  const side = (): Side => ({ leg: limb(), foot: foot(), arm: limb() });
  return {
    root: new Vector3(),
    pelvis: new Quaternion(),
    lumbar: new Vector3(),
    chest: new Quaternion(),
    neck: new Vector3(),
    head: new Quaternion(),
    left: side(),
    right: side(),
  };
}

/** From the toe to the ankle of a foot with this pitch and heading. */
export function heelFromToe(pitch: number, heading: number, footM: number, out: Vector3): void {
  const level = footM * Math.cos(pitch);
  out.set(-level * Math.cos(heading), -level * Math.sin(heading), -footM * Math.sin(pitch));
}

/** Solve all joints of `out`; a leg that is too short raises the heel, and lowers the hips if it must. */
export function solve(from: Posture, build: Build, out: Body): void {
  out.root.copy(from.root);
  out.pelvis.copy(from.pelvis);
  out.chest.multiplyQuaternions(from.pelvis, from.chest);
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
  transformPoint(out.root, out.pelvis, 0, 0, LUMBAR_UP * build.trunkM, out.lumbar);
  hangOnChest(from, build, out);
}

/** Place neck, head and arms on the chest. */
export function hangOnChest(from: Posture, build: Build, out: Body): void {
  const { lumbar, chest, neck, head } = out;
  transformPoint(lumbar, chest, 0, 0, SHOULDER_UP * build.trunkM, neck);
  upright.setFromAxisAngle(UP, headingOf(chest));
  nlerp(chest, upright, HEAD_UPRIGHT, head);
  hangArm(from.leftArm, 1, out, out.left.arm, build);
  hangArm(from.rightArm, -1, out, out.right.arm, build);
}

/** The top of the head. */
export function crown({ neck, head }: Body, { trunkM }: Build, out: Vector3): void {
  transformPoint(neck, head, 0, 0, (HEAD_UP - SHOULDER_UP) * trunkM, out);
}

function place(from: FootPosture, foot: Foot): void {
  foot.heel.copy(from.heel);
  foot.pitch = from.pitch;
  foot.heading = from.heading;
}

function hips({ root, pelvis, left, right }: Body, { legM }: Build): void {
  transformPoint(root, pelvis, 0, HIP_ASIDE * legM, 0, left.leg.start);
  transformPoint(root, pelvis, 0, -HIP_ASIDE * legM, 0, right.leg.start);
}

const heelOffset = new Vector3();
/** The hip joint, seen from the toe. */
const hip = new Vector3();

/** Turn a foot on its toe about the toe if the leg is too short for it. */
function raiseHeel({ raised }: FootPosture, { leg, foot }: Side, { legM }: Build): void {
  const { heel, toe, heading } = foot;
  const footM = FOOT * legM;
  heelFromToe(foot.pitch, heading, footM, heelOffset);
  toe.subVectors(heel, heelOffset);
  const reachM = REACH * legM;
  if (raised > 0 && heel.distanceTo(leg.start) > reachM) {
    hip.subVectors(leg.start, toe);
    const along = hip.x * Math.cos(heading) + hip.y * Math.sin(heading);
    // The heel is at -foot (cos p, sin p) from the toe: as far from the hip as the leg reaches.
    const cosine =
      (reachM ** 2 - hip.lengthSq() - footM ** 2) / (2 * footM * Math.hypot(along, hip.z));
    const steeper = Math.atan2(hip.z, along) - Math.acos(Math.max(-1, Math.min(1, cosine)));
    foot.pitch += raised * (Math.min(Math.max(steeper, STEEPEST_RAD), foot.pitch) - foot.pitch);
    heelFromToe(foot.pitch, heading, footM, heelOffset);
    heel.addVectors(toe, heelOffset);
  }
  foot.bend = raised * Math.max(0, -foot.pitch);
  leg.end.copy(heel);
}

/** The hip has to come down this far for the leg to reach its foot. */
function dropFor({ leg: { start, end } }: Side, { legM }: Build): number {
  const x = start.x - end.x;
  const y = start.y - end.y;
  const z = start.z - end.z;
  const reach2 = (REACH * legM) ** 2;
  return Math.max(0, z - Math.sqrt(reach2 - Math.min(x * x + y * y, reach2)));
}

const down = new Vector3();
const ahead = new Vector3();

/** The knee by the cosine law, bent midway between where the pelvis and the foot point. */
function bendKnee({ leg, foot: { heading } }: Side, facing: number, { legM }: Build): void {
  const { start, hinge, end, axis } = leg;
  const distance = Math.max(start.distanceTo(end), STRAIGHT_M * legM);
  down.subVectors(end, start).divideScalar(distance);
  const reached = Math.min(distance, REACH * legM);
  const along = (reached ** 2 + (THIGH ** 2 - SHIN ** 2) * legM ** 2) / (2 * reached);
  const aside = Math.sqrt(Math.max(0, (THIGH * legM) ** 2 - along ** 2));
  ahead.set(Math.cos(facing) + Math.cos(heading), Math.sin(facing) + Math.sin(heading), 0);
  ahead.addScaledVector(down, -ahead.dot(down)).normalize();
  hinge.copy(start).addScaledVector(down, along).addScaledVector(ahead, aside);
  // Forwards times down the leg is to the left.
  axis.crossVectors(ahead, down);
}

const SIDEWAYS = Math.sin(ARMS_OUT);
const DOWNWARDS = -Math.cos(ARMS_OUT);

/** An arm that hangs a little outwards and is flexed so; `side` is 1 for the left one. */
function hangArm(
  { shoulder, elbow }: ArmPosture,
  side: number,
  { lumbar, chest }: Body,
  { start, hinge, end, axis }: Limb,
  { trunkM }: Build,
): void {
  transformPoint(lumbar, chest, 0, side * SHOULDER_ASIDE * trunkM, SHOULDER_UP * trunkM, start);
  const upperM = UPPER_ARM * trunkM;
  let lower = Math.cos(shoulder) * upperM;
  transformPoint(
    start,
    chest,
    Math.sin(shoulder) * upperM,
    side * SIDEWAYS * lower,
    DOWNWARDS * lower,
    hinge,
  );
  const foreM = FOREARM * trunkM;
  const flexed = shoulder + elbow;
  lower = Math.cos(flexed) * foreM;
  transformPoint(
    hinge,
    chest,
    Math.sin(flexed) * foreM,
    side * SIDEWAYS * lower,
    DOWNWARDS * lower,
    end,
  );
  // Forwards and the arm hanging down span the plane that it bends in.
  axis.set(0, Math.cos(ARMS_OUT), side * SIDEWAYS).applyQuaternion(chest);
}
