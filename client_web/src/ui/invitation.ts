/** The question whether to walk to the place that a link names. */

import { byId } from "./dom";

export class Invitation {
  private readonly bar = byId("invitation", HTMLElement);

  constructor(accept: () => void) {
    byId("invitation-go", HTMLButtonElement).addEventListener("click", () => {
      this.close();
      accept();
    });
    byId("invitation-stay", HTMLButtonElement).addEventListener("click", () => {
      this.close();
    });
  }

  open(): void {
    this.bar.hidden = false;
  }

  private close(): void {
    this.bar.hidden = true;
  }
}
