/**
 * How the limbs of a walking figure stand, from the distance it has walked.
 *
 * The phase follows the distance, and a standing foot moves backwards under the body exactly as
 * fast as the body moves forwards; so feet stay where they are put. Figures are in metres for a body
 * of 1.75 m; angles in radians in the plane of walking, positive swings a limb forwards.
 */

export const THIGH_M = 0.44;
export const SHIN_M = 0.43;
export const ANKLE_M = 0.08;
const HIP_M = 0.945;
/** Part of a cycle during which a foot stands. */
const STANDING = 0.6;
/** Below this speed the stride shrinks to nothing. */
const FULL_STRIDE_MPS = 0.4;

export interface Leg {
  hip: number;
  /** Bend of the knee, backwards. */
  knee: number;
  foot: number;
}

export interface Arm {
  shoulder: number;
  elbow: number;
}

export interface Stance {
  hipHeightM: number;
  lean: number;
  left: { leg: Leg; arm: Arm };
  right: { leg: Leg; arm: Arm };
}

/** Metres that a full cycle of two steps covers. */
export function strideM(speedMps: number): number {
  return 0.55 + 0.6 * Math.min(speedMps, 2.6);
}

/** `phase` counts cycles: 0 is where the left heel comes down. */
export function stance(phase: number, speedMps: number): Stance {
  const effort = Math.min(1, speedMps / FULL_STRIDE_MPS);
  const hipHeightM = HIP_M - 0.022 * effort * (2 + Math.cos(4 * Math.PI * phase));
  const swing = 0.55 * Math.min(1, speedMps / 1.5);
  const elbow = 0.2 + 0.25 * Math.min(2, speedMps);
  const side = (turned: number): { leg: Leg; arm: Arm } => {
    const at = phase + turned - Math.floor(phase + turned);
    return {
      leg: leg(at, speedMps, effort, hipHeightM),
      arm: { shoulder: -swing * Math.cos(2 * Math.PI * at), elbow },
    };
  };
  return { hipHeightM, lean: 0.05 * speedMps, left: side(0), right: side(0.5) };
}

function leg(at: number, speedMps: number, effort: number, hipHeightM: number): Leg {
  const reach = (strideM(speedMps) * STANDING * effort) / 2;
  if (at < STANDING) {
    const part = at / STANDING;
    const heelUp = effort * 0.09 * Math.max(0, (part - 0.6) / 0.4) ** 2;
    return bend(reach * (1 - 2 * part), ANKLE_M + heelUp - hipHeightM, -4 * heelUp);
  }
  const part = (at - STANDING) / (1 - STANDING);
  const forward = part * part * (3 - 2 * part);
  const lift = effort * (0.09 * (1 - part) + 0.09 * Math.sin(Math.PI * part));
  const foot = effort * (0.36 * (part - 1) + 0.15 * Math.sin(Math.PI * part));
  return bend(reach * (2 * forward - 1), ANKLE_M + lift - hipHeightM, foot);
}

/** The leg whose ankle is at (x, z) from the hip; a point out of reach is approached straight. */
function bend(x: number, z: number, foot: number): Leg {
  const distance = Math.min(Math.hypot(x, z), THIGH_M + SHIN_M - 0.001);
  const toAnkle = Math.atan2(x, -z);
  const thigh = Math.acos((THIGH_M ** 2 + distance ** 2 - SHIN_M ** 2) / (2 * THIGH_M * distance));
  const knee =
    Math.PI - Math.acos((THIGH_M ** 2 + SHIN_M ** 2 - distance ** 2) / (2 * THIGH_M * SHIN_M));
  return { hip: toAnkle + thigh, knee, foot };
}
