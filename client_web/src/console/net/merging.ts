/** One subscription for several listeners, which each ask for a part. */

export type Arguments = Readonly<Record<string, unknown>>;

/** The request to a channel that gives every listener at least what it asks for. */
export function merged(asked: readonly Arguments[]): Record<string, unknown> {
  const names = new Set(asked.flatMap((one) => Object.keys(one)));
  const found: Record<string, unknown> = {};
  for (const name of names) {
    const values = asked.map((one) => one[name]);
    if (values.some((value) => typeof value === "number")) {
      found[name] = Math.max(...values.filter((value) => typeof value === "number"));
    } else if (values.some((value) => typeof value === "boolean")) {
      found[name] = values.some((value) => value === true);
    } else if (values.every((value) => Array.isArray(value))) {
      // A list narrows a channel: whoever gives none wants all of it.
      found[name] = [...new Set(values.flat() as unknown[])];
    }
  }
  return found;
}
