/** Differences of height that decide who meets whom: the same as `planning/scene/heights.py`. */

/** Bodies whose feet are further apart in height cannot touch: this is the height of an adult. */
export const BODIES_OVERLAP_M = 1.8;
/** Places whose heights differ by less are on one floor. */
export const SAME_FLOOR_M = 1.5;
/** Floors nearer to each other belong to one storey: nobody stands upright between them. */
export const STOREYS_APART_M = BODIES_OVERLAP_M;
