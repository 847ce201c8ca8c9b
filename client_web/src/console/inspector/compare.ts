/** Parameters of several actors beside each other. */

import type { Source } from "../net/types";

export interface Compared {
  name: string;
  values: readonly (Source | undefined)[];
  differs: boolean;
}

/** Rows for all parameters, those that differ first. */
export function compare(actors: readonly Readonly<Record<string, Source>>[]): Compared[] {
  const names = [...new Set(actors.flatMap((parameters) => Object.keys(parameters)))];
  const rows = names.map((name) => {
    const values = actors.map((parameters) => parameters[name]);
    const texts = new Set(values.map((source) => JSON.stringify(source?.value)));
    return { name, values, differs: texts.size > 1 };
  });
  return rows.sort((a, b) => Number(b.differs) - Number(a.differs));
}

/** Where a value comes from. */
export function sourceText({ level, group }: Source): string {
  return level === "group" && group !== null ? `group ${group}` : level;
}

export function valueText(value: unknown): string {
  if (typeof value === "number") return String(Math.round(value * 1000) / 1000);
  if (typeof value === "string") return value;
  if (typeof value === "boolean") return value ? "yes" : "no";
  return value === undefined ? "–" : JSON.stringify(value);
}
