/** From wishes to `move` messages: relative to the camera, only on change, with a slow repeat. */

import type { Gait } from "../world/prediction";
import type { Wish } from "./keyboard";

export interface Heading {
  /** Radians from +x. */
  direction: number;
  /** Metres a second; 0 stands still. */
  speed: number;
}

/** At most 15 messages a second. */
const SHORTEST_MS = 1000 / 15;
const REPEAT_MS = 1000;
const SAME_ANGLE = 0.02;
const SAME_SPEED_MPS = 0.03;
/** The stick's middle, where it rests. */
const DEAD = 0.18;

/** The direction of the keys or the stick while the camera looks along `cameraYaw`. */
export function headingOf(
  keys: Wish,
  stick: { x: number; y: number } | null,
  cameraYaw: number,
  { maxSpeedMps, walkSpeedMps }: Gait,
): Heading {
  const byStick = stick !== null && Math.hypot(stick.x, stick.y) > DEAD;
  const right = byStick ? stick.x : keys.right;
  const forward = byStick ? stick.y : keys.forward;
  if (right === 0 && forward === 0) return { direction: 0, speed: 0 };
  const direction = cameraYaw + Math.atan2(-right, forward);
  const effort = byStick ? Math.min(1, Math.hypot(stick.x, stick.y)) : 1;
  const hurries = keys.hurry || (byStick && effort > 0.95);
  const speed = hurries ? maxSpeedMps : walkSpeedMps * effort;
  return { direction: Math.atan2(Math.sin(direction), Math.cos(direction)), speed };
}

export class Steering {
  private sent: Heading = { direction: 0, speed: 0 };
  private sentMs = -Infinity;

  constructor(private readonly send: (heading: Heading) => void) {}

  /** The last message no longer holds: the avatar walks to a point, or is a new one. */
  reset(): void {
    this.sent = { direction: 0, speed: 0 };
  }

  update(wish: Heading, nowMs: number): void {
    const age = nowMs - this.sentMs;
    const stops = wish.speed === 0 && this.sent.speed > 0;
    const differs = stops || !same(wish, this.sent);
    const due = differs ? stops || age >= SHORTEST_MS : wish.speed > 0 && age >= REPEAT_MS;
    if (!due) return;
    this.sent = wish;
    this.sentMs = nowMs;
    this.send(wish);
  }
}

function same(a: Heading, b: Heading): boolean {
  if (a.speed === 0 && b.speed === 0) return true;
  const turn = a.direction - b.direction;
  const angle = Math.abs(Math.atan2(Math.sin(turn), Math.cos(turn)));
  return Math.abs(a.speed - b.speed) < SAME_SPEED_MPS && angle < SAME_ANGLE;
}
