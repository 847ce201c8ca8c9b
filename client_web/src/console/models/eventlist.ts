/** Events of a world as they come in, filtered by kind and by who. */

import type { Point } from "../net/types";

export interface WorldEvent {
  readonly id: number | string;
  readonly at_us: number;
  readonly tick: number;
  readonly kind: string;
  readonly who?: string | number | null;
  readonly other?: string | number | null;
  readonly place?: Point | null;
  readonly text: string;
}

export const KINDS = [
  ...["join", "leave", "contact", "stop", "no_path", "door", "plan_failure", "late_tick", "chat"],
  ...["command", "mark", "report", "pace", "schedule", "trajectories", "recording"],
] as const;
const MOST = 1000;

export class EventList {
  private events: WorldEvent[] = [];
  private readonly known = new Set<number | string>();

  /** All kinds that are known, and those that have come in. */
  get kinds(): string[] {
    return [...new Set<string>([...KINDS, ...this.events.map((event) => event.kind)])];
  }

  get length(): number {
    return this.events.length;
  }

  /** Take events in whatever order; the oldest are forgotten. */
  add(events: readonly WorldEvent[]): void {
    const fresh = events.filter((event) => !this.known.has(event.id));
    if (fresh.length === 0) return;
    for (const event of fresh) this.known.add(event.id);
    this.events = [...this.events, ...fresh].sort((a, b) => b.at_us - a.at_us);
    for (const gone of this.events.splice(MOST)) this.known.delete(gone.id);
  }

  /** The newest first, of these kinds (all, if none is named) and about this name or id. */
  shown(kinds: ReadonlySet<string>, who: string, most = 200): WorldEvent[] {
    const word = who.trim().toLowerCase();
    return this.events
      .filter(
        (event) =>
          (kinds.size === 0 || kinds.has(event.kind)) &&
          (word === "" ||
            [event.who, event.other, event.text].some((text) =>
              String(text ?? "")
                .toLowerCase()
                .includes(word),
            )),
      )
      .slice(0, most);
  }
}

/** The id by which the page chooses whoever an event is about; null for nobody. */
export function chosenBy(who: string | number | null | undefined): string | null {
  if (who === null || who === undefined || who === "") return null;
  if (typeof who === "number") return `person:${who}`;
  return who.startsWith("actor:") ? who.slice("actor:".length) : who;
}
