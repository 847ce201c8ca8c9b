/** The chat: a log, a line to write in, and on small screens a button that opens both. */

import type { Wording } from "../language/phrase";
import { words } from "../language/words";
import { MAX_CHAT_CHARS } from "../net/codes";
import type { ChatMessage } from "../net/messages";
import { byId, element } from "./dom";
import { withLinks } from "./links";
import { tooLong } from "./lengths";
import type { SaidLine } from "./person";
import { nodesOf, write } from "./writing";

const KEPT_LINES = 80;
/** The number of lines of one person that can be chosen for a report. */
const OFFERED_LINES = 5;

export class ChatPanel {
  private readonly panel = byId("chat", HTMLElement);
  private readonly log = byId("chat-log", HTMLElement);
  private readonly lines = byId("chat-lines", HTMLElement);
  private readonly fault = byId("chat-fault", HTMLElement);
  private readonly form = byId("chat-form", HTMLFormElement);
  private readonly line = byId("chat-line", HTMLInputElement);
  private readonly toggle = byId("chat-toggle", HTMLButtonElement);

  constructor(say: (text: string) => boolean) {
    this.line.addEventListener("input", () => {
      this.complain();
    });
    this.form.addEventListener("submit", (event) => {
      event.preventDefault();
      const text = this.line.value.trim();
      if (this.complain()) return;
      if (text !== "" && !say(text)) {
        this.note(words.noConnection);
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
      if (event.key !== "Enter" || event.defaultPrevented || usesEnter(event.target)) return;
      event.preventDefault();
      this.enter();
    });
  }

  said({ id, name, text, line }: ChatMessage, own: boolean): void {
    const who = element("b", { class: own ? "own" : false, dir: "auto" }, name);
    const said = element("span", { dir: "auto" }, ...withLinks(text));
    this.add(element("li", { "data-line": String(line), "data-id": String(id) }, who, " ", said));
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
  note(wording: Wording): void {
    this.add(element("li", { class: "note" }, ...nodesOf(wording)));
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

  /** Say that a line is too long to be sent; returns whether it is. */
  private complain(): boolean {
    const complaint = (): Wording | null => tooLong(this.line.value.trim(), MAX_CHAT_CHARS);
    const isTooLong = complaint() !== null;
    this.fault.hidden = !isTooLong;
    write(this.fault, () => complaint() ?? "");
    return isTooLong;
  }

  private add(item: HTMLElement): void {
    this.lines.append(item);
    while (this.lines.childElementCount > KEPT_LINES) this.lines.firstElementChild?.remove();
    this.log.scrollTop = this.log.scrollHeight;
  }
}

/** Whether the key does something of its own where it is pressed. */
function usesEnter(target: EventTarget | null): boolean {
  if (document.querySelector("dialog[open]")) return true;
  const controls = "a, button, input, select, textarea, summary";
  return target instanceof Element && target.closest(controls) !== null;
}
