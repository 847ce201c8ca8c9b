/** Interpolates between the snapshots of one avatar at the last ticks. */

import { mixAngles } from "./angles";

export interface Pose {
  x: number;
  y: number;
  /** Height of the feet. */
  z: number;
  layer: number;
  heading: number;
  speed: number;
  reason: number;
}

export function copyPose(from: Readonly<Pose>, out: Pose): void {
  out.x = from.x;
  out.y = from.y;
  out.z = from.z;
  out.layer = from.layer;
  out.heading = from.heading;
  out.speed = from.speed;
  out.reason = from.reason;
}

interface Sample extends Pose {
  timeS: number;
}

/** Enough for two seconds at 20 ticks a second. */
const KEPT = 40;
/** A walk goes on by itself for this long when snapshots stay away. */
const COAST_S = 0.25;

export class Interpolator {
  private readonly samples: Sample[] = [];
  private readonly here: Pose;

  constructor(timeS: number, pose: Pose) {
    this.here = { ...pose };
    this.samples.push({ ...pose, timeS });
  }

  /** A record of the tick at `timeS`; one that is not newer than the last is ignored. */
  add(timeS: number, pose: Pose): void {
    if (timeS <= this.last.timeS) return;
    this.samples.push({ ...pose, timeS });
    if (this.samples.length > KEPT) this.samples.shift();
  }

  /** Nothing had changed up to `timeS`: the next change begins there. */
  hold(timeS: number): void {
    if (timeS <= this.last.timeS) return;
    this.add(timeS, { ...this.last, speed: 0 });
  }

  get last(): Sample {
    const last = this.samples.at(-1);
    if (!last) throw new Error("an interpolator begins with a sample");
    return last;
  }

  /**
   * The pose at `timeS`, good until the next call. After the last sample it stays there if `heardS`,
   * the time of the newest snapshot, says that nothing has changed since, else it coasts for a moment.
   */
  at(timeS: number, heardS: number): Readonly<Pose> {
    const { samples, here } = this;
    let after = samples.length;
    while (after > 0 && (samples[after - 1]?.timeS ?? 0) > timeS) after--;
    const a = samples[after - 1];
    const b = samples[after];
    if (!a) return samples[0] ?? this.last;
    if (!b) return this.beyond(timeS, heardS);
    const part = (timeS - a.timeS) / (b.timeS - a.timeS);
    here.x = a.x + (b.x - a.x) * part;
    here.y = a.y + (b.y - a.y) * part;
    here.z = a.z + (b.z - a.z) * part;
    here.layer = part < 0.5 ? a.layer : b.layer;
    here.heading = mixAngles(a.heading, b.heading, part);
    here.speed = a.speed + (b.speed - a.speed) * part;
    here.reason = b.reason;
    return here;
  }

  private beyond(timeS: number, heardS: number): Readonly<Pose> {
    const { last, here } = this;
    const before = this.samples.at(-2);
    if (!before || heardS > last.timeS) return last;
    const coastS = Math.min(timeS - last.timeS, COAST_S);
    const stepS = last.timeS - before.timeS;
    copyPose(last, here);
    here.x += ((last.x - before.x) / stepS) * coastS;
    here.y += ((last.y - before.y) / stepS) * coastS;
    return here;
  }
}
