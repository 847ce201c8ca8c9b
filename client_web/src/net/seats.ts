/**
 * This says which avatar belongs to which tab.
 *
 * A seat is a name and a resume token. The tab remembers the id of its seat (`sessionStorage`
 * survives a reload and a restored tab); the browser profile remembers the seats themselves
 * (`localStorage`), so that a new page with the same name can take up the avatar of one that was
 * closed or killed. A lock that a page holds as long as it lives keeps two open tabs two people,
 * also when a tab was duplicated together with its `sessionStorage`.
 */

import type { TryLock } from "./tablocks";

export interface Seat {
  id: string;
  /** The name that its person gave; in the world it may have a number. */
  name: string;
  token: string;
  /** The time at which its page was last alive, milliseconds since 1970. */
  seenMs: number;
  /** The server keeps its avatar for this long when the connection is gone. */
  keptMs: number;
}

const SEATS_KEY = "esplanade.seats";
const MINE_KEY = "esplanade.seat";

export class Seats {
  private mine: Seat | null = null;

  constructor(
    private readonly tab: Storage,
    private readonly profile: Storage,
    private readonly tryLock: TryLock | null,
    private readonly nowMs: () => number,
  ) {}

  /** The seat that this very tab had before a reload, if its avatar may still be there. */
  async ofThisTab(): Promise<Seat | null> {
    if (this.mine) return this.mine;
    const id = this.tab.getItem(MINE_KEY);
    const seat = this.fresh().find((each) => each.id === id);
    return seat && (await this.claim(seat)) ? seat : null;
  }

  /** A seat of that name whose page is gone, if its avatar may still be there. */
  async abandoned(name: string): Promise<Seat | null> {
    if (this.mine) return this.mine.name === name ? this.mine : null;
    // Without locks a living page cannot be told from a dead one.
    if (!this.tryLock) return null;
    for (const seat of this.fresh()) {
      if (seat.name === name && (await this.claim(seat))) return seat;
    }
    return null;
  }

  /** Remember what a welcome gave: at once, for the page may be reloaded before a lock is had. */
  async keep(name: string, token: string, keptMs: number): Promise<void> {
    const known = this.mine;
    const id = known?.id ?? crypto.getRandomValues(new Uint32Array(3)).join("-");
    this.mine = { id, name, token, seenMs: 0, keptMs };
    this.touch();
    if (!known) await this.claim(this.mine, true);
  }

  /** Say that this page is alive. */
  touch(): void {
    if (!this.mine) return;
    this.mine.seenMs = this.nowMs();
    this.write([...this.fresh().filter((each) => each.id !== this.mine?.id), this.mine]);
    this.tab.setItem(MINE_KEY, this.mine.id);
  }

  /** Give the seat up: the next person to join gets a new avatar. */
  forget(): void {
    if (!this.mine) return;
    const { id } = this.mine;
    this.write(this.fresh().filter((each) => each.id !== id));
    this.tab.removeItem(MINE_KEY);
    this.mine = null;
  }

  private async claim(seat: Seat, isNew = false): Promise<boolean> {
    if (this.tryLock && !(await this.tryLock(`esplanade.seat.${seat.id}`, isNew))) return false;
    this.mine = seat;
    return true;
  }

  private fresh(): Seat[] {
    let stored: unknown;
    try {
      stored = JSON.parse(this.profile.getItem(SEATS_KEY) ?? "[]");
    } catch {
      stored = [];
    }
    const nowMs = this.nowMs();
    return Array.isArray(stored)
      ? stored.filter((each): each is Seat => isSeat(each) && nowMs < each.seenMs + each.keptMs)
      : [];
  }

  private write(seats: Seat[]): void {
    this.profile.setItem(SEATS_KEY, JSON.stringify(seats));
  }
}

function isSeat(value: unknown): value is Seat {
  if (typeof value !== "object" || value === null) return false;
  const seat = value as Partial<Record<keyof Seat, unknown>>;
  return (
    typeof seat.id === "string" &&
    typeof seat.name === "string" &&
    typeof seat.token === "string" &&
    typeof seat.seenMs === "number" &&
    typeof seat.keptMs === "number"
  );
}
