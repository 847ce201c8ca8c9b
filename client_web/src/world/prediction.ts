/**
 * The own avatar, ahead of the server: it answers at once and is corrected gently.
 *
 * Every command has a sequence number, and every snapshot says which was the last one applied
 * (`ack`). The server's position is then played forward by the commands that it has not played yet:
 * the rest of the acknowledged one and all later ones, each for as long as it has lasted here. If
 * that differs from the shown position, the difference fades away instead of jumping.
 */

import type { Pose } from "./interpolation";
import type { Vec2 } from "./barriers";
import type { Obstacles, Vec3 } from "./obstacles";

export type Command =
  | { kind: "move"; seq: number; direction: number; speed: number }
  | { kind: "walk_to"; seq: number; x: number; y: number; z: number };

interface Pending {
  command: Command;
  playedS: number;
}

interface Body {
  x: number;
  y: number;
  z: number;
  heading: number;
  speed: number;
}

const STAND: Command = { kind: "move", seq: 0, direction: 0, speed: 0 };
const STEP_S = 1 / 30;
const FADE_S = 0.25;
/** A larger difference is no matter of timing: the avatar was put somewhere else. */
const JUMP_M = 2.5;
/** Never play further ahead of the server than this. */
const AHEAD_S = 1;
const ARRIVED_M = 0.05;
const TURN_PER_S = 12;
/** A walk to a point has ended when the server's avatar stands this long after it began. */
const SETTLED_S = 0.4;
const MOST_PENDING = 64;

/** The limits of walking that the server states in its welcome. */
export interface Gait {
  /** Distance that the body's centre keeps from walls. */
  clearanceM: number;
  maxSpeedMps: number;
  /** Speed of a walk to a point, and of a walk in no hurry. */
  walkSpeedMps: number;
}

export class Prediction {
  private pending: Pending[] = [{ command: STAND, playedS: 0 }];
  private body: Body;
  private offset: Vec2 = [0, 0];
  private heading: number;
  private server: Pose;
  private ackTick = 0;

  constructor(
    start: Pose,
    public obstacles: Obstacles,
    private readonly gait: Gait,
    private readonly tickS: number,
  ) {
    this.server = start;
    this.body = { x: start.x, y: start.y, z: start.z, heading: start.heading, speed: 0 };
    this.heading = start.heading;
  }

  /** A command that was just sent to the server. */
  command(command: Command): void {
    this.pending.push({ command, playedS: 0 });
    if (this.pending.length > MOST_PENDING) this.pending.shift();
  }

  /** Correct the prediction by the own record of a snapshot. */
  reconcile(tick: number, ack: number, server: Pose): void {
    const acked = this.pending.findIndex(({ command }) => command.seq === ack);
    if (acked > 0) {
      this.pending.splice(0, acked);
      this.ackTick = tick;
    }
    this.server = server;
    const was = this.shownAt();
    const serverPlayedS = (tick - this.ackTick + 1) * this.tickS;
    const { x, y, z, heading, speed } = server;
    this.body = { x, y, z, heading, speed };
    this.endWalk(serverPlayedS);
    this.pending.forEach(({ command, playedS }, i) => {
      const leftS = i === 0 ? Math.max(0, playedS - serverPlayedS) : playedS;
      this.play(command, Math.min(leftS, AHEAD_S));
    });
    const off: Vec2 = [was[0] - this.body.x, was[1] - this.body.y];
    this.offset = Math.hypot(...off) > JUMP_M ? [0, 0] : off;
  }

  /** Advance by one frame of the world's time, which took `passedS` of ours. */
  advance(frameS: number, passedS = frameS): void {
    const current = this.pending.at(-1);
    if (!current) return;
    current.playedS += frameS;
    this.play(current.command, frameS);
    const left = Math.exp(-passedS / FADE_S);
    this.offset = [this.offset[0] * left, this.offset[1] * left];
    const turn = this.body.heading - this.heading;
    const shortWay = Math.atan2(Math.sin(turn), Math.cos(turn));
    this.heading += shortWay * Math.min(1, TURN_PER_S * passedS);
  }

  get shown(): Pose {
    const [x, y] = this.shownAt();
    const { z, speed } = this.body;
    const { layer, reason } = this.server;
    return { x, y, z, layer, heading: this.heading, speed, reason };
  }

  /** Distance between the shown and the predicted position, metres. */
  get correctionM(): number {
    return Math.hypot(...this.offset);
  }

  /** The server ends a walk where it holds it for done, which may be short of the point. */
  private endWalk(serverPlayedS: number): void {
    const [first] = this.pending;
    if (first?.command.kind !== "walk_to" || this.server.speed > 0) return;
    if (serverPlayedS > SETTLED_S) first.command = { ...STAND, seq: first.command.seq };
  }

  private shownAt(): Vec2 {
    return [this.body.x + this.offset[0], this.body.y + this.offset[1]];
  }

  private play(command: Command, durationS: number): void {
    const steps = Math.ceil(durationS / STEP_S);
    const stepS = durationS / steps;
    for (let i = 0; i < steps; i++) {
      const [vx, vy] = this.velocity(command, stepS);
      const from: Vec3 = [this.body.x, this.body.y, this.body.z];
      const to = this.obstacles.walk(from, vx * stepS, vy * stepS, this.gait.clearanceM);
      this.body.x = to[0];
      this.body.y = to[1];
      this.body.z = to[2];
      this.body.speed = Math.hypot(to[0] - from[0], to[1] - from[1]) / stepS;
      if (Math.hypot(vx, vy) > 0) this.body.heading = Math.atan2(vy, vx);
    }
  }

  private velocity(command: Command, stepS: number): Vec2 {
    if (command.kind === "move") {
      const speed = Math.min(command.speed, this.gait.maxSpeedMps);
      return [Math.cos(command.direction) * speed, Math.sin(command.direction) * speed];
    }
    const dx = command.x - this.body.x;
    const dy = command.y - this.body.y;
    const distance = Math.hypot(dx, dy);
    if (distance < ARRIVED_M) return [0, 0];
    const here: Vec3 = [this.body.x, this.body.y, this.body.z];
    if (this.obstacles.clear(here, [command.x, command.y, command.z], this.gait.clearanceM)) {
      const speed = Math.min(this.gait.walkSpeedMps, distance / stepS);
      return [(dx / distance) * speed, (dy / distance) * speed];
    }
    // The way around is the server's: go on as it goes.
    const { heading, speed } = this.server;
    return [Math.cos(heading) * speed, Math.sin(heading) * speed];
  }
}
