/** The question whether to go where a link leads: to a place, or after somebody. */

import type { Wording } from "../language/phrase";
import { byId } from "./dom";
import { write } from "./writing";

export class Invitation {
  private readonly bar = byId("invitation", HTMLElement);
  private readonly text = byId("invitation-text", HTMLElement);
  private readonly go = byId("invitation-go", HTMLButtonElement);
  private accept: () => void = () => undefined;

  constructor() {
    this.go.addEventListener("click", () => {
      this.close();
      this.accept();
    });
    byId("invitation-stay", HTMLButtonElement).addEventListener("click", () => {
      this.close();
    });
  }

  /** Ask; `go` names what `accept` does. */
  open(text: () => Wording, go: () => Wording, accept: () => void): void {
    write(this.text, text);
    write(this.go, go);
    this.accept = accept;
    this.bar.hidden = false;
  }

  close(): void {
    this.bar.hidden = true;
  }
}
