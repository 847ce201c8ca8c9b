/** The arguments of sentences that are neither names nor numbers. */

/** One of eight directions from somebody who looks straight ahead. */
export type Side =
  "ahead" | "aheadLeft" | "left" | "behindLeft" | "behind" | "behindRight" | "right" | "aheadRight";

/** Where somebody is, seen from the own avatar. */
export interface Whereabouts {
  /** Whole metres. */
  distanceM: number;
  side: Side;
  /** Whether they are on a floor further up or down. */
  floor: "same" | "above" | "below";
  /** Whether they are away from the screen. */
  away: boolean;
  /** Whether they come nearer by their own walking, or go away. */
  approach: "nearer" | "further" | null;
}

/** Whoever or whatever holds an actor. */
export type Blocker =
  | { kind: "named"; name: string }
  | { kind: "door"; name: string }
  | { kind: "unseen" | "somebody" | "unnamedDoor" | "wall" | "route" | "something" };

/** How far the path of an actor reaches; a path that leads to the goal ends there. */
export type Outlook = { path: "toGoal" | "part"; seconds: number } | { path: "none" | "over" };

/** The reason for which a walk leads to another place than was wished for. */
export type MoveReason = "inside_wall" | "near_wall" | "no_ground" | "other_region";
