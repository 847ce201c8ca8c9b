/** The look of the person at this page: chosen, kept in the browser, and shown while it changes. */

import { isSpoken } from "../net/codec";
import type { Look, Welcome } from "../net/messages";
import { HAIR_COLOURS, HAIRDOS, SHIRTS, SKINS, TROUSERS } from "../render/clothing";
import { words } from "../language/words";
import { Mannequin } from "../render/mannequin";
import { byId } from "../ui/dom";
import { LookEditor } from "../ui/lookeditor";

const LOOK_KEY = "esplanade.look";
/** Statures that can be chosen, and those that chance gives, centimetres. */
const STATURES_CM = [150, 200] as const;
const LIKELY_CM = [158, 186] as const;
/** The greatest number of each part that is chosen among a few. */
const MOST = [SHIRTS, TROUSERS, HAIRDOS, HAIR_COLOURS, SKINS].map((choices) => choices.length);

export class Looks {
  /** The look that the avatar has, or gets when it comes in. */
  look: Look;
  private readonly editor: LookEditor;
  private readonly dialog = byId("look", HTMLDialogElement);
  private readonly atDoor = byId("join-look", HTMLDetailsElement);
  private readonly open = byId("look-open", HTMLButtonElement);
  private mannequin: Mannequin | null = null;
  /** The look that is being tried on. */
  private tried: Look;

  /** `wear` is called with each look that is to be worn in the world. */
  constructor(
    private readonly storage: Storage,
    private readonly calm: boolean,
    /** Whether figures can be drawn at all. */
    private readonly draws: boolean,
    private readonly wear: (look: Look) => void,
  ) {
    const stored = readLook(storage.getItem(LOOK_KEY));
    this.look = this.tried = stored ?? randomLook(Math.random);
    if (!stored) this.keep(this.look);
    const parts = [
      { title: () => words.look.parts.shirt, choices: named(SHIRTS, () => words.look.shirts) },
      {
        title: () => words.look.parts.trousers,
        choices: named(TROUSERS, () => words.look.trousers),
      },
      {
        title: () => words.look.parts.hair,
        choices: named(
          HAIRDOS.map(([name]) => [name, null] as const),
          () => words.look.hairdos,
        ),
      },
      {
        title: () => words.look.parts.hairColour,
        choices: named(HAIR_COLOURS, () => words.look.hairColours),
      },
      { title: () => words.look.parts.skin, choices: named(SKINS, () => words.look.skins) },
    ];
    this.editor = new LookEditor(
      parts,
      STATURES_CM,
      (look) => {
        this.tryOn(look);
      },
      () => {
        this.tryOn(randomLook(Math.random));
      },
    );
    this.editor.figure.hidden = !draws;
    this.editor.show(this.look);
    this.atDoor.addEventListener("toggle", () => {
      if (this.atDoor.open) this.begin(this.atDoor);
      else if (!this.dialog.open) this.end();
    });
    this.open.addEventListener("click", () => {
      this.dialog.showModal();
      this.begin(byId("look-place", HTMLElement));
    });
    byId("look-form", HTMLFormElement).addEventListener("submit", () => {
      this.keep(this.tried);
      this.wear(this.look);
    });
    this.dialog.addEventListener("close", () => {
      this.end();
    });
    byId("look-cancel", HTMLButtonElement).addEventListener("click", () => {
      this.dialog.close();
    });
  }

  /** The connection is live. */
  begun({ version }: Welcome): void {
    this.open.hidden = !isSpoken("look", version);
    this.atDoor.open = false;
  }

  /** Take the look that was chosen at the door. */
  choose(): Look {
    if (this.atDoor.open) this.keep(this.tried);
    return this.look;
  }

  private begin(host: HTMLElement): void {
    this.editor.moveTo(host);
    this.end();
    if (this.draws) this.mannequin = new Mannequin(this.editor.figure, this.calm);
    this.tryOn(this.look);
  }

  private end(): void {
    this.mannequin?.dispose();
    this.mannequin = null;
  }

  private tryOn(look: Look): void {
    this.tried = look;
    this.editor.show(look);
    this.mannequin?.wear(look);
  }

  private keep(look: Look): void {
    this.look = look;
    this.storage.setItem(LOOK_KEY, JSON.stringify(look));
  }
}

/** Choices with their names in the language that the page speaks. */
function named<N extends string, T>(
  choices: readonly (readonly [N, T])[],
  names: () => Readonly<Record<N, string>>,
): (readonly [() => string, T])[] {
  return choices.map(([name, looks]) => [() => names()[name], looks] as const);
}

/** The look that was stored; null if it is none whose every part there is. */
export function readLook(text: string | null): Look | null {
  let stored: unknown;
  try {
    stored = JSON.parse(text ?? "null");
  } catch {
    return null;
  }
  if (!Array.isArray(stored) || stored.length !== MOST.length + 1) return null;
  const isWhole = (value: unknown, least: number, most: number): boolean =>
    Number.isInteger(value) && Number(value) >= least && Number(value) <= most;
  const known = MOST.every((most, i) => isWhole(stored[i], 1, most));
  return known && isWhole(stored.at(-1), ...STATURES_CM) ? (stored as unknown as Look) : null;
}

/** A look whose every part is drawn by chance; `random` gives numbers in [0, 1). */
export function randomLook(random: () => number): Look {
  const among = (least: number, most: number): number =>
    least + Math.floor(random() * (most - least + 1));
  const [shirt = 1, trousers = 1, hair = 1, hairColour = 1, skin = 1] = MOST.map((most) =>
    among(1, most),
  );
  return [shirt, trousers, hair, hairColour, skin, among(...LIKELY_CM)];
}
