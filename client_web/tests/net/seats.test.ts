import { beforeEach, describe, expect, it } from "vitest";
import { Seats } from "../../src/net/seats";
import type { TryLock } from "../../src/net/tablocks";

/** Storage of one tab or one profile. */
function storage(entries = new Map<string, string>()): Storage {
  return {
    getItem: (key: string) => entries.get(key) ?? null,
    setItem: (key: string, value: string) => void entries.set(key, value),
    removeItem: (key: string) => void entries.delete(key),
    clear: () => {
      entries.clear();
    },
    key: () => null,
    length: 0,
  };
}

const KEPT_MS = 12_000;

let profile: Storage;
let nowMs: number;
let locked: Map<string, object>;

/** A page of the profile; its locks go with it. */
function page(tab = storage()): { seats: Seats; tab: Storage; kill: () => void } {
  const holder = {};
  const tryLock: TryLock = (name) => {
    if (locked.has(name)) return Promise.resolve(false);
    locked.set(name, holder);
    return Promise.resolve(true);
  };
  const kill = (): void => {
    for (const [name, by] of locked) if (by === holder) locked.delete(name);
  };
  return { seats: new Seats(tab, profile, tryLock, () => nowMs), tab, kill };
}

beforeEach(() => {
  profile = storage();
  nowMs = 1_000_000;
  locked = new Map();
});

describe("Seats", () => {
  it("gives a reloaded tab its seat again", async () => {
    const before = page();
    await before.seats.keep("Ann", "token", KEPT_MS);
    before.kill();
    const seat = await page(before.tab).seats.ofThisTab();
    expect(seat).toMatchObject({ name: "Ann", token: "token" });
  });

  it("gives it again to a tab that was reloaded before it had its lock", async () => {
    const before = page();
    void before.seats.keep("Ann", "token", KEPT_MS);
    before.kill();
    expect(await page(before.tab).seats.ofThisTab()).toMatchObject({ token: "token" });
  });

  it("gives the seat of a killed page to a new one of the same name", async () => {
    const killed = page();
    await killed.seats.keep("Ann", "token", KEPT_MS);
    killed.kill();
    expect(await page().seats.abandoned("Ben")).toBeNull();
    expect(await page().seats.abandoned("Ann")).toMatchObject({ token: "token" });
  });

  it("keeps two open pages of one name two people", async () => {
    await page().seats.keep("Ann", "token", KEPT_MS);
    expect(await page().seats.abandoned("Ann")).toBeNull();
  });

  it("keeps a duplicated tab from taking its twin's seat", async () => {
    const first = page();
    await first.seats.keep("Ann", "token", KEPT_MS);
    expect(await page(first.tab).seats.ofThisTab()).toBeNull();
  });

  it("forgets seats whose avatar is gone", async () => {
    const killed = page();
    await killed.seats.keep("Ann", "token", KEPT_MS);
    killed.kill();
    nowMs += KEPT_MS + 1;
    expect(await page(killed.tab).seats.ofThisTab()).toBeNull();
    expect(await page().seats.abandoned("Ann")).toBeNull();
  });

  it("counts from when the page was last alive", async () => {
    const killed = page();
    await killed.seats.keep("Ann", "token", KEPT_MS);
    nowMs += KEPT_MS - 1;
    killed.seats.touch();
    killed.kill();
    nowMs += KEPT_MS - 1;
    expect(await page().seats.abandoned("Ann")).not.toBeNull();
  });

  it("takes no seat but its own where the browser has no locks", async () => {
    const tab = storage();
    await new Seats(tab, profile, null, () => nowMs).keep("Ann", "token", KEPT_MS);
    expect(await new Seats(storage(), profile, null, () => nowMs).abandoned("Ann")).toBeNull();
    expect(await new Seats(tab, profile, null, () => nowMs).ofThisTab()).not.toBeNull();
  });

  it("keeps the newest token for the next page", async () => {
    const before = page();
    await before.seats.keep("Ann", "token", KEPT_MS);
    await before.seats.keep("Ann", "newer", KEPT_MS);
    before.kill();
    expect(await page(before.tab).seats.ofThisTab()).toMatchObject({ token: "newer" });
  });

  it("goes by how long each server keeps its avatars", async () => {
    const [short, long] = [page(), page()];
    await short.seats.keep("Ann", "short", 1000);
    await long.seats.keep("Ben", "long", 60_000);
    short.kill();
    long.kill();
    nowMs += 1001;
    expect(await page().seats.abandoned("Ann")).toBeNull();
    nowMs += 58_000;
    expect(await page().seats.abandoned("Ben")).toMatchObject({ token: "long" });
  });

  it("is not put out by rubbish in the storage", async () => {
    profile.setItem("esplanade.seats", "{not json");
    expect(await page().seats.abandoned("Ann")).toBeNull();
    profile.setItem("esplanade.seats", '[1, null, {"id": 3}]');
    expect(await page().seats.abandoned("Ann")).toBeNull();
  });
});
