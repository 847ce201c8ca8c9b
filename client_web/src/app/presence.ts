/** Tells the world whether the person is at the page: it is in sight, and used now and then. */

/** Without any input for so long, a person is away. */
export const IDLE_MS = 180_000;

const SIGNS = ["pointerdown", "pointermove", "keydown", "wheel", "touchstart"] as const;

export class Presence {
  private isAway = false;
  private timer: number | undefined;

  /** `tell` is called whenever the person goes away or comes back. */
  constructor(
    private readonly page: Document,
    private readonly tell: (away: boolean) => void,
  ) {
    for (const sign of SIGNS) page.addEventListener(sign, this.look, { passive: true });
    page.addEventListener("visibilitychange", this.look);
    this.look();
  }

  get away(): boolean {
    return this.isAway;
  }

  private readonly look = (): void => {
    window.clearTimeout(this.timer);
    this.change(this.page.visibilityState === "hidden");
    if (this.isAway) return;
    this.timer = window.setTimeout(() => {
      this.change(true);
    }, IDLE_MS);
  };

  private change(away: boolean): void {
    if (away === this.isAway) return;
    this.isAway = away;
    this.tell(away);
  }
}
