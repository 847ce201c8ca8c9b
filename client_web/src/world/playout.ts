/** The playout delay: avatars are drawn behind the server's time, between two snapshots. */

/** The least time behind the usual arrival of a snapshot. */
const LEAST_S = 0.1;
const MOST_S = 0.6;
const DEVIATIONS = 3;
/** Weight of a new arrival in the running mean and deviation. */
const WEIGHT = 0.05;
/** Time is stretched by at most this part to reach its aim, so that nobody seems to jump. */
const STRETCH = 0.1;
/** This far ahead of its aim, because the server has fallen behind, it goes at half its pace. */
const AHEAD_S = 0.25;
const SLOW = 0.5;
/** Forwards it jumps this far, backwards only to a server that has begun anew. */
const JUMP_S = 0.75;
const BACK_S = 5;

export class Playout {
  private lateness: number | null = null;
  private deviation = 0.005;
  private timeS_: number | null = null;
  /** Seconds of the world in a second, of the frame before; not 0. */
  private rate = 1;
  private stands = false;
  /** While the world stands, the drawn time rests this far behind the server's; null while it runs. */
  private restS: number | null = null;

  /** `cushionS` is kept beyond the deviation of arrivals, and never less than `leastS` at all. */
  constructor(
    private readonly cushionS: number,
    private readonly leastS = LEAST_S,
  ) {}

  /** A snapshot of the tick at `tickTimeS` came in when the server's time was `serverNowS`. */
  arrived(tickTimeS: number, serverNowS: number): void {
    if (this.stands) return;
    const latenessS = serverNowS - tickTimeS;
    if (this.lateness === null) {
      this.lateness = latenessS;
      return;
    }
    const off = latenessS - this.lateness;
    this.lateness += WEIGHT * off;
    this.deviation += WEIGHT * (Math.abs(off) - this.deviation);
  }

  /** The drawn time is to be this far behind the server's. */
  get delayS(): number {
    const behindS = Math.min(MOST_S, this.cushionS + DEVIATIONS * this.deviation);
    return (this.lateness ?? 0) + Math.max(this.leastS, behindS);
  }

  /**
   * The drawn time, one frame of `frameS` later, in a world whose time runs `rate` times as fast.
   * Never runs backwards but for a jump.
   */
  advance(serverNowS: number, frameS: number, rate = 1): number {
    this.stands = rate === 0;
    if (this.stands) return this.comeToRest(serverNowS, frameS);
    this.restS = null;
    this.changeRate(rate);
    return this.run(serverNowS - this.delayS, frameS * rate);
  }

  /**
   * The world stands: go on to where it stands, and no further. If the delay has just grown, the
   * picture is ahead of its aim: then it rests that much nearer to the world, so that all of the
   * ticks that are run meanwhile are drawn.
   */
  private comeToRest(serverNowS: number, frameS: number): number {
    const before = this.timeS_ ?? serverNowS - this.delayS;
    this.restS ??= Math.min(this.delayS, serverNowS - before);
    const aheadS = serverNowS - this.restS - before;
    this.timeS_ = before + Math.max(0, Math.min(frameS, aheadS));
    return this.timeS_;
  }

  /** Messages take as long as ever, which is more time of the world if that runs faster. */
  private changeRate(rate: number): void {
    if (rate === this.rate) return;
    if (this.lateness !== null) this.lateness *= rate / this.rate;
    this.deviation *= rate / this.rate;
    this.rate = rate;
  }

  private run(aimS: number, frameS: number): number {
    const next = (this.timeS_ ?? aimS) + frameS;
    const off = aimS - next;
    const slower = off < -AHEAD_S ? SLOW : STRETCH;
    this.timeS_ =
      off > JUMP_S || off < -BACK_S
        ? aimS
        : next + Math.max(-slower * frameS, Math.min(STRETCH * frameS, off));
    return this.timeS_;
  }
}
