/** The card of another person: find, follow and greet them, mute or report them. */

import { name as named, type Wording } from "../language/phrase";
import { words } from "../language/words";
import { MAX_CHAT_CHARS } from "../net/codes";
import { byId, element } from "./dom";
import { Panel } from "./panels";
import { write } from "./writing";

export interface SaidLine {
  line: number;
  text: string;
}

export interface PersonWishes {
  find(id: number): void;
  /** Walk after somebody, or after nobody any more. */
  follow(id: number | null): void;
  wave(id: number): void;
  /** Share a link to somebody. */
  share(name: string): void;
  mute(id: number, name: string, muted: boolean): void;
  /** False if there is no connection. */
  report(id: number, line: number | null, text: string): boolean;
  linesOf(id: number): SaidLine[];
  isMuted(name: string): boolean;
}

const SHOWN_CHARS = 40;

export class PersonPanel {
  private readonly panel = byId("person", HTMLElement);
  private readonly name = byId("person-name", HTMLElement);
  private readonly where = byId("person-where", HTMLElement);
  private readonly follow = byId("person-follow", HTMLButtonElement);
  private readonly mute = byId("person-mute", HTMLButtonElement);
  private readonly form = byId("person-form", HTMLFormElement);
  private readonly report = byId("person-report", HTMLDetailsElement);
  private readonly why = byId("person-why", HTMLSelectElement);
  private readonly line = byId("person-line", HTMLSelectElement);
  private readonly text = byId("person-text", HTMLInputElement);
  private readonly state = byId("person-state", HTMLElement);
  private shown: { id: number; name: string } | null = null;
  private opener: Element | null = null;

  constructor(private readonly wishes: PersonWishes) {
    Panel.alsoClose(() => {
      this.close();
    });
    byId("person-close", HTMLButtonElement).addEventListener("click", () => {
      this.close();
    });
    this.panel.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.close();
    });
    byId("person-find", HTMLButtonElement).addEventListener("click", () => {
      if (this.shown) wishes.find(this.shown.id);
    });
    byId("person-wave", HTMLButtonElement).addEventListener("click", () => {
      if (this.shown) wishes.wave(this.shown.id);
    });
    byId("person-share", HTMLButtonElement).addEventListener("click", () => {
      if (this.shown) wishes.share(this.shown.name);
    });
    this.follow.addEventListener("click", () => {
      const follows = this.follow.getAttribute("aria-pressed") === "true";
      if (this.shown) wishes.follow(follows ? null : this.shown.id);
    });
    this.mute.addEventListener("click", () => {
      if (!this.shown) return;
      const { id, name } = this.shown;
      wishes.mute(id, name, !wishes.isMuted(name));
      this.update();
    });
    this.form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.send();
    });
  }

  /** The one whose card is open; null for nobody. */
  get id(): number | null {
    return this.shown?.id ?? null;
  }

  /** Say where somebody is, in words, and whether they are followed. */
  show(where: () => Wording, followed: boolean): void {
    write(this.where, where);
    this.follow.setAttribute("aria-pressed", String(followed));
  }

  open(id: number, name: string): void {
    Panel.makeRoom();
    this.opener = document.activeElement;
    this.shown = { id, name };
    write(this.name, () => [named(name)]);
    this.text.value = "";
    this.text.maxLength = MAX_CHAT_CHARS - this.longestWhy() - 2;
    this.tell(() => "");
    this.report.open = false;
    const lines = this.wishes.linesOf(id);
    const options = lines.map(({ line, text }) =>
      element("option", { value: String(line), dir: "auto" }, shortened(text)),
    );
    const none = element("option", { value: "" });
    write(none, () => words.card.noLine);
    this.line.replaceChildren(none, ...options);
    byId("person-line-label", HTMLElement).hidden = this.line.hidden = lines.length === 0;
    this.update();
    this.panel.hidden = false;
    this.follow.focus();
  }

  /** The server has taken a report, or says why not. */
  tell(wording: () => Wording): void {
    write(this.state, wording);
  }

  close(): void {
    this.panel.hidden = true;
    this.shown = null;
    if (this.opener instanceof HTMLElement && this.opener.isConnected) this.opener.focus();
  }

  private update(): void {
    const muted = this.shown !== null && this.wishes.isMuted(this.shown.name);
    write(this.mute, () => (muted ? words.card.unmute : words.card.mute));
    this.mute.setAttribute("aria-pressed", String(muted));
  }

  private send(): void {
    if (!this.shown) return;
    const more = this.text.value.trim();
    const text = more === "" ? this.why.value : `${this.why.value}: ${more}`;
    const line = this.line.value === "" ? null : Number(this.line.value);
    const sent = this.wishes.report(this.shown.id, line, text);
    this.tell(() => (sent ? words.card.sending : words.noConnection));
    if (sent) this.text.value = "";
  }

  private longestWhy(): number {
    return Math.max(...[...this.why.options].map(({ value }) => value.length));
  }
}

function shortened(text: string): string {
  return text.length > SHOWN_CHARS ? `${text.slice(0, SHOWN_CHARS)}…` : text;
}
