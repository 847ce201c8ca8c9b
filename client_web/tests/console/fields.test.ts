import { describe, expect, it } from "vitest";

import {
  SLIDER_STEPS,
  byGroup,
  fromSlider,
  labelOf,
  numberFields,
  outOfRange,
  parsed,
  toSlider,
  unitIn,
} from "../../src/console/models/fields";
import type { NumberField } from "../../src/console/models/fields";

const SCHEMA = {
  type: "object",
  properties: {
    speed_mps: {
      ...{ type: "number", unit: "m/s", group: "speed", applies: "tick", scale: "linear" },
      ...{ minimum: 0.1, maximum: 3, default: 1.3, description: "Preferred speed." },
    },
    radius_m: {
      ...{ type: "number", unit: "m", group: "body", applies: "prepared", scale: "linear" },
      ...{ minimum: 0.15, maximum: 0.5, default: 0.25 },
    },
    max_expansions: {
      type: "integer",
      minimum: 10,
      maximum: 20000,
      default: 70,
      group: "planning",
    },
    name: { type: "string" },
  },
};

function field(name: string): NumberField {
  const found = numberFields(SCHEMA).find((one) => one.name === name);
  if (!found) throw new Error(name);
  return found;
}

describe("fields of a schema", () => {
  it("have all that a form needs, and leave out what is no number", () => {
    expect(numberFields(SCHEMA).map((one) => one.name)).toEqual([
      "speed_mps",
      "radius_m",
      "max_expansions",
    ]);
    expect(field("speed_mps")).toMatchObject({
      ...{ label: "Speed", unit: "m/s", doc: "Preferred speed.", group: "speed" },
      ...{ least: 0.1, most: 3, usual: 1.3, integer: false, prepared: false },
    });
    expect(field("radius_m").prepared).toBe(true);
  });

  it("show a field that the page has never heard of", () => {
    const properties = { ...SCHEMA.properties, patience_s: { type: "number", default: 4 } };
    const added = numberFields({ properties }).at(-1);
    expect(added).toMatchObject({ name: "patience_s", label: "Patience", unit: "s", usual: 4 });
  });

  it("stand under their headings in the order of the schema", () => {
    expect([...byGroup(numberFields(SCHEMA)).keys()]).toEqual(["speed", "body", "planning"]);
  });
});

describe("a slider", () => {
  it("is logarithmic where the range is wide", () => {
    expect(field("max_expansions").logarithmic).toBe(true);
    expect(field("speed_mps").logarithmic).toBe(false);
    expect(fromSlider(field("max_expansions"), SLIDER_STEPS / 2)).toBe(447);
  });

  it("reaches both ends, and comes back to where a value lies", () => {
    for (const one of numberFields(SCHEMA)) {
      expect(fromSlider(one, 0)).toBe(one.least);
      expect(fromSlider(one, SLIDER_STEPS)).toBe(one.most);
      for (let place = 0; place <= SLIDER_STEPS; place += 50) {
        const back = toSlider(one, fromSlider(one, place));
        expect(Math.abs(back - place)).toBeLessThan(one.integer ? 12 : 4);
      }
    }
  });

  it("rounds to what people can read", () => {
    expect(String(fromSlider(field("speed_mps"), 437)).length).toBeLessThan(6);
  });
});

describe("typing", () => {
  it("takes numbers only, with a comma too", () => {
    const speed = field("speed_mps");
    expect(parsed(speed, "1,5")).toBe(1.5);
    expect(parsed(speed, " 2e-1 ")).toBe(0.2);
    for (const text of ["", "1.", "-", "abc", "1 2", "Infinity", "NaN"]) {
      expect(parsed(speed, text)).toBe(text === "1." ? 1 : null);
    }
    expect(parsed(field("max_expansions"), "70.5")).toBeNull();
  });

  it("names the end of the range that is passed", () => {
    expect(outOfRange(field("speed_mps"), 9)).toBe("must not be above 3 m/s");
    expect(outOfRange(field("speed_mps"), 0)).toBe("must not be below 0.1 m/s");
    expect(outOfRange(field("speed_mps"), 1)).toBeNull();
  });
});

describe("names of the wire", () => {
  it("are words with a unit", () => {
    const told = ["least_pause_s", "speed_mps", "tick_p99_ms", "target"].map(
      (name) => `${labelOf(name)} ${unitIn(name)}`,
    );
    expect(told).toEqual(["Least pause s", "Speed m/s", "Tick p99 ms", "Target "]);
    expect(labelOf("tick_p99_ms")).toBe("Tick p99");
  });
});
