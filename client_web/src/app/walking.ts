/** The person's will: keys, stick and clicks become messages to the server and predictions here. */

import type { Arguments, ClientMessage } from "../net/messages";
import { Joystick } from "../input/joystick";
import { listenToKeys, WalkKeys } from "../input/keyboard";
import { headingOf, Steering } from "../input/steering";
import type { Place } from "../render/picking";
import { byId } from "../ui/dom";
import { SAME_FLOOR_M } from "../world/heights";
import type { World } from "../world/world";

/** A walk to a point ends this near to it. */
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
  private target: Place | null = null;
  /** Whether the server walks the avatar out, and listens to nothing else. */
  private led = false;

  /** `steered` is called when the person walks by keys or stick. */
  constructor(
    private readonly send: (message: ClientMessage) => boolean,
    private readonly showTarget: (at: Place | null) => void,
    private readonly steered: () => void,
  ) {
    listenToKeys(this.keys, window);
    this.steering = new Steering(({ direction, speed }) => {
      if (speed > 0) this.steered();
      const seq = ++this.seq;
      this.setTarget(null);
      if (!this.send({ type: "move", seq, direction, speed })) return;
      this.world?.command({ kind: "move", seq, direction, speed });
    });
  }

  enter(world: World): void {
    this.world = world;
    this.led = false;
    this.steering.reset();
    this.setTarget(null);
  }

  /** The server walks the avatar to a place from now on, as if the person had wished it. */
  leadTo(place: Place): void {
    this.led = true;
    this.world?.command({ kind: "walk_to", seq: ++this.seq, ...place });
    this.setTarget(place);
  }

  /** Sequence numbers go on after those that the server has from an earlier page. */
  acknowledged(ack: number): void {
    this.seq = Math.max(this.seq, ack);
  }

  walkTo(place: Place): void {
    if (!this.world?.own || this.led) return;
    const seq = ++this.seq;
    if (!this.send({ type: "walk_to", seq, ...place })) return;
    this.steering.reset();
    this.world.command({ kind: "walk_to", seq, ...place });
    this.setTarget(place);
  }

  /** Stand still wherever the avatar is now. */
  stand(): void {
    if (!this.world || this.led) return;
    const seq = ++this.seq;
    this.setTarget(null);
    if (!this.send({ type: "move", seq, direction: 0, speed: 0 })) return;
    this.steering.reset();
    this.world.command({ kind: "move", seq, direction: 0, speed: 0 });
  }

  /** The server knows no way to where the walk was to lead. */
  callOff(): void {
    this.setTarget(null);
  }

  /** Nobody can stand where the newest walk was to lead: it leads to another place. */
  goalMoved({ seq, x, y, z }: Arguments): void {
    if (this.target === null || seq !== this.seq) return;
    if (typeof x !== "number" || typeof y !== "number" || typeof z !== "number") return;
    this.setTarget({ x, y, z });
  }

  /** The speed at which the keys turn the camera, radians a second. */
  get turnPerS(): number {
    return this.keys.wish.turn * TURN_PER_S;
  }

  frame(cameraYaw: number): void {
    const own = this.world?.own;
    if (!own || !this.world || this.led) return;
    const wish = headingOf(this.keys.wish, this.stick.value, cameraYaw, this.world.gait);
    this.steering.update(wish, performance.now());
    const { target } = this;
    if (target && isThere(own.pose, target)) this.setTarget(null);
  }

  private setTarget(at: Place | null): void {
    if (at === null && this.target === null) return;
    this.target = at;
    this.showTarget(at);
  }
}

function isThere(here: Place, target: Place): boolean {
  const apartM = Math.hypot(here.x - target.x, here.y - target.y);
  return apartM < THERE_M && Math.abs(here.z - target.z) < SAME_FLOOR_M;
}
