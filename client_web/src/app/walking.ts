/** The person's will: keys, stick and clicks become messages to the server and predictions here. */

import type { ClientMessage } from "../net/messages";
import { Joystick } from "../input/joystick";
import { listenToKeys, WalkKeys } from "../input/keyboard";
import { headingOf, Steering } from "../input/steering";
import { byId } from "../ui/dom";
import type { World } from "../world/world";

/** This near a walk to a point counts as done, metres. */
const THERE_M = 0.4;
const TURN_PER_S = 1.8;

export class Walking {
  private readonly keys = new WalkKeys();
  private readonly stick = new Joystick(
    byId("stick", HTMLElement),
    byId("stick-knob", HTMLElement),
  );
  private readonly steering: Steering;
  private world: World | null = null;
  private seq = 0;
  private target: { x: number; y: number } | null = null;

  constructor(
    private readonly send: (message: ClientMessage) => boolean,
    private readonly showTarget: (at: { x: number; y: number } | null) => void,
  ) {
    listenToKeys(this.keys, window);
    this.steering = new Steering(({ direction, speed }) => {
      const seq = ++this.seq;
      this.setTarget(null);
      if (!this.send({ type: "move", seq, direction, speed })) return;
      this.world?.command({ kind: "move", seq, direction, speed });
    });
  }

  enter(world: World): void {
    this.world = world;
    this.steering.reset();
    this.setTarget(null);
  }

  /** Sequence numbers go on after those that the server has from an earlier page. */
  acknowledged(ack: number): void {
    this.seq = Math.max(this.seq, ack);
  }

  walkTo({ x, y }: { x: number; y: number }): void {
    const own = this.world?.own;
    if (!own) return;
    const seq = ++this.seq;
    const { z } = own.pose;
    if (!this.send({ type: "walk_to", seq, x, y, z })) return;
    this.steering.reset();
    this.world?.command({ kind: "walk_to", seq, x, y, z });
    this.setTarget({ x, y });
  }

  /** The server knows no way to where the walk was to lead. */
  callOff(): void {
    this.setTarget(null);
  }

  /** How fast the keys turn the camera, radians a second. */
  get turnPerS(): number {
    return this.keys.wish.turn * TURN_PER_S;
  }

  frame(cameraYaw: number): void {
    const own = this.world?.own;
    if (!own || !this.world) return;
    const wish = headingOf(this.keys.wish, this.stick.value, cameraYaw, this.world.maxSpeedMps);
    this.steering.update(wish, performance.now());
    const { target } = this;
    if (target && Math.hypot(own.pose.x - target.x, own.pose.y - target.y) < THERE_M) {
      this.setTarget(null);
    }
  }

  private setTarget(at: { x: number; y: number } | null): void {
    if (at === null && this.target === null) return;
    this.target = at;
    this.showTarget(at);
  }
}
