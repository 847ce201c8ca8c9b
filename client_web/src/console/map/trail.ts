/** Where an avatar has been in the last minute. */

export const LONGEST_S = 60;
/** Points are kept this far apart. */
const APART_S = 0.5;
const MOST = LONGEST_S / APART_S;
const FIELDS = 4;

export class Trail {
  /** x, y, z, and the time. */
  private readonly points = new Float64Array(MOST * FIELDS);
  private next = 0;
  private count = 0;
  private lastS = Number.NEGATIVE_INFINITY;

  add(x: number, y: number, z: number, timeS: number): void {
    if (timeS - this.lastS < APART_S) return;
    this.points.set([x, y, z, timeS], this.next * FIELDS);
    this.next = (this.next + 1) % MOST;
    this.count = Math.min(MOST, this.count + 1);
    this.lastS = timeS;
  }

  /** Hand on the points after `fromS` and up to `toS`, the newest first. */
  each(fromS: number, toS: number, take: (x: number, y: number, z: number) => void): void {
    const { points } = this;
    for (let back = 1; back <= this.count; back++) {
      const at = ((this.next - back + MOST) % MOST) * FIELDS;
      const timeS = points[at + 3] ?? 0;
      if (timeS <= fromS) return;
      if (timeS > toS) continue;
      take(points[at] ?? 0, points[at + 1] ?? 0, points[at + 2] ?? 0);
    }
  }
}
