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
/** A walk goes on by itself for this long when nothing more is told of it. */
const COAST_S = 0.25;
/** Of an avatar far away that walks, records come this far apart. */
const FAR_S = 0.2;
/** Time is stretched by at most this part to draw an avatar later or earlier. */
const STRETCH = 0.1;

export class Interpolator {
  private readonly samples: Sample[] = [];
  private readonly here: Pose;
  /** Time between the newest records of a walk. */
  private apartS: number;
  /** The avatar is drawn later by this, so that there is a record on either side. */
  private laterS = 0;

  constructor(
    timeS: number,
    pose: Pose,
    private readonly tickS: number,
  ) {
    this.here = { ...pose };
    this.samples.push({ ...pose, timeS });
    this.apartS = tickS;
  }

  /** A record of the tick at `timeS`; one that is not newer than the last is ignored. */
  add(timeS: number, pose: Pose): void {
    const { last, tickS } = this;
    if (timeS <= last.timeS) return;
    if (last.speed > 0) this.apartS = Math.min(timeS - last.timeS, FAR_S);
    else this.stand(timeS - Math.max(tickS, walkS(last, pose)));
    this.samples.push({ ...pose, timeS });
    if (this.samples.length > KEPT) this.samples.shift();
  }

  /** The avatar stood still up to `timeS`, as nothing else was told of it. */
  private stand(timeS: number): void {
    const { last } = this;
    if (timeS > last.timeS) this.samples.push({ ...last, timeS });
  }

  /** Draw the avatar a little later, or earlier again, as its records come further apart. */
  private comeBehind(frameS: number): void {
    const off = this.apartS - this.tickS - this.laterS;
    const most = STRETCH * frameS;
    this.laterS += Math.max(-most, Math.min(most, off));
  }

  get last(): Sample {
    const last = this.samples.at(-1);
    if (!last) throw new Error("an interpolator begins with a sample");
    return last;
  }

  /** The pose to draw at `drawnS`, `frameS` after the call before; good until the next call. */
  advance(drawnS: number, heardS: number, frameS: number): Readonly<Pose> {
    this.comeBehind(frameS);
    return this.at(drawnS - this.laterS, heardS);
  }

  /**
   * The pose at `timeS`, good until the next call. After the last sample an avatar that stood stays
   * there if `heardS`, the time of the newest snapshot, is later. One that walked coasts for a
   * moment, and is back where it was last if the next record stays away.
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
    const silentS = last.speed > 0 ? COAST_S : 0;
    if (!before || heardS > last.timeS + silentS) return last;
    const coastS = Math.min(timeS - last.timeS, COAST_S);
    const stepS = last.timeS - before.timeS;
    copyPose(last, here);
    here.x += ((last.x - before.x) / stepS) * coastS;
    here.y += ((last.y - before.y) / stepS) * coastS;
    return here;
  }
}

/** The time that it takes to walk from one pose to another. */
function walkS(from: Readonly<Pose>, to: Readonly<Pose>): number {
  return to.speed > 0 ? Math.hypot(to.x - from.x, to.y - from.y) / to.speed : 0;
}
