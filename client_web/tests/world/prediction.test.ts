import { describe, expect, it } from "vitest";
import type { Pose } from "../../src/world/interpolation";
import { Obstacles } from "../../src/world/obstacles";
import { adult, bare, gait, twoFloors, wall } from "../scenes";
import { type Command, Prediction } from "../../src/world/prediction";

const TICK_S = 0.05;
const FRAME_S = 1 / 60;
const FRAMES_PER_TICK = 3;
const open = new Obstacles(bare, adult);
const walled = new Obstacles({ ...bare, walls: [wall([52, 0], [52, 100])] }, adult);
const start: Pose = { x: 50, y: 50, z: 0, layer: 0, heading: 0, speed: 0, reason: 0 };
const move = (seq: number, speed: number, direction = 0): Command => ({
  kind: "move",
  seq,
  direction,
  speed,
});

/** A server that plays commands as ours does, `lagTicks` after they were given, both ways. */
class Rehearsal {
  readonly prediction: Prediction;
  server: Pose = { ...start };
  tick = 0;
  private ack = 0;
  private current: Command = move(0, 0);
  private readonly uplink: { due: number; command: Command }[] = [];
  private readonly downlink: { due: number; tick: number; ack: number; pose: Pose }[] = [];
  /** Largest move of the shown avatar in one frame. */
  largestStepM = 0;

  constructor(
    private readonly lagTicks: number,
    private readonly obstacles = open,
  ) {
    this.prediction = new Prediction(start, obstacles, gait, TICK_S);
  }

  give(command: Command): void {
    this.prediction.command(command);
    this.uplink.push({ due: this.tick + this.lagTicks, command });
  }

  run(ticks: number): void {
    for (let i = 0; i < ticks; i++) {
      this.serverTick();
      for (let frame = 0; frame < FRAMES_PER_TICK; frame++) {
        const { x, y } = this.prediction.shown;
        this.prediction.advance(FRAME_S);
        const after = this.prediction.shown;
        this.largestStepM = Math.max(this.largestStepM, Math.hypot(after.x - x, after.y - y));
      }
    }
  }

  private serverTick(): void {
    this.tick++;
    for (const { due, command } of this.uplink) {
      if (due !== this.tick) continue;
      this.current = command;
      this.ack = command.seq;
    }
    if (this.current.kind === "move") {
      const { direction, speed } = this.current;
      const dx = Math.cos(direction) * speed * TICK_S;
      const dy = Math.sin(direction) * speed * TICK_S;
      const { server } = this;
      const [x, y, z] = this.obstacles.walk([server.x, server.y, server.z], dx, dy, 0.25);
      this.server = { ...server, x, y, z, speed, heading: direction };
    }
    const { tick, ack, server } = this;
    this.downlink.push({ due: tick + this.lagTicks, tick, ack, pose: server });
    for (const snapshot of this.downlink) {
      if (snapshot.due !== tick) continue;
      this.prediction.reconcile(snapshot.tick, snapshot.ack, snapshot.pose);
    }
  }
}

describe("Prediction", () => {
  it("answers in the first frame", () => {
    const { prediction } = new Rehearsal(4);
    prediction.command(move(1, 1.5));
    prediction.advance(FRAME_S);
    expect(prediction.shown.x).toBeCloseTo(50 + 1.5 * FRAME_S);
  });

  it.each([1, 4])("needs no correction when the server agrees, %i ticks away", (lag) => {
    const rehearsal = new Rehearsal(lag);
    rehearsal.give(move(1, 1.5));
    rehearsal.run(30);
    expect(rehearsal.prediction.correctionM).toBeLessThan(1.5 * TICK_S);
    rehearsal.give(move(2, 1.5, Math.PI / 2));
    rehearsal.run(30);
    rehearsal.give(move(3, 0));
    rehearsal.run(80);
    const { x, y } = rehearsal.prediction.shown;
    expect(Math.hypot(x - rehearsal.server.x, y - rehearsal.server.y)).toBeLessThan(0.01);
    expect(rehearsal.largestStepM).toBeLessThan(1.5 * FRAME_S * 1.5);
  });

  it("does not run through a wall and snap back", () => {
    const rehearsal = new Rehearsal(4, walled);
    rehearsal.give(move(1, 1.5));
    for (let i = 0; i < 60; i++) {
      rehearsal.run(1);
      expect(rehearsal.prediction.shown.x).toBeLessThan(51.76);
    }
    expect(rehearsal.prediction.shown.x).toBeCloseTo(51.75, 2);
  });

  it("fades out a disagreement instead of jumping", () => {
    const { prediction } = new Rehearsal(1);
    prediction.reconcile(1, 0, { ...start, x: 50.5 });
    expect(prediction.shown.x).toBeCloseTo(50);
    const seen: number[] = [];
    for (let i = 0; i < 60; i++) {
      prediction.advance(FRAME_S);
      seen.push(prediction.shown.x);
    }
    expect(seen.every((x, i) => i === 0 || x >= (seen[i - 1] ?? 0))).toBe(true);
    expect(prediction.shown.x).toBeCloseTo(50.5, 1);
  });

  it("follows at once when it was put somewhere else", () => {
    const { prediction } = new Rehearsal(1);
    prediction.reconcile(1, 0, { ...start, x: 80 });
    expect(prediction.shown.x).toBe(80);
  });

  it("walks straight to a point it can see, and stops there", () => {
    const { prediction } = new Rehearsal(1);
    prediction.command({ kind: "walk_to", seq: 1, x: 53, y: 50, z: 0 });
    for (let i = 0; i < 60; i++) prediction.advance(FRAME_S);
    expect(prediction.shown.x).toBeCloseTo(50 + gait.walkSpeedMps, 1);
    for (let i = 0; i < 120; i++) prediction.advance(FRAME_S);
    expect(prediction.shown.x).toBeCloseTo(53, 1);
    expect(prediction.shown.speed).toBe(0);
  });

  it("leaves the way around walls to the server", () => {
    const { prediction } = new Rehearsal(1, walled);
    prediction.command({ kind: "walk_to", seq: 1, x: 54, y: 50, z: 0 });
    prediction.advance(FRAME_S);
    expect(prediction.shown.x).toBe(50);
    prediction.reconcile(1, 1, { ...start, heading: Math.PI / 2, speed: 1 });
    prediction.advance(0.1);
    expect(prediction.shown.y).toBeCloseTo(50.1, 1);
  });

  it("takes the server's word that a walk has ended short of the point", () => {
    const { prediction } = new Rehearsal(1);
    prediction.command({ kind: "walk_to", seq: 1, x: 53, y: 50, z: 0 });
    for (let tick = 1; tick < 40; tick++) {
      prediction.reconcile(tick, 1, { ...start, x: 52 });
      prediction.advance(TICK_S);
    }
    expect(prediction.shown.speed).toBe(0);
    expect(prediction.shown.x).toBeCloseTo(52, 1);
  });

  it("climbs ahead of the server, which has the last word on the height", () => {
    const foot: Pose = { ...start, x: 4.5, y: 13 };
    const prediction = new Prediction(foot, new Obstacles(twoFloors, adult), gait, TICK_S);
    prediction.command(move(1, 1.5));
    for (let i = 0; i < 60; i++) prediction.advance(FRAME_S);
    expect(prediction.shown.z).toBeGreaterThan(0.4);
    prediction.reconcile(1, 0, { ...foot, x: 15, y: 15, z: 3 });
    expect(prediction.shown.z).toBe(3);
  });
});
