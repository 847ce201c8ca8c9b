/** The link that is shared: it is copied where the browser allows that, and shown in any case. */

import { words } from "../language/words";
import { byId } from "./dom";
import { write } from "./writing";

export class ShareBar {
  private readonly bar = byId("shared", HTMLElement);
  private readonly text = byId("shared-text", HTMLElement);
  private readonly link = byId("shared-link", HTMLInputElement);

  constructor() {
    byId("shared-close", HTMLButtonElement).addEventListener("click", () => {
      this.bar.hidden = true;
    });
  }

  async show(link: string): Promise<void> {
    this.link.value = link;
    this.bar.hidden = false;
    this.link.focus();
    this.link.select();
    // Pages that came over plain HTTP from another machine have no clipboard.
    const { clipboard } = navigator as Partial<Navigator>;
    const copied = await clipboard?.writeText(link).then(
      () => true,
      () => false,
    );
    write(this.text, () => (copied === true ? words.links.copied : words.links.copy));
  }
}
