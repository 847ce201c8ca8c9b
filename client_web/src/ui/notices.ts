/** The banner of what moderators tell this person: an announcement, a mute, a warning. */

import type { Wording } from "../language/phrase";
import { words } from "../language/words";
import { byId } from "./dom";
import type { Saying } from "./sentences";
import { write } from "./writing";

/** A notice that needs no answer goes by itself after this time. */
const SHOWN_MS = 20_000;
const COUNT_MS = 1000;

export class NoticeBanner {
  private readonly banner = byId("moderation", HTMLElement);
  private readonly head = byId("moderation-head", HTMLElement);
  private readonly words = byId("moderation-words", HTMLElement);
  private timer: number | undefined;

  constructor() {
    byId("moderation-close", HTMLButtonElement).addEventListener("click", () => {
      this.hide();
    });
  }

  /** Show something until it is closed; `lasting` notices do not go by themselves. */
  show(saying: () => Saying, lasting: boolean): void {
    this.hide();
    write(this.head, () => saying().head);
    write(this.words, () => saying().words);
    this.banner.hidden = false;
    if (!lasting) {
      this.timer = window.setTimeout(() => {
        this.hide();
      }, SHOWN_MS);
    }
  }

  /** Show for how long this person is muted yet; it goes when that is over. */
  muted(said: () => Wording, seconds: number): void {
    const untilMs = performance.now() + 1000 * seconds;
    this.show(() => ({ head: "", words: said() }), true);
    const count = (): void => {
      const leftS = (untilMs - performance.now()) / 1000;
      if (leftS <= 0) this.hide();
      else write(this.head, () => words.notices.mutedYet(leftS));
    };
    count();
    this.timer = window.setInterval(count, COUNT_MS);
  }

  hide(): void {
    window.clearTimeout(this.timer);
    window.clearInterval(this.timer);
    this.banner.hidden = true;
  }
}
