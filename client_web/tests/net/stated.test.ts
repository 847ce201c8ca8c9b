import { describe, expect, it } from "vitest";
import { closing } from "../../src/net/closing";
import { CloseCode } from "../../src/net/codes";
import { stated } from "../../src/net/stated";

describe("what the server states", () => {
  it("is told in the moderator's words, with the end of a ban in local time", () => {
    const untilS = new Date(2030, 4, 17, 21, 40).getTime() / 1000;
    const banned = {
      type: "error" as const,
      error: "banned",
      text: "No shouting. (until 2030-05-17 21:40 UTC)",
      arguments: { text: "No shouting.", until_s: untilS },
    };
    expect(stated(banned, "en-GB")).toBe(
      "No shouting. You may come back after 17 May 2030, 21:40.",
    );
    expect(stated({ ...banned, arguments: { text: "No.", until_s: null } })).toBe(
      "No. No end is set.",
    );
    const { text } = closing(CloseCode.BANNED, stated(banned, "en-GB"));
    expect(text).toContain("You cannot come in here. (No shouting.");
  });

  it("is not said twice", () => {
    const text = "An operator has asked you to leave.";
    const bye = { type: "bye" as const, reason: "kicked", text, arguments: {} };
    expect(closing(CloseCode.KICKED, stated(bye)).text).toBe(text);
  });
});
