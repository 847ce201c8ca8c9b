/** A phrase is text for people, with the names and keys in it set apart. */

/** A name keeps the direction of its own script, and a key looks like one. */
export interface Apart {
  readonly tag: "bdi" | "kbd";
  readonly text: string;
}
export type Part = string | Apart;
export type Phrase = readonly Part[];
export type Wording = string | Phrase;

const FIRST_STRONG_ISOLATE = "\u2068";
const POP_ISOLATE = "\u2069";

export function partsOf(wording: Wording): Phrase {
  return typeof wording === "string" ? [wording] : wording;
}

/** A name, or what somebody has written: it turns no sentence over. */
export function name(text: string): Apart {
  return { tag: "bdi", text };
}

export function key(text: string): Apart {
  return { tag: "kbd", text };
}

/** The bare letters, as an element that holds the wording has them. */
export function plain(wording: Wording): string {
  return partsOf(wording)
    .map((part) => (typeof part === "string" ? part : part.text))
    .join("");
}

/** The wording where there are no elements: names stand between marks that isolate them. */
export function isolated(wording: Wording): string {
  return partsOf(wording)
    .map((part) => {
      if (typeof part === "string") return part;
      return part.tag === "bdi" ? FIRST_STRONG_ISOLATE + part.text + POP_ISOLATE : part.text;
    })
    .join("");
}
