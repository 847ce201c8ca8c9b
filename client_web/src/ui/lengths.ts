/** Lengths of what people write, counted as the server counts them. */

import type { Wording } from "../language/phrase";
import { words } from "../language/words";

/** The complaint about a text of more than `most` characters; null if it is no longer than that. */
export function tooLong(text: string, most: number): Wording | null {
  const over = Array.from(text).length - most;
  if (over <= 0) return null;
  return words.tooLong(over, most);
}
