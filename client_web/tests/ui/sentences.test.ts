import { afterEach, describe, expect, it } from "vitest";
import { plain, type Wording } from "../../src/language/phrase";
import { speak } from "../../src/language/words";
import { endingOf, faultOf, noticeOf, paceOf, remarkOf, type Saying } from "../../src/ui/sentences";

afterEach(() => speak("en"));

const MUTED = {
  type: "notice" as const,
  notice: "muted",
  text: "some text in another language",
  arguments: { text: "Softly, please.", seconds: 600 },
};
const FAULT = { type: "error" as const, error: "quiet_zone", text: "?", arguments: {} };

const read = (wording: Wording): string => plain(wording).replace(/\s/gu, " ");
const both = (saying: Saying | null): string[] =>
  saying ? [read(saying.head), read(saying.words)] : [];

describe("sentences", () => {
  it("come from codes and arguments, not from the server's text", () => {
    expect(both(noticeOf(MUTED))).toEqual(["You are muted for 10 minutes.", "Softly, please."]);
    const why = "there is room for 9 people, all taken";
    const full = noticeOf({ ...MUTED, notice: "not_let_in", arguments: { zone: "hall", why } });
    expect(both(full)[1]).toBe("there is room for 9 people, all taken.");
    expect(read(faultOf(FAULT))).toBe("Nobody heard that: where you stand it is quiet.");
    expect(read(faultOf({ ...FAULT, arguments: { name: "library" } }))).toContain("(library)");
    const moved = { seq: 1, moved: 1.52, why: "no_ground", x: 1, y: 2, z: 0 };
    expect(read(remarkOf({ ...MUTED, notice: "goal_moved", arguments: moved }))).toBe(
      "There is no floor at that place; you walk to the nearest one, 1.5 m from it.",
    );
  });

  it("are those of the language that the page speaks; moderators' words stay as they are", async () => {
    await speak("de");
    expect(both(noticeOf(MUTED))).toEqual([
      "Du bist 10 Minuten lang stummgeschaltet.",
      "Softly, please.",
    ]);
    await speak("zh-Hant");
    expect(both(noticeOf(MUTED))[0]).toBe("你已被禁言 10 分鐘。");
  });

  it("leave what they do not know to the server's text", () => {
    const hi = { ...MUTED, notice: "", text: "Hi", arguments: {} };
    expect(noticeOf(hi)).toBeNull();
    expect(remarkOf(hi)).toBe("Hi");
    const why = { moved: 1, why: "a later reason" };
    expect(remarkOf({ ...hi, notice: "goal_moved", arguments: why })).toBe("Hi");
    expect(read(faultOf({ ...FAULT, error: "new_code", text: "so" }))).toBe("The server says: so.");
  });
});

describe("the pace of the world", () => {
  const pace = (notice: string, given: Record<string, unknown>): string =>
    read(paceOf({ ...MUTED, notice, arguments: given }));

  it("is told by its factor, and by what the server manages", () => {
    expect(pace("pace", { factor: 0.25, rate: 0.25 })).toContain(
      "slowly here just now: 0.25 times",
    );
    expect(pace("resumed", { factor: 4, rate: 4 })).toContain("fast here just now: 4 times");
    expect(pace("pace", { factor: 8, rate: 3.1 })).toContain("manages only 3.1 times");
    expect(pace("pace", { factor: 1, rate: 1 })).toBe("Time runs as usual again.");
    expect(pace("resumed", { factor: 1, rate: 1 })).toBe("The world goes on as usual.");
  });

  it("tells a pause from a place that does not answer", () => {
    expect(pace("paused", { factor: 1, rate: 0 })).toContain("The world is paused");
    expect(pace("paused", { factor: 1, rate: 0, silent: true })).toContain("does not answer");
    expect(pace("resumed", { factor: 1, rate: 1, silent: true })).toBe("The place goes on.");
  });
});

describe("the end of a connection", () => {
  it("is told with the moderator's words, and with the end of a ban in local time", () => {
    const bannedUntilS = new Date(2030, 4, 17, 21, 40).getTime() / 1000;
    const stated = { words: "No shouting.", bannedUntilS };
    const banned = { cause: "banned" as const, retry: false, stated };
    expect(read(endingOf(banned))).toBe(
      "You cannot come in here. (No shouting. You may come back after 17 May 2030, 21:40.)",
    );
    const forGood = { ...stated, bannedUntilS: null };
    expect(read(endingOf({ ...banned, stated: forGood }))).toContain("No end is set.");
  });

  it("is told in the page's words alone where these say it all", async () => {
    const full = { cause: "serverFull" as const, retry: false, stated: { words: "room for 3" } };
    expect(endingOf(full)).toBe("The place is full. Please try again later.");
    const words = "An operator has asked you to leave.";
    const kicked = { cause: "kicked" as const, retry: false, stated: { words } };
    expect(endingOf(kicked)).toBe(words);
    await speak("de");
    expect(endingOf(kicked)).toBe("Die Leitung hat dich gebeten zu gehen.");
  });
});
