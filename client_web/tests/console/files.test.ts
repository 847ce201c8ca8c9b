import { describe, expect, it } from "vitest";

import { toCsv, toJsonLines } from "../../src/console/models/export";
import { summary } from "../../src/console/models/facts";
import { readPreset, toJson, toToml } from "../../src/console/models/presetfiles";

const TIMID = {
  name: "timid",
  version: 2,
  note: 'Keeps "far" off\nfrom\u007f all',
  values: { risk_weight: 20, foresight_s: 4.5 },
};

describe("files of presets", () => {
  it("come back as they were, from TOML and from JSON", async () => {
    expect(await readPreset(toToml(TIMID), "timid.toml")).toEqual(TIMID);
    expect(await readPreset(toJson(TIMID), "timid.json")).toEqual(TIMID);
  });

  it("say what is wrong with them", async () => {
    await expect(readPreset('{"name": "Big Name"}', "x.json")).rejects.toThrow("small letters");
    await expect(readPreset('name = "x"', "x.toml")).rejects.toThrow("no values");
    const text = 'name = "x"\n[values]\nrisk_weight = "12"';
    await expect(readPreset(text, "x.toml")).rejects.toThrow("risk_weight is no number");
  });
});

describe("rows as files", () => {
  it("hold nothing that a spreadsheet would compute", () => {
    const rows = [{ note: "=1+1", at: 3, body: { a: 'x"y' }, gone: null }];
    expect(toCsv(rows, ["note", "at", "body", "gone"])).toBe(
      'note,at,body,gone\r\n\'=1+1,3,"{""a"":""x\\""y""}",\r\n',
    );
  });

  it("are a line of JSON each", () => {
    expect(toJsonLines([{ a: 1 }, { a: 2 }])).toBe('{"a":1}\n{"a":2}\n');
  });
});

describe("a change in one line", () => {
  it("tells the values and about whom", () => {
    const before = { world: { risk_weight: null } };
    expect(summary(before, { world: { risk_weight: 12 } })).toBe(
      "risk_weight not set → 12 (world)",
    );
    const many = Object.fromEntries(Array.from({ length: 5 }, (_, n) => [`p${n}`, n]));
    expect(summary({}, { "actor:main/a": many })).toContain("and 2 more (a)");
  });
});
