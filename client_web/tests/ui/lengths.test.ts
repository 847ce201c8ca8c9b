import { describe, expect, it } from "vitest";
import { plain } from "../../src/language/phrase";
import { tooLong } from "../../src/ui/lengths";

describe("the length of a text", () => {
  it("is no fault up to the most", () => {
    expect(tooLong("", 3)).toBeNull();
    expect(tooLong("abc", 3)).toBeNull();
  });

  it("is told by how much it is too long", () => {
    expect(plain(tooLong("abcd", 3) ?? "")).toBe("That is 1 character too long; 3 are the most.");
    expect(plain(tooLong("abcdef", 3) ?? "")).toBe(
      "That is 3 characters too long; 3 are the most.",
    );
  });

  it("is counted in characters, as the server counts", () => {
    expect(tooLong("🙂🙂🙂", 3)).toBeNull();
  });
});
