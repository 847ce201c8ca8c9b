import { describe, expect, it } from "vitest";
import { faultOf, noticeOf, spanOf } from "../../src/ui/sentences";

describe("sentences", () => {
  it("say how long in words", () => {
    expect([0, 1, 59, 60, 598.2, 3600, 7260].map(spanOf)).toEqual([
      "0 seconds",
      "1 second",
      "59 seconds",
      "1 minute",
      "9:59 minutes",
      "1 hour",
      "2:01 hours",
    ]);
  });

  it("come from codes and arguments, not from the server's text", () => {
    const muted = noticeOf({
      type: "notice",
      notice: "muted",
      text: "some text in another language",
      arguments: { text: "Softly, please.", seconds: 600 },
    });
    expect(muted).toEqual({ head: "You are muted for 10 minutes.", words: "Softly, please." });
    const full = noticeOf({
      type: "notice",
      notice: "not_let_in",
      text: "some text in another language",
      arguments: { zone: "hall", why: "there is room for 9 people, all taken" },
    });
    expect(full?.words).toBe("there is room for 9 people, all taken.");
    const fault = { type: "error" as const, error: "quiet_zone", text: "?", arguments: {} };
    expect(faultOf(fault)).toBe("Nobody heard that: where you stand it is quiet.");
    expect(faultOf({ ...fault, arguments: { name: "library" } })).toContain("(library)");
  });

  it("leave what they do not know to the server's text", () => {
    expect(noticeOf({ type: "notice", notice: "", text: "Hi", arguments: {} })).toBeNull();
    const fault = { type: "error" as const, error: "new_code", text: "so", arguments: {} };
    expect(faultOf(fault)).toBe("The server says: so.");
  });
});
