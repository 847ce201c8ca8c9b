/** When things are sent: after a pause in typing, or at most so often. */

/** Calls its work once nothing has been wanted for some time. */
export class Debounced {
  private timer: ReturnType<typeof setTimeout> | null = null;

  constructor(
    private readonly work: () => void,
    private readonly pauseMs: number,
  ) {}

  want(): void {
    this.cancel();
    this.timer = setTimeout(() => {
      this.timer = null;
      this.work();
    }, this.pauseMs);
  }

  cancel(): void {
    if (this.timer !== null) clearTimeout(this.timer);
    this.timer = null;
  }
}

/** Carries out the latest wish, one at a time and no more often than every so many milliseconds. */
export class Stream<T> {
  private latest: { readonly value: T } | null = null;
  private busy = false;
  private timer: ReturnType<typeof setTimeout> | null = null;
  private lastMs = -Infinity;

  constructor(
    private readonly send: (value: T) => Promise<void>,
    private readonly everyMs: number,
    private readonly now: () => number = () => performance.now(),
  ) {}

  /** Take a wish; one that is not sent yet is superseded. */
  want(value: T): void {
    this.latest = { value };
    this.plan();
  }

  stop(): void {
    this.latest = null;
    if (this.timer !== null) clearTimeout(this.timer);
    this.timer = null;
  }

  private plan(): void {
    if (this.busy || this.timer !== null || this.latest === null) return;
    const waitMs = Math.max(0, this.lastMs + this.everyMs - this.now());
    this.timer = setTimeout(() => {
      this.timer = null;
      void this.flush();
    }, waitMs);
  }

  private async flush(): Promise<void> {
    if (this.latest === null) return;
    const { value } = this.latest;
    this.latest = null;
    this.busy = true;
    this.lastMs = this.now();
    try {
      await this.send(value);
    } finally {
      this.busy = false;
      this.plan();
    }
  }
}
