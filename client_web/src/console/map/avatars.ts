/** Everybody in the world as the live map tells, drawn evenly between its frames. */

import type { EntityRecord } from "../../net/messages";
import { mixAngles } from "../../world/angles";
import type { LiveMessage } from "../net/live";
import { Signal } from "../state/signal";
import { FrameClock } from "./frameclock";
import { readHeader, readRecords } from "./frames";
import { Trail } from "./trail";

/** Avatars are drawn this much behind their frames, which come ten times a second. */
const BEHIND_S = 0.2;
const NOBODY = "?";

export interface Place {
  x: number;
  y: number;
  z: number;
  heading: number;
}

interface Sample extends Place {
  timeS: number;
}

export interface Avatar {
  readonly id: number;
  /** The name by which it is chosen: `main/actor-1`, or `person:12`. */
  key: string;
  kind: "actor" | "person";
  name: string;
  radiusM: number;
  groups: readonly string[];
  behaviour: string;
  speed: number;
  reason: number;
  readonly trail: Trail;
  readonly from: Sample;
  readonly to: Sample;
}

export interface Entered {
  id: number;
  kind: "actor" | "person";
  name: string;
  actor?: string | null;
  radius_m: number;
  groups?: readonly string[];
  behaviour?: string | null;
}

export interface MapMessage extends LiveMessage {
  /** Whether those who entered are all there are. */
  reset?: boolean;
  entered?: readonly Entered[];
  left?: readonly number[];
  origin_m?: readonly [number, number];
}

export class Avatars {
  /** Becomes another whenever somebody comes, goes, or is called otherwise. */
  readonly roster = new Signal(0);
  readonly tick = new Signal(0);
  readonly byId = new Map<number, Avatar>();
  private readonly byKey = new Map<string, Avatar>();
  private readonly clock = new FrameClock();
  private origin: readonly [number, number] = [0, 0];
  private frameS = 0;

  get(key: string): Avatar | undefined {
    return this.byKey.get(key);
  }

  hear(message: MapMessage): void {
    if (message.reset) this.forgetOthers(message.entered ?? []);
    if (message.origin_m) this.origin = message.origin_m;
    for (const id of message.left ?? []) this.remove(id);
    for (const entered of message.entered ?? []) this.enter(entered);
    if (message.left?.length || message.entered?.length) this.roster.value++;
  }

  /** A frame that has come in at `nowS`. */
  take(frame: ArrayBuffer, nowS: number): void {
    const view = new DataView(frame);
    const { tick, count, whole } = readHeader(view);
    const timeS = this.clock.stamp(tick, nowS);
    const beforeS = this.frameS;
    this.frameS = timeS;
    const seen = whole ? new Set<number>() : null;
    readRecords(view, count, this.origin, (record) => {
      seen?.add(record.id);
      this.move(this.byId.get(record.id) ?? this.unknown(record), record, timeS, beforeS);
    });
    if (seen) {
      const gone = [...this.byId.keys()].filter((id) => !seen.has(id));
      for (const id of gone) this.remove(id);
      if (gone.length > 0) this.roster.value++;
    }
    this.tick.value = tick;
  }

  /** The moment to draw when it is `nowS`. */
  drawnS(nowS: number): number {
    return nowS - BEHIND_S;
  }

  /** Forget everybody: another socket tells all of it anew. */
  clear(): void {
    this.byId.clear();
    this.byKey.clear();
    this.roster.value++;
  }

  private forgetOthers(all: readonly Entered[]): void {
    const kept = new Set(all.map(({ id }) => id));
    for (const id of [...this.byId.keys()]) if (!kept.has(id)) this.remove(id);
  }

  private enter(entered: Entered): void {
    const avatar = this.byId.get(entered.id) ?? newAvatar(entered.id);
    this.byKey.delete(avatar.key);
    avatar.kind = entered.kind;
    avatar.key = entered.actor ?? `person:${entered.id}`;
    avatar.name = entered.name;
    avatar.radiusM = entered.radius_m;
    avatar.groups = entered.groups ?? [];
    avatar.behaviour = entered.behaviour ?? "";
    this.byId.set(entered.id, avatar);
    this.byKey.set(avatar.key, avatar);
  }

  private unknown({ id }: Readonly<EntityRecord>): Avatar {
    this.enter({ id, kind: "person", name: NOBODY, radius_m: 0.25 });
    this.roster.value++;
    return this.byId.get(id) ?? newAvatar(id);
  }

  private remove(id: number): void {
    const avatar = this.byId.get(id);
    if (!avatar) return;
    this.byId.delete(id);
    if (this.byKey.get(avatar.key) === avatar) this.byKey.delete(avatar.key);
  }

  private move(
    avatar: Avatar,
    record: Readonly<EntityRecord>,
    timeS: number,
    beforeS: number,
  ): void {
    const { from, to } = avatar;
    const isNew = to.timeS === Number.NEGATIVE_INFINITY;
    copy(isNew ? record : to, from);
    // Somebody of whom the frame before told nothing stood still until then.
    from.timeS = isNew ? timeS : Math.max(to.timeS, beforeS);
    copy(record, to);
    to.timeS = timeS;
    avatar.speed = record.speed;
    avatar.reason = record.reason;
    avatar.trail.add(record.x, record.y, record.z, timeS);
  }
}

/** Where an avatar is at a moment; `out` is given back. */
export function placeAt({ from, to }: Readonly<Avatar>, timeS: number, out: Place): Place {
  const span = to.timeS - from.timeS;
  const part = span > 0 ? Math.max(0, Math.min(1, (timeS - from.timeS) / span)) : 1;
  out.x = from.x + (to.x - from.x) * part;
  out.y = from.y + (to.y - from.y) * part;
  out.z = from.z + (to.z - from.z) * part;
  out.heading = mixAngles(from.heading, to.heading, part);
  return out;
}

function newAvatar(id: number): Avatar {
  const nowhere = { x: 0, y: 0, z: 0, heading: 0, timeS: Number.NEGATIVE_INFINITY };
  return {
    id,
    key: `person:${id}`,
    kind: "person",
    name: NOBODY,
    radiusM: 0.25,
    groups: [],
    behaviour: "",
    speed: 0,
    reason: 0,
    trail: new Trail(),
    from: { ...nowhere },
    to: { ...nowhere },
  };
}

function copy(from: Readonly<Place>, to: Place): void {
  to.x = from.x;
  to.y = from.y;
  to.z = from.z;
  to.heading = from.heading;
}
