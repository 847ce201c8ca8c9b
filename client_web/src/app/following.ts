/** Walks after another avatar, until the person wants something else. */

import type { Place } from "../render/picking";
import { SAME_FLOOR_M } from "../world/heights";
import type { World } from "../world/world";

/** So near to the other one, a follower stands. */
const NEAR_M = 1.5;
/** A follower sets out again once the other one is further away than this. */
const FAR_M = 2.2;
/** The walk leads to a new place when the other one has gone on so far. */
const MOVED_M = 0.7;
/** A new way is asked for no more often than this, since the server bounds them. */
const EVERY_MS = 700;

export class Following {
  /** The avatar that is followed; null for nobody. */
  id: number | null = null;
  private goal: Place | null = null;
  private askedMs = -Infinity;

  constructor(
    private readonly walkTo: (place: Place) => void,
    private readonly stand: () => void,
    private readonly changed: (id: number | null) => void,
  ) {}

  start(id: number): void {
    this.id = id;
    this.goal = null;
    this.askedMs = -Infinity;
    this.changed(id);
  }

  stop(): void {
    if (this.id === null) return;
    this.id = null;
    this.changed(null);
  }

  /** Walk on; it ends when the other one is out of view. */
  frame({ own, avatars }: World, nowMs: number): void {
    if (this.id === null || !own) return;
    const other = avatars.get(this.id);
    if (!other) {
      this.stop();
      return;
    }
    const { x, y, z } = other.pose;
    const apartM = Math.hypot(x - own.pose.x, y - own.pose.y);
    const here = Math.abs(z - own.pose.z) < SAME_FLOOR_M;
    if (here && apartM < NEAR_M) {
      if (this.goal) this.stand();
      this.goal = null;
    } else if ((!here || apartM > FAR_M || this.goal) && nowMs - this.askedMs > EVERY_MS) {
      const { goal } = this;
      if (goal && Math.hypot(x - goal.x, y - goal.y, z - goal.z) < MOVED_M) return;
      this.askedMs = nowMs;
      this.goal = { x, y, z };
      this.walkTo(this.goal);
    }
  }
}
