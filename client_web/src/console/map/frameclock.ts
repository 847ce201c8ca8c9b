/** Gives the frames of the map even times, whatever the network does to them, at any pace. */

const USUAL_TICK_S = 0.05;
const WEIGHT = 0.1;
/** Part of the way to its arrival by which the time of a frame is drawn. */
const PULL = 0.1;
/** A frame this far off begins anew: the world was paused, or the line was cut. */
const JUMP_S = 0.5;

export class FrameClock {
  private tickS = USUAL_TICK_S;
  private tick: number | null = null;
  private arrivedS = 0;
  private timeS = 0;

  /** The time of the frame of a tick that has arrived at `nowS`, in the same seconds. */
  stamp(tick: number, nowS: number): number {
    const ticks = this.tick === null ? 0 : tick - this.tick;
    const goneS = nowS - this.arrivedS;
    if (ticks > 0 && goneS < JUMP_S * 4) {
      this.tickS += WEIGHT * (goneS / ticks - this.tickS);
      const evenS = this.timeS + ticks * this.tickS;
      const off = nowS - evenS;
      this.timeS = Math.abs(off) > JUMP_S ? nowS : Math.max(this.timeS, evenS + PULL * off);
    } else {
      this.timeS = nowS;
    }
    this.tick = tick;
    this.arrivedS = nowS;
    return this.timeS;
  }
}
