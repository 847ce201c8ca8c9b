import { expect, it } from "vitest";
import { Mutes } from "../../src/app/mutes";

class Kept implements Pick<Storage, "getItem" | "setItem"> {
  constructor(public value: string | null = null) {}
  getItem(): string | null {
    return this.value;
  }
  setItem(_: string, value: string): void {
    this.value = value;
  }
}

const over = (kept: Kept): Mutes => new Mutes(kept as unknown as Storage);

it("remembers names over a reload", () => {
  const kept = new Kept();
  over(kept).set("Ben", true);
  expect(over(kept).has("Ben")).toBe(true);
  over(kept).set("Ben", false);
  expect(over(kept).has("Ben")).toBe(false);
});

it("forgets the oldest of too many", () => {
  const kept = new Kept();
  const mutes = over(kept);
  for (let i = 0; i < 201; i++) mutes.set(`p${i}`, true);
  expect([mutes.has("p0"), mutes.has("p1"), over(kept).has("p200")]).toEqual([false, true, true]);
});

it.each(["{", "3", '{"a": 1}', '[1, null, "Ben"]'])("reads %s without a fault", (text) => {
  expect(over(new Kept(text)).has("Ben")).toBe(text.includes("Ben"));
});
