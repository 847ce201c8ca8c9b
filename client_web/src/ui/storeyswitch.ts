/** The choice of the storey on the map: the own avatar's, or for a while another one. */

import { words } from "../language/words";
import { byId, element } from "./dom";
import { write, writeAttribute } from "./writing";

export class StoreySwitch {
  /** Counted from the ground, 0. */
  shown = 0;
  private own = 0;
  private readonly row = byId("storeys", HTMLElement);
  private buttons: HTMLButtonElement[] = [];

  constructor(private readonly changed: () => void) {}

  /** Offer the storeys of a new world; one alone needs no switch. */
  offer(count: number): void {
    this.own = this.shown = 0;
    this.buttons = Array.from({ length: count }, (_, storey) => this.button(storey));
    this.row.replaceChildren(...this.buttons);
    this.row.hidden = count < 2;
    document.body.classList.toggle("storeys", count > 1);
    this.press();
  }

  /** The own avatar is on this storey; when it comes to another, the map goes with it. */
  follow(storey: number): void {
    if (storey === this.own) return;
    this.own = storey;
    this.choose(storey);
  }

  private choose(storey: number): void {
    this.shown = storey;
    this.press();
    this.changed();
  }

  private button(storey: number): HTMLButtonElement {
    const button = element("button", { type: "button" });
    write(button, () => words.map.sign(storey));
    for (const attribute of ["aria-label", "title"]) {
      writeAttribute(button, attribute, () => words.map.floor(storey));
    }
    button.addEventListener("click", () => {
      this.choose(storey);
    });
    return button;
  }

  private press(): void {
    this.buttons.forEach((button, storey) => {
      button.setAttribute("aria-pressed", String(storey === this.shown));
      button.classList.toggle("here", storey === this.own);
    });
  }
}
