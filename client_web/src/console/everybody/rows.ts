/** The rows of the list of everybody: whom it shows, and in which order. */

import { byName } from "../../world/ordering";
import type { Avatar } from "../map/avatars";
import { reasonName, reasonText } from "../state/reasons";

export interface Row {
  key: string;
  name: string;
  kind: "actor" | "person";
  /** The behaviour of an actor, or the groups that it is in. */
  detail: string;
  reason: number;
}

/** Actors before people, each by name; all words of `wanted` must be somewhere in a row. */
export function rowsOf(avatars: Iterable<Avatar>, wanted: string): Row[] {
  const words = wanted.toLowerCase().split(/\s+/).filter(Boolean);
  const rows: Row[] = [];
  for (const { key, name, kind, groups, behaviour, reason } of avatars) {
    const detail = kind === "actor" ? reasonText(reasonName(reason)) : "";
    const text = [key, name, kind, behaviour, detail, ...groups].join(" ").toLowerCase();
    if (words.every((word) => text.includes(word))) rows.push({ key, name, kind, detail, reason });
  }
  return rows.sort(
    (a, b) =>
      (a.kind === b.kind ? 0 : a.kind < b.kind ? -1 : 1) ||
      byName(a.name, b.name) ||
      byName(a.key, b.key),
  );
}

/** The rows that a window of a list has to hold, with some above and below. */
export function windowOf(
  count: number,
  rowPx: number,
  scrolledPx: number,
  heightPx: number,
  spare = 6,
): { from: number; to: number } {
  const from = Math.max(0, Math.floor(scrolledPx / rowPx) - spare);
  const to = Math.min(count, Math.ceil((scrolledPx + heightPx) / rowPx) + spare);
  return { from: Math.min(from, to), to };
}

/** The choice after a row is chosen with keys held: Shift a range, Ctrl one more or less. */
export function choiceAfter(
  rows: readonly Pick<Row, "key">[],
  chosen: readonly string[],
  key: string,
  held: { shift: boolean; ctrl: boolean },
): string[] {
  if (held.shift && chosen.length > 0) {
    const at = rows.findIndex((row) => row.key === key);
    const anchor = rows.findIndex((row) => row.key === chosen[0]);
    if (anchor >= 0) {
      const range = rows
        .slice(Math.min(at, anchor), Math.max(at, anchor) + 1)
        .map((row) => row.key);
      // The first one stays the one that is inspected.
      return anchor <= at ? range : range.reverse();
    }
  }
  if (!held.ctrl) return [key];
  return chosen.includes(key) ? chosen.filter((other) => other !== key) : [...chosen, key];
}
