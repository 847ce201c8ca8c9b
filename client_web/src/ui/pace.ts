/** The banner of a world that is paused, or whose time runs slower or faster than usual. */

import type { ServerMessage } from "../net/messages";
import { byId } from "./dom";
import { paceOf } from "./sentences";
import { write } from "./writing";

/** A banner that all is as usual again goes by itself. */
const SHOWN_MS = 5000;

type Notice = Extract<ServerMessage, { type: "notice" }>;

const OF_PACE = new Set(["paused", "resumed", "pace"]);

export class PaceBanner {
  private readonly banner = byId("pace", HTMLElement);
  private timer: number | undefined;

  /** Show a notice, if it is of the pace of the world; returns whether it is. */
  show(notice: Notice): boolean {
    if (!OF_PACE.has(notice.notice)) return false;
    this.hide();
    write(this.banner, () => paceOf(notice));
    this.banner.dataset.notice = notice.notice;
    this.banner.hidden = false;
    if (notice.arguments["rate"] === 1) {
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
