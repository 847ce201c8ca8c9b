/** Buttons that open and close a panel; small screens have room for one at a time. */

export class Panel {
  private static readonly all: Panel[] = [];
  private static readonly others: (() => void)[] = [];
  /** As `style/layout.css` has it. */
  private static readonly narrow = window.matchMedia(
    "(max-width: 540px), (max-width: 640px) and (min-height: 481px)",
  );

  constructor(
    private readonly button: HTMLButtonElement,
    private readonly panel: HTMLElement,
    private readonly changed: (open: boolean) => void = () => undefined,
  ) {
    Panel.all.push(this);
    button.addEventListener("click", () => {
      this.open = !this.open;
    });
    panel.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      this.open = false;
      button.focus();
    });
  }

  /** Something without a button of its own is closed wherever a panel needs its room. */
  static alsoClose(close: () => void): void {
    Panel.others.push(close);
  }

  /** Close all panels where there is room for one alone. */
  static makeRoom(): void {
    if (Panel.narrow.matches) for (const panel of Panel.all) panel.open = false;
  }

  get open(): boolean {
    return !this.panel.hidden;
  }

  set open(open: boolean) {
    if (open === this.open) return;
    if (open && Panel.narrow.matches) {
      for (const other of Panel.all) if (other !== this) other.open = false;
      for (const close of Panel.others) close();
    }
    this.panel.hidden = !open;
    this.button.setAttribute("aria-expanded", String(open));
    this.changed(open);
  }
}
