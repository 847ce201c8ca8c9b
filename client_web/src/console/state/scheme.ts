/** The colour scheme that the browser asks for, and the page's colours in it, for canvases. */

import { Signal } from "./signal";

const DARK = "(prefers-color-scheme: dark)";

export interface Scheme {
  readonly dark: boolean;
  /** The value of a custom property of the page, such as `ink`. */
  colour(name: string): string;
}

/** The scheme now; another object whenever it changes. */
export function watchScheme(): Signal<Scheme> {
  const asked = matchMedia(DARK);
  const signal = new Signal(readScheme(asked.matches));
  asked.addEventListener("change", () => {
    signal.value = readScheme(asked.matches);
  });
  return signal;
}

function readScheme(dark: boolean): Scheme {
  const style = getComputedStyle(document.documentElement);
  const found = new Map<string, string>();
  return {
    dark,
    colour: (name) => {
      const known = found.get(name);
      if (known !== undefined) return known;
      const value = style.getPropertyValue(`--${name}`).trim() || "#888888";
      found.set(name, value);
      return value;
    },
  };
}
