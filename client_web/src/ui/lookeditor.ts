/** The editor of a look: a row of choices for each part, and the stature. */

import { words } from "../language/words";
import type { Look } from "../net/messages";
import { byId, element } from "./dom";
import { write, writeAttribute } from "./writing";

/** A part of a look that is chosen among a few: what it is called, and what there is. */
export interface LookPart {
  readonly title: () => string;
  /** Each with its colour; null where the name alone says what it is. */
  readonly choices: readonly (readonly [name: () => string, colour: string | null])[];
}

export class LookEditor {
  /** Where the figure is drawn. */
  readonly figure = byId("look-figure", HTMLElement);
  private readonly editor = byId("look-editor", HTMLElement);
  private readonly stature = byId("look-stature", HTMLInputElement);
  private readonly said = byId("look-stature-said", HTMLOutputElement);
  private readonly groups: readonly HTMLInputElement[][];

  /** Parts are in the order of a look; `changed` is called with each new look. */
  constructor(
    parts: readonly LookPart[],
    [shortestCm, tallestCm]: readonly [number, number],
    private readonly changed: (look: Look) => void,
    surprise: () => void,
  ) {
    this.stature.min = String(shortestCm);
    this.stature.max = String(tallestCm);
    this.groups = parts.map((part, i) => this.group(part, `look-part-${i}`));
    this.editor.addEventListener("input", () => {
      this.tell();
    });
    byId("look-surprise", HTMLButtonElement).addEventListener("click", surprise);
  }

  /** Stand in that part of the page from now on. */
  moveTo(host: HTMLElement): void {
    host.append(this.editor);
  }

  /** Show a look whose every part is chosen. */
  show(look: Look): void {
    this.groups.forEach((radios, i) => {
      const radio = radios[(look[i] ?? 1) - 1];
      if (radio) radio.checked = true;
    });
    this.stature.value = String(look[5]);
    this.say();
  }

  private tell(): void {
    this.say();
    const [shirt = 1, trousers = 1, hair = 1, hairColour = 1, skin = 1] = this.groups.map(
      (radios) => radios.findIndex((radio) => radio.checked) + 1,
    );
    this.changed([shirt, trousers, hair, hairColour, skin, Number(this.stature.value)]);
  }

  private say(): void {
    write(this.said, () => words.look.centimetres(Number(this.stature.value)));
  }

  private group({ title, choices }: LookPart, name: string): HTMLInputElement[] {
    const legend = element("legend");
    write(legend, title);
    const set = element("fieldset", {}, legend);
    const radios = choices.map(([choice, colour], i) => {
      const radio = element("input", { type: "radio", name, value: String(i + 1) });
      const label = element("label", {}, radio);
      writeAttribute(label, "title", choice);
      if (colour === null) {
        const word = element("span", { class: "word" });
        write(word, choice);
        label.append(word);
      } else {
        writeAttribute(radio, "aria-label", choice);
        const swatch = element("span", { class: "swatch" });
        // The page's security policy forbids styles in attributes, and allows this.
        swatch.style.backgroundColor = colour;
        label.append(swatch);
      }
      set.append(label);
      return radio;
    });
    byId("look-parts", HTMLElement).append(set);
    return radios;
  }
}
