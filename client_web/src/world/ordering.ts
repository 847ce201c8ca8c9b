/** The order of names as people expect it: `Actor 2` before `Actor 10`. */

// One for all: an order that is made for each comparison takes twenty times as long.
const collator = new Intl.Collator(undefined, { numeric: true });

export function byName(a: string, b: string): number {
  return collator.compare(a, b);
}
