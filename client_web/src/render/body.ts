/** The parts a figure is put together from; limbs hang down from their joint at the origin. */

import {
  BoxGeometry,
  BufferGeometry,
  CapsuleGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  SphereGeometry,
} from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import { ANKLE_M, SHIN_M, THIGH_M } from "./gait";
import { painted } from "./shapes";

export const UPPER_ARM_M = 0.29;
export const FOREARM_M = 0.27;
export const TORSO_M = 0.52;
export const NECK_M = 0.1;

const WHITE = new Color("#ffffff");
const EYES = new Color("#20242a");

/** +x is forwards, +y to the left, +z up. */
export const PARTS = {
  torso: () => torso(),
  pelvis: () => upright(0.115, 0.1).scale(1, 1.35, 1),
  head: () => head(),
  hair: () => hair(),
  cap: () => cap(),
  upperArm: () => limb(0.05, UPPER_ARM_M),
  forearm: () => limb(0.042, FOREARM_M + 0.1),
  thigh: () => limb(0.075, THIGH_M),
  shin: () => limb(0.055, SHIN_M),
  shoe: () => painted(new BoxGeometry(0.25, 0.1, ANKLE_M).translate(0.06, 0, -ANKLE_M / 2), WHITE),
} satisfies Record<string, () => BufferGeometry>;

export type PartName = keyof typeof PARTS;

function limb(radiusM: number, lengthM: number): BufferGeometry {
  return painted(
    new CapsuleGeometry(radiusM, lengthM - radiusM, 2, 7)
      .rotateX(Math.PI / 2)
      .translate(0, 0, -lengthM / 2),
    WHITE,
  );
}

function upright(radiusM: number, lengthM: number): BufferGeometry {
  return painted(new CapsuleGeometry(radiusM, lengthM, 2, 9).rotateX(Math.PI / 2), WHITE);
}

/** From the hips up: wider at the shoulders than at the waist. */
function torso(): BufferGeometry {
  const chest = new CylinderGeometry(0.15, 0.115, TORSO_M, 9, 1).rotateX(Math.PI / 2);
  const shoulders = new SphereGeometry(0.15, 9, 5, 0, 2 * Math.PI, 0, Math.PI / 2)
    .rotateX(Math.PI / 2)
    .scale(1, 1, 0.5);
  chest.translate(0, 0, TORSO_M / 2);
  shoulders.translate(0, 0, TORSO_M);
  return painted(mergeGeometries([chest, shoulders]).scale(0.85, 1.35, 1), WHITE);
}

/** With neck, nose and eyes, so that one sees which way it looks. Origin at the neck's foot. */
function head(): BufferGeometry {
  const neck = new CylinderGeometry(0.05, 0.055, 0.14, 7)
    .rotateX(Math.PI / 2)
    .translate(0, 0, 0.04);
  const skull = new SphereGeometry(0.115, 10, 8).scale(1, 0.88, 1.12).translate(0.01, 0, 0.2);
  const nose = new ConeGeometry(0.022, 0.06, 5).rotateZ(-Math.PI / 2).translate(0.135, 0, 0.19);
  const eyes = [-1, 1].map((side) =>
    painted(new SphereGeometry(0.016, 5, 4).translate(0.112, side * 0.042, 0.225), EYES),
  );
  return mergeGeometries([
    painted(neck, WHITE),
    painted(skull, WHITE),
    painted(nose, WHITE),
    ...eyes,
  ]);
}

function hair(): BufferGeometry {
  return painted(
    new SphereGeometry(0.127, 10, 6, 0, 2 * Math.PI, 0, 0.58 * Math.PI)
      .rotateX(Math.PI / 2)
      .scale(1, 0.9, 1.08)
      .rotateY(-0.45)
      .translate(-0.005, 0, 0.215),
    WHITE,
  );
}

/** What an actor wears on its head. */
function cap(): BufferGeometry {
  const crown = new CylinderGeometry(0.105, 0.135, 0.1, 10).rotateX(Math.PI / 2);
  const peak = new CylinderGeometry(0.11, 0.11, 0.018, 10)
    .rotateX(Math.PI / 2)
    .translate(0.09, 0, -0.045);
  return painted(mergeGeometries([crown, peak]).scale(1, 0.92, 1).translate(0, 0, 0.3), WHITE);
}
