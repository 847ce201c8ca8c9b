import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { IDLE_MS, Presence } from "../../src/app/presence";

let told: boolean[];
let page: Document & { visibilityState: DocumentVisibilityState };

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("window", globalThis);
  told = [];
  page = Object.assign(new EventTarget(), { visibilityState: "visible" }) as typeof page;
});

afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

it("is away without input for a while, and back with the next", () => {
  const presence = new Presence(page, (away) => told.push(away));
  vi.advanceTimersByTime(IDLE_MS - 1);
  page.dispatchEvent(new Event("keydown"));
  vi.advanceTimersByTime(IDLE_MS - 1);
  expect(told).toEqual([]);
  vi.advanceTimersByTime(1);
  expect([presence.away, told]).toEqual([true, [true]]);
  page.dispatchEvent(new Event("pointermove"));
  expect(told).toEqual([true, false]);
});

it("is away while the page is hidden, whatever happens there", () => {
  const presence = new Presence(page, (away) => told.push(away));
  page.visibilityState = "hidden";
  page.dispatchEvent(new Event("visibilitychange"));
  page.dispatchEvent(new Event("keydown"));
  expect([presence.away, told]).toEqual([true, [true]]);
  page.visibilityState = "visible";
  page.dispatchEvent(new Event("visibilitychange"));
  expect(told).toEqual([true, false]);
});
