/** Facts that a change has touched, in words: `{"world": {"risk_weight": 12}}`. */

import { shown } from "./fields";
import { scopeName, shortId } from "./scopes";

export type Facts = Readonly<Record<string, Readonly<Record<string, unknown>>>>;

export interface Touched {
  readonly subject: string;
  readonly field: string;
  readonly before: unknown;
  readonly after: unknown;
}

export function touched(before: Facts | null, after: Facts | null): Touched[] {
  return Object.entries(after ?? {}).flatMap(([subject, fields]) =>
    Object.entries(fields).map(([field, value]) => ({
      subject,
      field,
      before: before?.[subject]?.[field],
      after: value,
    })),
  );
}

export function subjectName(subject: string): string {
  if (subject.startsWith("door:")) return `door ${subject.slice("door:".length)}`;
  if (subject.startsWith("person:")) return `person ${subject.slice("person:".length)}`;
  if (/^(world$|group:|actor:)/.test(subject)) return scopeName(subject);
  return subject;
}

/** A value of a fact in a few words. */
export function factText(value: unknown): string {
  if (value === null || value === undefined) return "not set";
  if (typeof value === "number") return shown(value);
  if (typeof value === "string") return value;
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (Array.isArray(value)) return value.map(factText).join(", ");
  const { kind, ...rest } = value as Record<string, unknown>;
  const others = Object.entries(rest).map(([name, one]) => `${name} ${factText(one)}`);
  return [typeof kind === "string" ? kind : "", ...others].filter(Boolean).join(" ");
}

/** A change in one line: `risk_weight 9.5 → 12, world`. */
export function summary(before: Facts | null, after: Facts | null, most = 3): string {
  const all = touched(before, after);
  const first = all
    .slice(0, most)
    .map((one) => `${one.field} ${factText(one.before)} → ${factText(one.after)}`);
  const subjects = [...new Set(all.map((one) => subjectName(one.subject)))];
  const more = all.length > most ? [`and ${all.length - most} more`] : [];
  const who = subjects.length > 2 ? `${subjects.length} subjects` : subjects.join(", ");
  return all.length === 0 ? "" : `${[...first, ...more].join(", ")} (${who})`;
}

export { shortId };
