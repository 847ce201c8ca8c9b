import { describe, expect, it } from "vitest";
import { choiceAfter, rowsOf, windowOf } from "../../../src/console/everybody/rows";
import { Avatars } from "../../../src/console/map/avatars";

function crowd(): Avatars {
  const avatars = new Avatars();
  const person = { kind: "person", radius_m: 0.3 } as const;
  const actor = { kind: "actor", radius_m: 0.3, behaviour: "guide" } as const;
  avatars.hear({
    channel: "map",
    entered: [
      { ...person, id: 1, name: "Zoe" },
      { ...actor, id: 10, name: "Actor 10", actor: "main/actor-10", groups: ["hurried"] },
      { ...actor, id: 2, name: "Actor 2", actor: "main/actor-2" },
    ],
  });
  return avatars;
}

describe("rowsOf", () => {
  it("has actors before people, by number", () => {
    const rows = rowsOf(crowd().byId.values(), "");
    expect(rows.map(({ name }) => name)).toEqual(["Actor 2", "Actor 10", "Zoe"]);
  });

  it("finds by name, group and behaviour, all words of them", () => {
    const found = (wanted: string): string[] =>
      rowsOf(crowd().byId.values(), wanted).map(({ key }) => key);
    expect(found("guide HURR")).toEqual(["main/actor-10"]);
    expect(found("zoe")).toEqual(["person:1"]);
    expect(found("zoe guide")).toEqual([]);
  });
});

describe("windowOf", () => {
  it("holds the rows in sight and a few more of a thousand", () => {
    expect(windowOf(1000, 28, 0, 280)).toEqual({ from: 0, to: 16 });
    const middle = windowOf(1000, 28, 14_000, 280);
    expect(middle).toEqual({ from: 494, to: 516 });
    expect(windowOf(3, 28, 9000, 280)).toEqual({ from: 3, to: 3 });
  });
});

describe("choiceAfter", () => {
  const rows = ["a", "b", "c", "d"].map((key) => ({ key }));
  const plain = { shift: false, ctrl: false };

  it("chooses one, one more, one less, and a range", () => {
    expect(choiceAfter(rows, ["a"], "c", plain)).toEqual(["c"]);
    expect(choiceAfter(rows, ["a"], "c", { ...plain, ctrl: true })).toEqual(["a", "c"]);
    expect(choiceAfter(rows, ["a", "c"], "c", { ...plain, ctrl: true })).toEqual(["a"]);
    expect(choiceAfter(rows, ["b"], "d", { ...plain, shift: true })).toEqual(["b", "c", "d"]);
    expect(choiceAfter(rows, ["c"], "a", { ...plain, shift: true })).toEqual(["c", "b", "a"]);
  });
});
