import { expect, it } from "vitest";
import { hasSign } from "../../src/world/guides";

it("knows who holds up a sign, also of looks of servers that tell none", () => {
  expect(hasSign([0, 0, 0, 0, 0, 0, 1])).toBe(true);
  expect(hasSign([0, 0, 0, 0, 0, 0, 0])).toBe(false);
  expect(hasSign([1, 2, 3, 4, 5, 171])).toBe(false);
  expect(hasSign(null)).toBe(false);
});
