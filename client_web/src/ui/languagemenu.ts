/** The menus of languages, at the door and under Help; the choice is kept in the browser. */

import { LANGUAGES, languageFor, type LanguageTag, TAGS } from "../language/languages";
import { onLanguage, speak, spoken } from "../language/words";
import { byId, element } from "./dom";

const LANGUAGE_KEY = "esplanade.language";

/** The language that this person has chosen, else one that their browser says they read. */
export function preferredLanguage(): LanguageTag {
  return languageFor(localStorage.getItem(LANGUAGE_KEY), navigator.languages);
}

export function setUpLanguageMenus(): void {
  const menus = ["join-language", "help-language"].map((id) => byId(id, HTMLSelectElement));
  const show = (): void => {
    for (const menu of menus) menu.value = spoken;
  };
  for (const menu of menus) {
    const options = TAGS.map((tag) => {
      const { name, locale } = LANGUAGES[tag];
      return element("option", { value: tag, lang: locale }, name);
    });
    menu.replaceChildren(...options);
    menu.addEventListener("change", () => {
      const chosen = languageFor(menu.value, []);
      localStorage.setItem(LANGUAGE_KEY, chosen);
      void speak(chosen).then(show);
    });
  }
  onLanguage(show);
  show();
}
