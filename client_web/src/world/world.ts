/** Everything in view as this client knows it: avatars, the poses that are drawn, and the plan. */

import type {
  Doors,
  EntityInfo,
  EntityRecord,
  Look,
  GestureName,
  Place,
  Plan,
  SceneData,
  Welcome,
} from "../net/messages";
import { Floors } from "./floors";
import { meshParts, type Triangles } from "./mesh";
import { Interpolator, type Pose } from "./interpolation";
import { Obstacles } from "./obstacles";
import type { Reach } from "./barriers";
import { Playout } from "./playout";
import { type Command, type Gait, Prediction } from "./prediction";
import type { StepRecord } from "../net/steps";
import { buildOf } from "./skeleton";
import { Animator } from "./animator";

/** An avatar in view. `pose` is where it is drawn in this frame. */
export interface Avatar {
  readonly id: number;
  readonly kind: EntityInfo["kind"];
  readonly name: string;
  readonly radius: number;
  /** The look that its person has chosen; null where it follows from the id. */
  readonly look: Look | null;
  readonly own: boolean;
  /** The animation of its body. */
  readonly animator: Animator;
  pose: Pose;
  /** Whether its person is away: nobody looks through its eyes for now. */
  away: boolean;
}

/** The body and look that an avatar has from now on. */
type Reshaped = Pick<EntityInfo, "id" | "radius" | "leg_m" | "stature_m" | "look">;

/** The least time that the own steps are drawn behind their usual arrival. */
const OWN_LEAST_S = 0.02;

interface Followed extends Avatar {
  readonly interpolator: Interpolator;
}

export class World {
  readonly scene: SceneData;
  readonly ownId: number;
  readonly gait: Gait;
  floors: Floors;
  /** The newest plan of the watched actor. */
  plan: Plan | null = null;
  private readonly avatars_ = new Map<number, Followed>();
  private readonly playout: Playout;
  /** The own steps are drawn as soon as they are there. */
  private readonly ownPlayout = new Playout(0, OWN_LEAST_S);
  private obstacles: Obstacles;
  private readonly reach: Reach;
  private readonly tickS: number;
  private prediction: Prediction | null = null;
  private heardS: number;

  constructor(private readonly welcome: Welcome) {
    this.scene = welcome.scene;
    this.ownId = welcome.id;
    this.gait = {
      clearanceM: welcome.clearance,
      maxSpeedMps: welcome.max_speed,
      walkSpeedMps: welcome.walk_speed,
    };
    this.reach = { heightM: welcome.body_height, stepM: welcome.step_height };
    this.tickS = 1 / welcome.tick_rate;
    this.playout = new Playout(this.tickS);
    this.floors = new Floors(welcome.scene);
    this.obstacles = new Obstacles(welcome.scene, this.reach, this.floors);
    this.obstacles.doors = welcome.doors;
    this.heardS = welcome.server_time;
  }

  /** The time at which everybody is drawn; null before the first frame. */
  private drawnS: number | null = null;

  get avatars(): ReadonlyMap<number, Avatar> {
    return this.avatars_;
  }

  /** The own avatar; null until the server has said where it is. */
  get own(): Avatar | null {
    return this.avatars_.get(this.ownId) ?? null;
  }

  /** The distance from the own avatar to where the server will have it, metres. */
  get correctionM(): number {
    return this.prediction?.correctionM ?? 0;
  }

  /** The others are drawn this far behind the server's time, seconds. */
  get delayS(): number {
    return this.playout.delayS;
  }

  /** The same of the own steps. */
  get ownDelayS(): number {
    return this.ownPlayout.delayS;
  }

  enter(tick: number, entities: readonly EntityInfo[]): void {
    for (const info of entities) {
      const own = info.id === this.ownId;
      const { x, y, z, layer, heading } = info;
      const pose = { x, y, z, layer, heading, speed: 0, reason: 0 };
      const animator = new Animator(buildOf(info.leg_m, info.stature_m), pose);
      const interpolator = new Interpolator(this.timeOf(tick), pose, this.tickS);
      this.avatars_.set(info.id, {
        id: info.id,
        kind: info.kind,
        name: info.name,
        radius: info.radius,
        look: info.look ?? null,
        own,
        animator,
        pose,
        away: false,
        interpolator,
      });
      this.point(info.id, info.points_at);
      if (own) this.prediction ??= this.predict(pose);
    }
  }

