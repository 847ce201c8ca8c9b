import { describe, expect, it } from "vitest";
import { plain, type Phrase } from "../../src/language/phrase";
import { speechOf } from "../../src/language/speech";

const [english, german, chinese] = ["en-GB", "de", "zh-Hant-TW"].map(speechOf) as [
  ReturnType<typeof speechOf>,
  ReturnType<typeof speechOf>,
  ReturnType<typeof speechOf>,
];
/** Spaces that do not break are spaces all the same. */
const read = (phrase: Phrase): string => plain(phrase).replace(/\s/gu, " ");

describe("numbers", () => {
  it("are written as the language writes them", () => {
    const said = [english, german].map(({ say }) => read(say`${12345.5}`));
    expect(said).toEqual(["12,345.5", "12.345,5"]);
  });

  it("have the units of the language", () => {
    expect([english, german, chinese].map(({ metres }) => read(metres(3)))).toEqual([
      "3 m",
      "3 m",
      "3 公尺",
    ]);
    expect(read(german.metres(1.52))).toBe("1,5 m");
    expect([english, chinese].map(({ centimetres }) => read(centimetres(171)))).toEqual([
      "171 cm",
      "171 公分",
    ]);
    expect(read(chinese.seconds(4.2))).toBe("4 秒");
  });

  it("choose the wording that the language has for so many", () => {
    const wordings = { one: "one", two: "two", few: "few", other: "other" };
    const said = [0, 1, 2, 3].map((count) => read(german.plural(count, wordings)));
    expect(said).toEqual(["other", "one", "other", "other"]);
    expect([1, 2, 3, 11].map((n) => read(speechOf("ar").plural(n, wordings)))).toEqual([
      "one",
      "two",
      "few",
      "other",
    ]);
    expect(read(chinese.plural(1, wordings))).toBe("other");
  });
});

describe("lengths of time", () => {
  it("are counted down in seconds, minutes and hours", () => {
    const spans = [0, 1, 59, 60, 598.2, 3600, 7260];
    expect(spans.map((seconds) => read(english.span(seconds)))).toEqual([
      "0 seconds",
      "1 second",
      "59 seconds",
      "1 minute",
      "9:59 minutes",
      "1 hour",
      "2:01 hours",
    ]);
    expect(read(english.span(61))).toBe("1:01 minutes");
    expect(spans.map((seconds) => read(german.span(seconds)))).toEqual([
      "0 Sekunden",
      "1 Sekunde",
      "59 Sekunden",
      "1 Minute",
      "9:59 Minuten",
      "1 Stunde",
      "2:01 Stunden",
    ]);
    expect(read(chinese.span(598))).toBe("9:58 分鐘");
  });
});

describe("phrases", () => {
  it("nest: numbers and names keep their places", () => {
    const { say } = english;
    const phrase = say`${say`${2} friends`} of ${"Ann"}`;
    expect(phrase).toEqual(["2", " friends", " of ", { tag: "bdi", text: "Ann" }]);
  });
});
