/** Where one avatar was at each of the last ticks, and where it is drawn in between. */

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

interface Sample extends Pose {
  timeS: number;
}

/** Enough for two seconds at 20 ticks a second. */
const KEPT = 40;
/** How long a walk goes on by itself when snapshots stay away. */
const COAST_S = 0.25;

export class Motion {
  private readonly samples: Sample[] = [];

  constructor(timeS: number, pose: Pose) {
    this.samples.push({ ...pose, timeS });
  }

  /** A record of the tick at `timeS`; one that is not newer than the last is ignored. */
  add(timeS: number, pose: Pose): void {
    if (timeS <= this.last.timeS) return;
    this.samples.push({ ...pose, timeS });
    if (this.samples.length > KEPT) this.samples.shift();
  }

  /** Nothing had changed up to `timeS`: what comes next begins there. */
  hold(timeS: number): void {
    if (timeS <= this.last.timeS) return;
    this.add(timeS, { ...this.last, speed: 0 });
  }

  get last(): Sample {
    const last = this.samples.at(-1);
    if (!last) throw new Error("a motion begins with a sample");
    return last;
  }

  /**
   * The pose at `timeS`. After the last sample it stays there if `heardS`, the time of the newest
   * snapshot, says that nothing has changed since, else it coasts for a moment.
   */
  at(timeS: number, heardS: number): Pose {
    const after = this.samples.findIndex((sample) => sample.timeS > timeS);
    if (after < 0) return this.beyond(timeS, heardS);
    const b = this.samples[after];
    const a = this.samples[after - 1];
    if (!a || !b) return this.samples[0] ?? this.last;
    const part = (timeS - a.timeS) / (b.timeS - a.timeS);
    return {
      x: a.x + (b.x - a.x) * part,
      y: a.y + (b.y - a.y) * part,
      z: a.z + (b.z - a.z) * part,
      layer: part < 0.5 ? a.layer : b.layer,
      heading: mixAngles(a.heading, b.heading, part),
      speed: a.speed + (b.speed - a.speed) * part,
      reason: b.reason,
    };
  }

  private beyond(timeS: number, heardS: number): Pose {
    const { last } = this;
    const before = this.samples.at(-2);
    if (!before || heardS > last.timeS) return last;
    const coastS = Math.min(timeS - last.timeS, COAST_S);
    const stepS = last.timeS - before.timeS;
    return {
      ...last,
      x: last.x + ((last.x - before.x) / stepS) * coastS,
      y: last.y + ((last.y - before.y) / stepS) * coastS,
    };
  }
}
