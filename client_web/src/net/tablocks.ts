/**
 * Locks that a page holds as long as it lives, so that two open tabs are two people.
 *
 * Browsers have such locks only for pages that came over HTTPS or from this machine. For others a
 * page asks all pages of its address whether one of them holds the lock; a page that is gone does
 * not answer.
 */

/**
 * Takes the lock of that name for the page's life; false if another living page holds it. Nobody is
 * asked for a lock whose name is new, since no other page can hold it.
 */
export type TryLock = (name: string, isNew?: boolean) => Promise<boolean>;

/** The part of a BroadcastChannel that is used here. */
export interface Channel {
  onmessage: ((event: MessageEvent) => unknown) | null;
  postMessage(message: unknown): void;
}

interface Call {
  kind: "ask" | "mine";
  name: string;
  /** The page that calls. */
  from: string;
}

/** Pages that draw a large world in software answer late. */
const ANSWER_MS = 1000;

/** The browser's own locks; null where it has none. */
export function browserLocks(locks: LockManager | undefined): TryLock | null {
  if (!locks) return null;
  return (name) =>
    new Promise((answer) => {
      void locks.request(name, { ifAvailable: true }, (lock) => {
        answer(lock !== null);
        // Held until the page ends.
        return lock ? new Promise<never>(() => undefined) : undefined;
      });
    });
}

/** Locks by asking the other pages; `page` is this page's name, which no other has. */
export function channelLocks(channel: Channel, page: string, answerMs = ANSWER_MS): TryLock {
  const held = new Set<string>();
  const asking = new Map<string, () => void>();
  channel.onmessage = ({ data }) => {
    if (!isCall(data)) return;
    const refused = asking.get(data.name);
    if (data.kind === "mine") refused?.();
    // Of two pages that ask at once, the one whose name comes first goes on.
    else if (held.has(data.name) || (refused && page < data.from)) {
      channel.postMessage({ kind: "mine", name: data.name, from: page } satisfies Call);
    } else refused?.();
  };
  return (name, isNew = false) => {
    if (held.has(name) || asking.has(name)) return Promise.resolve(false);
    if (isNew) {
      held.add(name);
      return Promise.resolve(true);
    }
    return new Promise((answer) => {
      const end = (taken: boolean): void => {
        clearTimeout(timer);
        asking.delete(name);
        if (taken) held.add(name);
        answer(taken);
      };
      const timer = setTimeout(() => {
        end(true);
      }, answerMs);
      asking.set(name, () => {
        end(false);
      });
      channel.postMessage({ kind: "ask", name, from: page } satisfies Call);
    });
  };
}

function isCall(value: unknown): value is Call {
  if (typeof value !== "object" || value === null) return false;
  const call = value as Partial<Record<keyof Call, unknown>>;
  return (
    (call.kind === "ask" || call.kind === "mine") &&
    typeof call.name === "string" &&
    typeof call.from === "string"
  );
}
