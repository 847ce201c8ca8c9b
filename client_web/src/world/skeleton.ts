/** The lengths of a body, as the server poses it: `actors/locomotion/reference/posing.py`. */

/** Shares of the leg, hip joint to ankle. */
export const THIGH = 0.466;
export const SHIN = 0.534;
/** From the heel, where the ankle's joint is too, to the ball of the foot. */
export const FOOT = 0.2;
/** The hip joints are this far to the sides of their middle. */
export const HIP_ASIDE = 0.1;
/** Knees that lock straighten with a jerk: a leg is stretched no further. */
export const REACH = 0.9995;

/** Shares of the trunk's scale. The spine bends this far above the middle of the hips. */
export const LUMBAR_UP = 0.178;
/** The chest bends on the spine this far above there. */
export const CHEST_UP = 0.2;
/** Shoulders and foot of the neck above there, and the crown of the head. */
export const SHOULDER_UP = 0.35;
export const HEAD_UP = 0.674;
export const SHOULDER_ASIDE = 0.215;
export const UPPER_ARM = 0.345;
export const FOREARM = 0.27;
/** Hanging arms are spread by this angle, radians. */
export const ARMS_OUT = 0.12;
/** The stature of a body whose trunk fits its legs, in lengths of its leg. */
const STATURE = 1 + LUMBAR_UP + HEAD_UP;

/** The sizes of one body, metres. */
export interface Build {
  readonly legM: number;
  readonly trunkM: number;
}

export function buildOf(legM: number, statureM: number): Build {
  return { legM, trunkM: (statureM - legM) / (STATURE - 1) };
}

export function statureOf({ legM, trunkM }: Build): number {
  return legM + trunkM * (STATURE - 1);
}
