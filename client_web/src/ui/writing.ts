/** Writes words into the page, and writes them anew when the language changes. */

import { LANGUAGES } from "../language/languages";
import { isolated, partsOf, plain, type Wording } from "../language/phrase";
import { onLanguage, spoken, words } from "../language/words";
import { element } from "./dom";

type Source = () => Wording;

/** The attributes of an element that hold words, and its text under the name of none. */
const TEXT = "";
const sources = new WeakMap<Element, Map<string, Source>>();

/** The attributes of the page's own HTML that name a wording, and what each is written to. */
const NAMING = {
  "data-words": TEXT,
  "data-label": "aria-label",
  "data-hint": "placeholder",
  "data-title": "title",
};

/** Fill an element with a wording: names in it stand apart, so that they turn nothing over. */
export function write(target: Element, source: Source): void {
  remember(target, TEXT, source);
}

/** Give an element an attribute that is read by people, such as a label. */
export function writeAttribute(target: Element, attribute: string, source: Source): void {
  remember(target, attribute, source);
}

/** A wording as the children of an element. */
export function nodesOf(wording: Wording): (Node | string)[] {
  return partsOf(wording).map((part) =>
    typeof part === "string" ? part : element(part.tag, {}, part.text),
  );
}

/** Write all words that the page's HTML names, now and whenever the language changes. */
export function writePage(): void {
  for (const [naming, attribute] of Object.entries(NAMING)) {
    for (const target of document.querySelectorAll(`[${naming}]`)) {
      const path = target.getAttribute(naming) ?? "";
      remember(target, attribute, () => wordingAt(path));
    }
  }
  mark();
  onLanguage(() => {
    mark();
    for (const target of document.querySelectorAll("*")) {
      sources.get(target)?.forEach((source, attribute) => {
        draw(target, attribute, source());
      });
    }
  });
}

/** The wording of the catalogue at a path such as `door.name`. */
function wordingAt(path: string): Wording {
  const found = path
    .split(".")
    .reduce<unknown>((at, step) => (at as Record<string, unknown> | undefined)?.[step], words);
  if (typeof found !== "string" && !Array.isArray(found)) throw new Error(`no words ${path}`);
  return found as Wording;
}

function mark(): void {
  const { locale, direction } = LANGUAGES[spoken];
  document.documentElement.lang = locale;
  document.documentElement.dir = direction;
}

function remember(target: Element, attribute: string, source: Source): void {
  const known = sources.get(target) ?? new Map<string, Source>();
  sources.set(target, known.set(attribute, source));
  draw(target, attribute, source());
}

/** Nothing is written twice, so that screen readers do not say the same again. */
function draw(target: Element, attribute: string, wording: Wording): void {
  if (attribute !== TEXT) target.setAttribute(attribute, isolated(wording));
  else if (target.textContent !== plain(wording)) target.replaceChildren(...nodesOf(wording));
}
