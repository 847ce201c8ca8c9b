import { describe, expect, it } from "vitest";
import { closing } from "../../src/net/closing";
import { CloseCode } from "../../src/net/codes";
import { stated } from "../../src/net/stated";

const BANNED = {
  type: "error" as const,
  error: "banned",
  text: "No shouting. (until 2030-05-17 21:40 UTC)",
  arguments: { text: "No shouting.", until_s: 1_905_277_200 },
};

describe("what the server states", () => {
  it("is the moderator's words, with the end of a ban", () => {
    expect(stated(BANNED)).toEqual({ words: "No shouting.", bannedUntilS: 1_905_277_200 });
    expect(stated({ ...BANNED, arguments: { text: "No.", until_s: null } })).toEqual({
      words: "No.",
      bannedUntilS: null,
    });
  });

  it("else is the server's sentence", () => {
    const full = { ...BANNED, error: "server_full", text: "no room", arguments: {} };
    expect(stated(full)).toEqual({ words: "no room" });
  });
});

describe("the end of a connection", () => {
  it("has a cause by its close code, and the server's words", () => {
    const words = { words: "No." };
    expect(closing(CloseCode.KICKED, words)).toEqual({
      cause: "kicked",
      retry: false,
      stated: words,
    });
    expect(closing(1006, null)).toEqual({ cause: "lost", retry: true, stated: null });
  });
});
