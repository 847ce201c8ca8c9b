/** The menu of gestures, and the captions that tell in words what gestures show. */

import { words } from "../language/words";
import type { GestureName } from "../net/messages";
import { byId, element } from "./dom";
import { Panel } from "./panels";
import { write } from "./writing";

export class GestureMenu {
  private readonly toggle = byId("gestures-toggle", HTMLButtonElement);
  private readonly menu = byId("gestures", HTMLElement);
  private readonly captions = byId("captions", HTMLElement);
  private readonly panel = new Panel(this.toggle, this.menu);

  /** `make` is called with the number of the gesture that is chosen. */
  constructor(gestures: ReadonlyMap<number, GestureName>, make: (gesture: number) => void) {
    for (const [number, name] of gestures) {
      const label = element("span");
      write(label, () => words.gestures.names[name]);
      const digit = element("kbd", { "aria-hidden": "true" }, String(number));
      const button = element("button", { type: "button" }, digit, " ", label);
      button.addEventListener("click", () => {
        make(number);
      });
      this.menu.lastElementChild?.before(button);
    }
  }

  /** Offer gestures, or hide them where the server knows none. */
  offer(known: boolean): void {
    this.toggle.hidden = !known;
    if (!known) this.panel.open = false;
  }

  /** Open the menu by a key, with its first gesture under the next one; or close it. */
  flip(): void {
    if (this.toggle.hidden) return;
    this.panel.open = !this.panel.open;
    if (this.panel.open) this.menu.querySelector("button")?.focus();
  }

  /** Tell those who do not see it that somebody makes a gesture; returns the words for a label. */
  tell(name: string, own: boolean, gesture: GestureName): string {
    const { labels, they, you } = words.gestures;
    // The same words again are said again.
    this.captions.replaceChildren();
    write(this.captions, () => (own ? you[gesture] : they[gesture](name)));
    return labels[gesture];
  }
}
