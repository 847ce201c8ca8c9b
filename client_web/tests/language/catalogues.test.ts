import { describe, expect, it } from "vitest";
import HTML from "../../index.html?raw";
import type { Blocker, Outlook, Whereabouts } from "../../src/language/arguments";
import { type Catalogue, english } from "../../src/language/english";
import { german } from "../../src/language/german";
import { LANGUAGES, TAGS } from "../../src/language/languages";
import { isolated, plain, type Wording } from "../../src/language/phrase";

const NAMED: Blocker = { kind: "named", name: "«one»" };
const THERE: Whereabouts = {
  distanceM: 17,
  side: "left",
  floor: "above",
  away: true,
  approach: "nearer",
};
const REACH: Outlook = { path: "toGoal", seconds: 17 };
const END = new Date(2031, 4, 17, 21, 40);

/** Arguments for each sentence that takes some, and what of them has to be read in it. */
const SAMPLES: Record<string, readonly (readonly [given: unknown[], read: string[]])[]> = {
  tooLong: [
    [
      [17, 318],
      ["17", "318"],
    ],
  ],
  "status.roundTrip": [[[17], ["17"]]],
  "status.comingBack": [[["«one»"], ["«one»"]]],
  "door.tryingAgain": [[["«one»"], ["«one»"]]],
  "look.centimetres": [[[171], ["171"]]],
  "people.inWorld": [
    [
      [17, 18],
      ["17", "18"],
    ],
  ],
  "card.where": [[[THERE], ["17"]]],
  "following.whom": [[["«one»"], ["«one»"]]],
  "links.toPerson": [[["«one»"], ["«one»"]]],
  "map.floor": [
    [[0], []],
    [[16], ["1"]],
  ],
  "map.sign": [
    [[0], []],
    [[16], ["1"]],
  ],
  "plan.stop": [[[17], ["17"]]],
  "plan.led": [
    [[0], []],
    [[17], ["17"]],
  ],
  "plan.others": [
    [[0], []],
    [[17], ["17"]],
  ],
  ...Object.fromEntries(
    Object.keys(english.plan.behaviours).map((each) => [
      `plan.behaviours.${each}`,
      [
        [[null], []],
        [["«one»"], ["«one»"]],
      ],
    ]),
  ),
  "plan.unknown": [
    [["«one»", null], ["«one»"]],
    [
      ["«one»", "«two»"],
      ["«one»", "«two»"],
    ],
  ],
  ...(Object.fromEntries(
    ["asNear", "blocked", "givingWay", "waitingFor"].map((each) => [
      `plan.${each}`,
      [
        [[NAMED], ["«one»"]],
        [[{ kind: "door", name: "«one»" }], ["«one»"]],
        ...["unseen", "somebody", "unnamedDoor", "wall", "route", "something"].map((kind) => [
          [{ kind }],
          [],
        ]),
      ],
    ]),
  ) as Record<string, [unknown[], string[]][]>),
  "plan.outlook": [
    [
      [REACH, 23],
      ["17", "23"],
    ],
    [
      [{ ...REACH, path: "part" }, 23],
      ["17", "23"],
    ],
    [[{ path: "none" }, 23], ["23"]],
    [[{ path: "over" }, 23], ["23"]],
  ],
  "chat.welcome": [[["«one»"], ["«one»"]]],
  "chat.welcomeBack": [[["«one»"], ["«one»"]]],
  "chat.arrived": [[["«one»"], ["«one»"]]],
  "chat.noBuilding": [[["«one»"], ["«one»"]]],
  "around.somebody": [
    [
      ["«one»", THERE],
      ["«one»", "17"],
    ],
  ],
  "around.place": [
    [
      ["«one»", { distanceM: 17, side: "behind" }],
      ["«one»", "17"],
    ],
  ],
  "around.more": [[[17], ["17"]]],
  "around.together": [[[["«one»", "«two»"]], ["«one»", "«two»"]]],
  ...Object.fromEntries(
    Object.keys(english.gestures.they).map((each) => [
      `gestures.they.${each}`,
      [[["«one»"], ["«one»"]]],
    ]),
  ),
  "notices.muted": [[[17], ["17"]]],
  "notices.mutedYet": [[[598], ["9:58"]]],
  "notices.notLetInWhy": [[["«one»"], ["«one»"]]],
  "notices.goalMoved": [
    [["inside_wall", 1.5], []],
    [["near_wall", 17], ["17"]],
    [["no_ground", 17], ["17"]],
    [["other_region", 17], ["17"]],
  ],
  "notices.slow": [[[0], ["0"]]],
  "notices.quick": [[[4], ["4"]]],
  "notices.behind": [
    [
      [8, 3],
      ["8", "3"],
    ],
  ],
  "faults.muted": [[[17], ["17"]]],
  "faults.slowMode": [[[17], ["17"]]],
  "faults.quietZone": [
    [[null], []],
    [["«one»"], ["«one»"]],
  ],
  "faults.other": [[["«one»"], ["«one»"]]],
  endingSaid: [
    [
      ["«one»", "«two»"],
      ["«one»", "«two»"],
    ],
  ],
  bannedUntil: [
    [
      ["«one»", END],
      ["«one»", "2031", "17"],
    ],
  ],
  bannedForGood: [[["«one»"], ["«one»"]]],
};

