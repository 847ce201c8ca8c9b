/** Lengths of what people write, counted as the server counts them. */

/** The complaint about a text of more than `most` characters; null if it is no longer than that. */
export function tooLong(text: string, most: number): string | null {
  const over = Array.from(text).length - most;
  if (over <= 0) return null;
  return `That is ${over} ${over === 1 ? "character" : "characters"} too long; ${most} are the most.`;
}
