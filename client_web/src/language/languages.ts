/** The languages of the page, and which of them a person gets. */

import { type Catalogue, english } from "./english";

interface Language {
  /** Its own name for itself. */
  readonly name: string;
  /** The value of `lang` in the page. */
  readonly locale: string;
  readonly direction: "ltr" | "rtl";
  /** Fetch its words; those of English are always there. */
  readonly words: () => Promise<Catalogue>;
}

export const LANGUAGES = {
  en: {
    name: "English",
    locale: "en",
    direction: "ltr",
    words: () => Promise.resolve(english),
  },
  de: {
    name: "Deutsch",
    locale: "de",
    direction: "ltr",
    words: async () => (await import("./german")).german,
  },
  "zh-Hant": {
    name: "繁體中文",
    locale: "zh-Hant-TW",
    direction: "ltr",
    words: async () => (await import("./chinese")).chinese,
  },
} as const satisfies Record<string, Language>;

export type LanguageTag = keyof typeof LANGUAGES;

export const TAGS = Object.keys(LANGUAGES) as LanguageTag[];

/** The language that was kept, else the first that the person reads and the page has, else English. */
export function languageFor(kept: string | null, read: readonly string[]): LanguageTag {
  const chosen = TAGS.find((tag) => tag === kept);
  if (chosen) return chosen;
  for (const each of read) {
    const known = TAGS.find((tag) => isSame(tag, each));
    if (known) return known;
  }
  return "en";
}

/** Whether two tags are of one language in one script, as `zh-HK` and `zh-Hant` are. */
function isSame(tag: string, other: string): boolean {
  try {
    const [one, two] = [tag, other].map((each) => new Intl.Locale(each).maximize());
    return one?.language === two?.language && one?.script === two?.script;
  } catch {
    return false;
  }
}