const catalogues = await Promise.all(
  TAGS.map(async (tag) => [tag, await LANGUAGES[tag].words()] as const),
);

/** Everything in a catalogue, by its path. */
function entries(at: object, path = ""): [string, unknown][] {
  return Object.entries(at).flatMap(([step, value]: [string, unknown]) => {
    const here = path === "" ? step : `${path}.${step}`;
    const isGroup = typeof value === "object" && value !== null && !Array.isArray(value);
    return isGroup ? entries(value, here) : [[here, value] as [string, unknown]];
  });
}

function sentences(catalogue: Catalogue): [path: string, sentence: string][] {
  return entries(catalogue).flatMap(([path, value]): [string, string][] => {
    if (typeof value !== "function") return [[path, plain(value as Wording)]];
    return (SAMPLES[path] ?? []).map(([given]) => [path, spoken(value, given)]);
  });
}

function spoken(sentence: unknown, given: readonly unknown[]): string {
  return plain((sentence as (...given: unknown[]) => Wording)(...given));
}

describe.each(catalogues)("the catalogue %s", (_, catalogue) => {
  it("has the same words as the English one", () => {
    const paths = (of: Catalogue): string[] => entries(of).map(([path]) => path);
    expect(paths(catalogue)).toEqual(paths(english));
  });

  it("says everything that its sentences are given", () => {
    for (const [path, value] of entries(catalogue)) {
      if (typeof value !== "function") continue;
      const samples = SAMPLES[path];
      expect(samples, `there are no arguments for ${path}`).toBeDefined();
      for (const [given, read] of samples ?? []) {
        for (const each of read) expect(spoken(value, given), path).toContain(each);
      }
    }
  });

  it("leaves nothing empty, and no argument as it is in programs", () => {
    for (const [path, sentence] of sentences(catalogue)) {
      expect(sentence.trim(), path).not.toBe("");
      expect(sentence, path).not.toMatch(/undefined|null|NaN|object|=>|\$\{/);
    }
  });

  it("has all words that the page's HTML names", () => {
    const known = new Map(entries(catalogue));
    const named = [...HTML.matchAll(/data-(words|label|hint|title)="([^"]*)"/g)];
    expect(named.length).toBeGreaterThan(80);
    for (const [, naming, path = ""] of named) {
      const value = known.get(path);
      const isWhole = typeof value === "string" || (naming === "words" && Array.isArray(value));
      expect(isWhole, `${String(naming)} ${path}`).toBe(true);
    }
  });
});

describe.each(catalogues.slice(1))("the catalogue %s", (_, catalogue) => {
  it("is written in its own language", () => {
    const same = [
      "status.roundTrip",
      "plan.awaited",
      "around.together",
      "help.talk",
      "help.around",
    ];
    const alike = /^(Chat|khaki|\d|.* cm$|«)/i;
    const inEnglish = new Map(sentences(english));
    for (const [path, sentence] of sentences(catalogue)) {
      if (same.includes(path) || alike.test(sentence)) continue;
      expect(sentence, path).not.toBe(inEnglish.get(path));
    }
  });
});

describe("the page's HTML", () => {
  it("has no words of its own but the name of the place, and what is read without scripts", () => {
    const bare = HTML.replace(/<noscript>.*<\/noscript>|<title>.*<\/title>|<!--.*?-->/gs, "");
    const text = bare
      .replace(/<[^>]*>/gs, " ")
      .trim()
      .split(/\s+/);
    expect(text).toEqual(["0", "Esplanade"]);
    expect(bare).not.toMatch(/\s(aria-label|placeholder|title|alt)="/);
  });

  it("sends reports in English, which the operators' page speaks", () => {
    const options = [...HTML.matchAll(/<option\s+value="([^"]*)"\s+data-words="card.whys.(\w+)"/g)];
    const values = Object.fromEntries(options.map(([, value = "", why = ""]) => [why, value]));
    expect(values).toEqual(english.card.whys);
  });
});

describe("names", () => {
  it("stand apart from the sentence around them", () => {
    expect(english.following.whom("מרים")).toEqual([
      "You follow ",
      { tag: "bdi", text: "מרים" },
      ".",
    ]);
    expect(isolated(german.following.whom("مريم"))).toBe("Du folgst \u2068مريم\u2069.");
  });
});

it("is an error of types to leave words out, or to have more", () => {
  const { chat, ...rest } = german;
  // @ts-expect-error The chat's words are missing.
  const less: Catalogue = rest;
  // @ts-expect-error No other language has such words.
  const more: Catalogue = { ...german, chatter: chat };
  // @ts-expect-error It is given a name, and no number.
  const other: Catalogue["following"]["whom"] = (count: number) => [String(count)];
  expect([less, more, other]).toHaveLength(3);
});
