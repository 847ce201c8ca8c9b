/**
 * The people whom this person does not want to hear, by name, kept in the browser.
 *
 * An avatar has a new id whenever somebody comes in, but no two in a world have names that look
 * alike. Whoever comes into view and is on the list is muted at the server, which then sends none
 * of their lines.
 */

const MUTED_KEY = "esplanade.muted";
const MOST = 200;

export class Mutes {
  private readonly names: Set<string>;

  constructor(private readonly storage: Storage) {
    this.names = new Set(stored(storage));
  }

  has(name: string): boolean {
    return this.names.has(name);
  }

  set(name: string, muted: boolean): void {
    this.names.delete(name);
    if (muted) this.names.add(name);
    const kept = [...this.names].slice(-MOST);
    for (const each of this.names) if (!kept.includes(each)) this.names.delete(each);
    try {
      this.storage.setItem(MUTED_KEY, JSON.stringify(kept));
    } catch {
      // A full or forbidden storage: it holds until the page is closed.
    }
  }
}

function stored(storage: Storage): string[] {
  try {
    const found: unknown = JSON.parse(storage.getItem(MUTED_KEY) ?? "[]");
    if (!Array.isArray(found)) return [];
    return found.filter((name): name is string => typeof name === "string").slice(-MOST);
  } catch {
    return [];
  }
}
