/**
 * Server time on this machine, from pings: by the quickest recent round trip. It runs at the pace of
 * the world, and stands while that is paused.
 */

const KEPT = 8;

interface Sample {
  roundTripS: number;
  /** The server's time at a time of this machine. */
  serverS: number;
  localS: number;
}

export class ServerClock {
  private readonly samples: Sample[] = [];
  private best: Sample | null = null;
  private lastRoundTripS: number | null = null;
  /** Seconds of the world in a second. */
  private rate_ = 1;

  /** A reading of the server's time without a round trip; replaced by the first real sample. */
  seed(serverTimeS: number, nowS: number): void {
    this.samples.length = 0;
    this.best = { roundTripS: Infinity, serverS: serverTimeS, localS: nowS };
    this.rate_ = 1;
  }

  /** The world runs at another rate from now on, since the server's time `serverTimeS`. */
  pace(rate: number, serverTimeS: number, nowS: number): void {
    const waysS = this.samples.map(({ roundTripS }) => roundTripS / 2);
    const agoS = waysS.length > 0 ? Math.min(...waysS) : 0;
    this.samples.length = 0;
    this.best = { roundTripS: Infinity, serverS: serverTimeS + rate * agoS, localS: nowS };
    this.rate_ = rate;
  }

  /** A pong: sent and received in local seconds, the server's time in between. */
  add(sentS: number, receivedS: number, serverTimeS: number): void {
    const roundTripS = Math.max(0, receivedS - sentS);
    this.lastRoundTripS = roundTripS;
    const serverS = serverTimeS + (this.rate_ * roundTripS) / 2;
    this.samples.push({ roundTripS, serverS, localS: receivedS });
    if (this.samples.length > KEPT) this.samples.shift();
    // Of a world that stands, the time grows with each tick that is run all the same.
    const last = this.samples.at(-1) ?? null;
    this.best =
      this.rate_ === 0
        ? last
        : this.samples.reduce((a, b) => (b.roundTripS < a.roundTripS ? b : a));
  }

  /** The server's time at the local time `nowS`, seconds. */
  at(nowS: number): number {
    return this.best ? this.best.serverS + this.rate_ * (nowS - this.best.localS) : nowS;
  }

  get rate(): number {
    return this.rate_;
  }

  /** The latest round trip in seconds, null before the first. */
  get roundTripS(): number | null {
    return this.lastRoundTripS;
  }
}
