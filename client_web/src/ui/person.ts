/** The panel of another person: hear them no more, or report them to those who look after the place. */

import { MAX_CHAT_CHARS } from "../net/codes";
import { byId, element } from "./dom";

export interface SaidLine {
  line: number;
  text: string;
}

export interface PersonWishes {
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
  private readonly mute = byId("person-mute", HTMLButtonElement);
  private readonly form = byId("person-form", HTMLFormElement);
  private readonly why = byId("person-why", HTMLSelectElement);
  private readonly line = byId("person-line", HTMLSelectElement);
  private readonly text = byId("person-text", HTMLInputElement);
  private readonly state = byId("person-state", HTMLElement);
  private shown: { id: number; name: string } | null = null;
  private opener: Element | null = null;

  constructor(private readonly wishes: PersonWishes) {
    byId("person-close", HTMLButtonElement).addEventListener("click", () => {
      this.close();
    });
    this.panel.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.close();
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

  open(id: number, name: string): void {
    this.opener = document.activeElement;
    this.shown = { id, name };
    this.name.textContent = name;
    this.text.value = "";
    this.text.maxLength = MAX_CHAT_CHARS - this.longestWhy() - 2;
    this.state.textContent = "";
    const lines = this.wishes.linesOf(id);
    const options = lines.map(({ line, text }) =>
      element("option", { value: String(line) }, shortened(text)),
    );
    this.line.replaceChildren(element("option", { value: "" }, "none of their lines"), ...options);
    byId("person-line-label", HTMLElement).hidden = this.line.hidden = lines.length === 0;
    this.update();
    this.panel.hidden = false;
    this.mute.focus();
  }

  /** The server has taken a report, or says why not. */
  tell(text: string): void {
    if (!this.panel.hidden) this.state.textContent = text;
  }

  private close(): void {
    this.panel.hidden = true;
    this.shown = null;
    if (this.opener instanceof HTMLElement && this.opener.isConnected) this.opener.focus();
  }

  private update(): void {
    const muted = this.shown !== null && this.wishes.isMuted(this.shown.name);
    this.mute.textContent = muted ? "Hear them again" : "Mute for me";
    this.mute.setAttribute("aria-pressed", String(muted));
  }

  private send(): void {
    if (!this.shown) return;
    const more = this.text.value.trim();
    const text = more === "" ? this.why.value : `${this.why.value}: ${more}`;
    const line = this.line.value === "" ? null : Number(this.line.value);
    const sent = this.wishes.report(this.shown.id, line, text);
    this.state.textContent = sent ? "Sending…" : "Not sent: there is no connection at the moment.";
    if (sent) this.text.value = "";
  }

  private longestWhy(): number {
    return Math.max(...[...this.why.options].map(({ value }) => value.length));
  }
}

function shortened(text: string): string {
  return text.length > SHOWN_CHARS ? `${text.slice(0, SHOWN_CHARS)}…` : text;
}
