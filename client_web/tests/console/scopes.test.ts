import { describe, expect, it } from "vitest";

import { effective, scopeName, shadowing } from "../../src/console/models/scopes";

const ANSWER = {
  revision: 7,
  defaults: { risk_weight: 9.5, speed_mps: 1.3 },
  scopes: {
    world: { risk_weight: 10 },
    "group:hurried": { risk_weight: 4 },
    "group:kind:old": { speed_mps: 0.8 },
    "actor:main/a": { risk_weight: 1 },
    "actor:main/b": { risk_weight: 2 },
  },
};
const ACTORS = [
  { id: "main/a", name: "Ada", tags: ["hurried"], groups: { kind: "old" } },
  { id: "main/b", name: "Bo", tags: [] },
];

describe("scopes", () => {
  it("prevail from wide to narrow, each value with where it comes from", () => {
    expect(effective(ANSWER, "world")["risk_weight"]).toEqual({ value: 10, from: "world" });
    expect(effective(ANSWER, "group:hurried")).toEqual({
      risk_weight: { value: 4, from: "group:hurried" },
      speed_mps: { value: 1.3, from: "default" },
    });
    expect(effective(ANSWER, "actor:main/a", ["hurried", "kind:old"])).toEqual({
      risk_weight: { value: 1, from: "actor:main/a" },
      speed_mps: { value: 0.8, from: "group:kind:old" },
    });
  });

  it("tell which narrower ones shadow a value", () => {
    expect(shadowing(ANSWER, "world", "risk_weight", ACTORS)).toEqual([
      "group:hurried",
      "actor:main/a",
      "actor:main/b",
    ]);
    expect(shadowing(ANSWER, "group:hurried", "risk_weight", ACTORS)).toEqual(["actor:main/a"]);
    expect(shadowing(ANSWER, "actor:main/a", "risk_weight", ACTORS)).toEqual([]);
  });

  it("have names for people", () => {
    expect(scopeName("actor:main/a", ACTORS)).toBe("Ada (a)");
    expect(scopeName("group:kind:old")).toBe("group kind:old");
  });
});
