/** The last ten minutes of an actor: what it did and why, and who or what held it for how long. */

import type { Blocker, Moment, WhySpan } from "../net/types";
import { reasonText } from "../state/reasons";

export const SHOWN_S = 600;
const BRIEF_S = 0.3;
/** Reasons for which an actor is held up. */
const HELD: ReadonlySet<string> = new Set(["giving_way", "waiting", "replanning", "no_path"]);

/** A part of the band, as parts of its whole length from the left. */
export interface Piece {
  from: number;
  length: number;
  span: WhySpan;
}

/** The pieces of the band that ends now, at `tick`. */
export function piecesOf(spans: readonly WhySpan[], tick: number, tickS: number): Piece[] {
  const ticks = SHOWN_S / tickS;
  const begin = tick - ticks;
  return spans
    .map((span) => ({
      from: Math.max(0, (span.from_tick - begin) / ticks),
      to: Math.min(1, (span.to_tick - begin) / ticks),
      span,
    }))
    .filter(({ from, to }) => to > from)
    .map(({ from, to, span }) => ({ from, length: to - from, span }));
}

/** When a tick was, microseconds since 1970: in a pause no time of the world passes. */
export function momentOf(moments: readonly Moment[], tick: number): number | null {
  const after = moments.findIndex(([each]) => each > tick);
  const before = moments[after < 0 ? moments.length - 1 : Math.max(0, after - 1)];
  if (!before) return null;
  const next = moments[after];
  if (!next || tick < before[0]) return before[1];
  return before[1] + ((next[1] - before[1]) * (tick - before[0])) / (next[0] - before[0]);
}

/**
 * The spans in which something held the actor, the newest first. Those that are over before the
 * server asks who it was are left out: most are, in a crowd.
 */
export function stopsOf(spans: readonly WhySpan[], most: number): WhySpan[] {
  return spans
    .filter(({ reason, seconds }) => HELD.has(reason) && seconds > BRIEF_S)
    .slice(-most)
    .reverse();
}

/** The name of the blocker, and how far away it is. */
export function blockerText({ kind, id, name, away_m }: Blocker): string {
  const who = name ?? (id === null ? "" : String(id));
  const what = kind === "actor" || kind === "person" ? who || kind : `${kind} ${who}`.trim();
  return Number.isFinite(away_m) ? `${what}, ${away_m.toFixed(1)} m away` : what;
}

const OUTCOMES: Readonly<Partial<Record<string, string>>> = {
  near: "as near to its goal as it gets",
  blocked: "given up, the way is blocked",
  no_way: "given up, no way leads there",
};

/** How a trip ended that did not end at its goal, and for whom; null for any other. */
export function outcomeText(
  outcome: string | null | undefined,
  inTheWay: Blocker | null | undefined,
): string | null {
  const text = OUTCOMES[outcome ?? ""];
  if (text === undefined) return null;
  return inTheWay ? `${text}: ${blockerText(inTheWay)}` : text;
}

export function spanText({ reason, blocker, seconds }: WhySpan): string {
  const held = blocker ? `, ${blockerText(blocker)}` : "";
  return `${reasonText(reason)} for ${secondsText(seconds)}${held}`;
}

export function secondsText(seconds: number): string {
  if (seconds < 59.5) return `${seconds < 10 ? seconds.toFixed(1) : Math.round(seconds)} s`;
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 60)} min ${whole % 60} s`;
}

/** Seconds for each reason in the spans, the most first. */
export function shares(spans: readonly WhySpan[]): readonly (readonly [string, number])[] {
  const sums = new Map<string, number>();
  for (const { reason, seconds } of spans) sums.set(reason, (sums.get(reason) ?? 0) + seconds);
  return [...sums].sort((a, b) => b[1] - a[1]);
}