  leave(ids: readonly number[]): void {
    for (const id of ids) {
      this.avatars_.delete(id);
      if (this.plan?.id === id) this.plan = null;
    }
  }

  /** A snapshot holds those of whom there is news that is due; see `docs/protocol.md`. */
  snapshot(tick: number, ack: number, records: readonly EntityRecord[], serverNowS: number): void {
    const timeS = this.timeOf(tick);
    for (const record of records) {
      const { id, ...pose } = record;
      const interpolator = this.avatars_.get(id)?.interpolator;
      interpolator?.add(timeS, pose);
      if (id === this.ownId) this.prediction?.reconcile(tick, ack, pose);
    }
    this.playout.arrived(timeS, serverNowS);
    this.ownPlayout.arrived(timeS, serverNowS);
    this.heardS = timeS;
  }

  /** Steps that somebody near by begins. */
  steps(records: readonly StepRecord[]): void {
    for (const record of records) {
      const beginS = this.timeOf(record.tick);
      const endS = this.timeOf(record.tick + record.ticks);
      this.avatars_.get(record.id)?.animator.add(record, beginS, endS);
    }
  }

  /** Somebody points at a place from now on, or, if it is null, at nothing. */
  point(id: number, target: Place | null): void {
    const animator = this.avatars_.get(id)?.animator;
    if (!animator) return;
    const [x, y, z] = target ?? [0, 0, 0];
    animator.pointing.target = target && { x, y, z };
  }

  /** Somebody makes a gesture; `calm` holds it still. */
  gesture(id: number, gesture: GestureName, calm: boolean): void {
    this.avatars_.get(id)?.animator.gesturing.start(gesture, calm);
  }

  /** The person of an avatar is away from now on, or there again. */
  away(id: number, away: boolean): void {
    const avatar = this.avatars_.get(id);
    if (avatar) avatar.away = away;
  }

  /** An avatar has another body or look from now on; the steps of new legs come next. */
  reshape({ id, radius, leg_m: legM, stature_m: statureM, look }: Reshaped): void {
    const avatar = this.avatars_.get(id);
    if (!avatar) return;
    const build = buildOf(legM, statureM);
    let { animator } = avatar;
    if (build.legM !== animator.build.legM || build.trunkM !== animator.build.trunkM) {
      const { target } = animator.pointing;
      animator = new Animator(build, avatar.pose);
      animator.pointing.target = target;
    }
    this.avatars_.set(id, { ...avatar, radius, look: look ?? null, animator });
  }

  /** Whether each door stands open, by name. */
  get doors(): Readonly<Doors> {
    return this.obstacles.doors;
  }

  /** The triangles of a building that is a mesh have come. */
  built(triangles: Triangles): void {
    const { solids, steep } = meshParts(triangles);
    this.floors = new Floors(this.scene, solids);
    this.obstacles = new Obstacles(this.scene, this.reach, this.floors, steep);
    if (this.prediction) this.prediction.obstacles = this.obstacles;
  }

  doorsMoved(doors: Doors): void {
    this.obstacles.doors = { ...this.obstacles.doors, ...doors };
  }

  command(command: Command): void {
    this.prediction?.command(command);
  }

  /**
   * Move everybody to where they are drawn `passedS` later, in a world whose time runs `rate` times
   * as fast as ours; 0 while it stands.
   */
  advance(serverNowS: number, passedS: number, rate = 1): void {
    const before = this.drawnS ?? -Infinity;
    const timeS = this.playout.advance(serverNowS, passedS, rate);
    const ownS = this.ownPlayout.advance(serverNowS, passedS, rate);
    this.drawnS = timeS;
    // The picture comes to rest a moment after the world does.
    const frameS = rate === 0 ? Math.min(passedS, timeS - before) : passedS * rate;
    this.prediction?.advance(passedS * rate, passedS);
    for (const avatar of this.avatars_.values()) {
      const { animator, interpolator, own } = avatar;
      avatar.pose =
        own && this.prediction
          ? animator.advance(ownS, this.prediction.shown, frameS)
          : animator.advance(timeS, interpolator.advance(timeS, this.heardS, frameS), frameS);
    }
  }

  private predict(pose: Pose): Prediction {
    return new Prediction(pose, this.obstacles, this.gait, this.tickS);
  }

  private timeOf(tick: number): number {
    return this.welcome.server_time + (tick - this.welcome.tick) * this.tickS;
  }
}
