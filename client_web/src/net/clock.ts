/** Server time on this machine, from pings: the offset of the quickest recent round trip. */

const KEPT = 8;

interface Sample {
  roundTripS: number;
  offsetS: number;
}

export class ServerClock {
  private readonly samples: Sample[] = [];
  private best: Sample | null = null;

  /** A reading of the server's time without a round trip; replaced by the first real sample. */
  seed(serverTimeS: number, nowS: number): void {
    this.samples.length = 0;
    this.best = { roundTripS: Infinity, offsetS: serverTimeS - nowS };
  }

  /** A pong: sent and received in local seconds, the server's time in between. */
  add(sentS: number, receivedS: number, serverTimeS: number): void {
    const roundTripS = Math.max(0, receivedS - sentS);
    this.samples.push({ roundTripS, offsetS: serverTimeS + roundTripS / 2 - receivedS });
    if (this.samples.length > KEPT) this.samples.shift();
    this.best = this.samples.reduce((a, b) => (b.roundTripS < a.roundTripS ? b : a));
  }

  /** The server's time at the local time `nowS`, seconds. */
  at(nowS: number): number {
    return nowS + (this.best?.offsetS ?? 0);
  }

  /** The latest round trip in seconds, null before the first. */
  get roundTripS(): number | null {
    return this.samples.at(-1)?.roundTripS ?? null;
  }
}
