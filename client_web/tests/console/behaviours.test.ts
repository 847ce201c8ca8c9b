import { describe, expect, it } from "vitest";

import { behaviourKinds, missing, specOf } from "../../src/console/models/behaviours";

const PLACE = {
  anyOf: [
    { type: "string", minLength: 1 },
    { type: "array", minItems: 3, maxItems: 3, prefixItems: [{}, {}, {}] },
  ],
};
const SCHEMA = {
  $defs: {
    Idle: {
      description: "Stand.",
      properties: { kind: { const: "idle", default: "idle", type: "string" } },
      type: "object",
    },
    Guide: {
      description: "Lead people along a tour.",
      properties: {
        kind: { const: "guide", default: "guide", type: "string" },
        tour: { type: "array", items: PLACE, maxItems: 64, minItems: 1 },
        pause_s: { type: "number", default: 5, minimum: 0, maximum: 3600 },
        first: PLACE,
        style: { enum: ["calm", "lively"], type: "string" },
        loops: { type: "boolean", default: true },
      },
      required: ["tour"],
      type: "object",
    },
  },
  oneOf: [{ $ref: "#/$defs/Guide" }, { $ref: "#/$defs/Idle" }],
};

describe("behaviours of a schema", () => {
  const [guide, idle] = behaviourKinds(SCHEMA);

  it("are forms with an input for each property", () => {
    expect(idle).toEqual({ kind: "idle", label: "Idle", doc: "Stand.", inputs: [] });
    expect(guide?.inputs.map((input) => [input.name, input.kind, input.required])).toEqual([
      ["tour", "places", true],
      ["pause_s", "number", false],
      ["first", "place", false],
      ["style", "choice", false],
      ["loops", "boolean", false],
    ]);
    expect(guide?.inputs[1]?.field).toMatchObject({ unit: "s", usual: 5, most: 3600 });
  });

  it("are sent without what was left empty, and not before all is there", () => {
    if (!guide) throw new Error("there is no guide");
    expect(missing(guide, { tour: [] })).toBe("Tour is missing.");
    const values = { tour: ["café", [1, 2, 0]], pause_s: "", other: 3 };
    expect(missing(guide, values)).toBeNull();
    expect(specOf(guide, values)).toEqual({ kind: "guide", tour: ["café", [1, 2, 0]] });
  });
});
