/** The banner of a world that is paused, or whose time runs slower or faster than usual. */

import { byId } from "./dom";

/** A banner that all is as usual again goes by itself. */
const SHOWN_MS = 5000;

const OF_PACE = new Set(["paused", "resumed", "pace"]);

export class PaceBanner {
  private readonly banner = byId("pace", HTMLElement);
  private timer: number | undefined;

  /** Show a notice, if it is of the pace of the world; returns whether it is. */
  show({ notice, text, arguments: { rate } }: Notice): boolean {
    if (!OF_PACE.has(notice)) return false;
    this.hide();
    this.banner.textContent = text;
    this.banner.dataset.notice = notice;
    this.banner.hidden = false;
    if (rate === 1) {
      this.timer = window.setTimeout(() => {
        this.hide();
      }, SHOWN_MS);
    }
    return true;
  }

  hide(): void {
    window.clearTimeout(this.timer);
    this.banner.hidden = true;
  }
}

interface Notice {
  notice: string;
  text: string;
  arguments: { rate?: unknown };
}
