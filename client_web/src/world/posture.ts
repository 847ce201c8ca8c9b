/**
 * A body before its joints are solved: the places of its trunk and feet. Steps and the cycle of far
 * figures give postures, and postures are blended when one takes over from the other.
 */

import { Quaternion, Vector3 } from "three";
import { mixAngles } from "./angles";
import { nlerp } from "./rotations";

export interface FootPosture {
  /** The back of the sole, below the ankle. */
  heel: Vector3;
  /** Radians, toe up is positive. */
  pitch: number;
  /** The direction of the toes on the ground. */
  heading: number;
  /** The degree to which it stands on its toe, 0 to 1: the heel may be raised if the leg is short. */
  raised: number;
}

/** Radians; positive is forwards. */
export interface ArmPosture {
  shoulder: number;
  elbow: number;
}

export interface Posture {
  /** The middle between the hip joints. */
  root: Vector3;
  pelvis: Quaternion;
  /** Relative to the pelvis. */
  chest: Quaternion;
  left: FootPosture;
  right: FootPosture;
  leftArm: ArmPosture;
  rightArm: ArmPosture;
}

export function posture(): Posture {
  const foot = (): FootPosture => ({ heel: new Vector3(), pitch: 0, heading: 0, raised: 0 });
  return {
    root: new Vector3(),
    pelvis: new Quaternion(),
    chest: new Quaternion(),
    left: foot(),
    right: foot(),
    leftArm: { shoulder: 0, elbow: 0 },
    rightArm: { shoulder: 0, elbow: 0 },
  };
}

/** On the way from one posture to another; `out` may be one of them. */
export function mixPostures(from: Posture, to: Posture, part: number, out: Posture): void {
  out.root.lerpVectors(from.root, to.root, part);
  nlerp(from.pelvis, to.pelvis, part, out.pelvis);
  nlerp(from.chest, to.chest, part, out.chest);
  mixFeet(from.left, to.left, part, out.left);
  mixFeet(from.right, to.right, part, out.right);
  mixArms(from.leftArm, to.leftArm, part, out.leftArm);
  mixArms(from.rightArm, to.rightArm, part, out.rightArm);
}

function mixFeet(from: FootPosture, to: FootPosture, part: number, out: FootPosture): void {
  out.heel.lerpVectors(from.heel, to.heel, part);
  out.pitch = from.pitch + (to.pitch - from.pitch) * part;
  out.heading = mixAngles(from.heading, to.heading, part);
  out.raised = from.raised + (to.raised - from.raised) * part;
}

function mixArms(from: ArmPosture, to: ArmPosture, part: number, out: ArmPosture): void {
  out.shoulder = from.shoulder + (to.shoulder - from.shoulder) * part;
  out.elbow = from.elbow + (to.elbow - from.elbow) * part;
}
