import { expect, it } from "vitest";
import { languageFor } from "../../src/language/languages";

it.each([
  [["de-AT", "en"], "de"],
  [["fr", "de"], "de"],
  [["zh-TW"], "zh-Hant"],
  [["zh-HK", "en"], "zh-Hant"],
  [["zh-Hant-MO"], "zh-Hant"],
  [["en-GB", "de"], "en"],
  [["fr-CA", "it"], "en"],
  [["no language at all", "de"], "de"],
  [[], "en"],
] as const)("goes by the languages %j that a person reads", (read, tag) => {
  expect(languageFor(null, read)).toBe(tag);
});

it("takes no Simplified Chinese for Traditional", () => {
  expect(languageFor(null, ["zh-CN", "en"])).toBe("en");
  expect(languageFor(null, ["zh", "de"])).toBe("de");
});

it("goes by the choice that was kept, if it is one", () => {
  expect(languageFor("de", ["zh-TW"])).toBe("de");
  expect(languageFor("tlh", ["zh-TW"])).toBe("zh-Hant");
});
