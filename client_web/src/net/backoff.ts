/** Waiting times between attempts to connect again. */

const FIRST_MS = 400;
const LONGEST_MS = 4000;

/**
 * Doubles with every failed attempt and is spread over its upper half, so that a crowd of clients
 * does not come back in the same instant.
 */
export function backoffMs(attempt: number, random: () => number): number {
  const full = Math.min(LONGEST_MS, FIRST_MS * 2 ** attempt);
  return full * (0.5 + 0.5 * random());
}
