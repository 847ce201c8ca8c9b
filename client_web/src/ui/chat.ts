/** The chat: a log, a line to write in, and on small screens a button that opens both. */

import { MAX_CHAT_CHARS } from "../net/codes";
import type { ChatMessage } from "../net/messages";
import { byId, element } from "./dom";
import type { SaidLine } from "./person";

const KEPT_LINES = 80;
/** The number of lines of one person that can be chosen for a report. */
const OFFERED_LINES = 5;

export class ChatPanel {
  private readonly panel = byId("chat", HTMLElement);
  private readonly log = byId("chat-log", HTMLElement);
  private readonly form = byId("chat-form", HTMLFormElement);
  private readonly line = byId("chat-line", HTMLInputElement);
  private readonly toggle = byId("chat-toggle", HTMLButtonElement);

  constructor(say: (text: string) => boolean) {
    this.line.maxLength = MAX_CHAT_CHARS;
    this.form.addEventListener("submit", (event) => {
      event.preventDefault();
      const text = this.line.value.trim();
      if (text !== "" && !say(text)) {
        this.note("Not sent: there is no connection at the moment.");
        return;
      }
      this.line.value = "";
      if (text === "") this.leave();
    });
    this.line.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.leave();
    });
    this.toggle.addEventListener("click", () => {
      if (this.panel.classList.contains("open")) this.leave();
      else this.enter();
    });
    window.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" || event.defaultPrevented) return;
      if (document.activeElement && document.activeElement !== document.body) return;
      event.preventDefault();
      this.enter();
    });
  }

  said({ id, name, text, line }: ChatMessage, own: boolean): void {
    const who = element("b", own ? { class: "own" } : {}, name);
    const words = element("span", {}, text);
    this.add(element("li", { "data-line": String(line), "data-id": String(id) }, who, " ", words));
    if (!this.panel.classList.contains("open")) this.toggle.classList.add("unread");
  }

  /** Show lines no more. */
  hide(lines: readonly number[]): void {
    for (const line of lines) this.log.querySelector(`[data-line="${line}"]`)?.remove();
  }

  /** The last lines of somebody, the newest first. */
  linesOf(id: number): SaidLine[] {
    const items = [...this.log.querySelectorAll<HTMLElement>(`[data-id="${id}"]`)];
    return items
      .slice(-OFFERED_LINES)
      .reverse()
      .map((item) => ({
        line: Number(item.dataset["line"]),
        text: item.querySelector("span")?.textContent ?? "",
      }));
  }

  /** A line from the server or from this page itself. */
  note(text: string): void {
    this.add(element("li", { class: "note" }, text));
  }

  private enter(): void {
    this.panel.classList.add("open");
    this.toggle.classList.remove("unread");
    this.toggle.setAttribute("aria-expanded", "true");
    this.line.focus();
  }

  private leave(): void {
    this.panel.classList.remove("open");
    this.toggle.setAttribute("aria-expanded", "false");
    this.line.blur();
  }

  private add(item: HTMLElement): void {
    this.log.append(item);
    while (this.log.childElementCount > KEPT_LINES) this.log.firstElementChild?.remove();
    this.log.scrollTop = this.log.scrollHeight;
  }
}
