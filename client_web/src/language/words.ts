/** The words in the language that the page speaks now. */

import { type Catalogue, english } from "./english";
import { LANGUAGES, type LanguageTag } from "./languages";

/** It is another one after each `speak`: read it where the words are needed. */
export let words: Catalogue = english;
export let spoken: LanguageTag = "en";

const listeners: (() => void)[] = [];

/** Speak a language from now on; where its words cannot be fetched, the page goes on as it is. */
export async function speak(tag: LanguageTag): Promise<void> {
  const fetched = await LANGUAGES[tag].words().catch(() => null);
  if (fetched === null) return;
  [words, spoken] = [fetched, tag];
  for (const listener of listeners) listener();
}

/** Be called after each change of the language. */
export function onLanguage(listener: () => void): void {
  listeners.push(listener);
}
