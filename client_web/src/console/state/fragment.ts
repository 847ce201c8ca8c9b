/**
 * The state of the page in its address, so that a link shows the same to somebody else.
 *
 * It holds no secret: the token of a one-time link is taken out of the address at once.
 */

import type { Draft } from "./state";

export interface Shared {
  chosen: readonly string[];
  panel: string | null;
  /** A layout as its document. */
  layout: string | null;
  draft: Draft | null;
  /** A moment, microseconds since 1970. */
  moment: number | null;
}

const MOST_CHOSEN = 200;
const MOST_CHARS = 20_000;

export function readFragment(hash: string): Shared {
  const given = new URLSearchParams(hash.length > MOST_CHARS ? "" : hash.replace(/^#/, ""));
  const moment = Number(given.get("t") ?? Number.NaN);
  return {
    chosen: (given.get("sel") ?? "").split(",").filter(Boolean).slice(0, MOST_CHOSEN),
    panel: given.get("panel"),
    layout: given.get("layout"),
    draft: readDraft(given.get("draft")),
    moment: Number.isSafeInteger(moment) && moment > 0 ? moment : null,
  };
}

/** The fragment without its `#`; what is not there is left out. */
export function writeFragment(shared: Partial<Shared>): string {
  const given = new URLSearchParams();
  if (shared.chosen?.length) given.set("sel", shared.chosen.slice(0, MOST_CHOSEN).join(","));
  if (shared.panel) given.set("panel", shared.panel);
  if (shared.moment) given.set("t", String(shared.moment));
  if (shared.draft) given.set("draft", JSON.stringify(shared.draft));
  if (shared.layout) given.set("layout", shared.layout);
  return given.toString().replaceAll("%2F", "/").replaceAll("%3A", ":").replaceAll("%2C", ",");
}

/** The token of a one-time link, which nobody else is to see. */
export function firstToken(hash: string): string | null {
  return new URLSearchParams(hash.replace(/^#/, "")).get("first");
}

function readDraft(text: string | null): Draft | null {
  if (text === null) return null;
  try {
    const { scope, values } = JSON.parse(text) as Partial<Draft>;
    if (typeof scope !== "string" || typeof values !== "object") return null;
    return { scope, values: { ...values } };
  } catch {
    return null;
  }
}
