import { beforeEach, describe, expect, it } from "vitest";

import { Draft } from "../../src/console/models/draft";
import type { Fault } from "../../src/console/net/types";

function fault(code: string, text: string, more: Partial<Fault> = {}): Fault {
  return { code, text, path: [], arguments: {}, ...more };
}

const SOURCES = {
  risk_weight: { value: 9.5, from: "default" },
  speed_mps: { value: 1.3, from: "world" },
};

let draft: Draft;

beforeEach(() => {
  draft = new Draft("world");
  draft.heard(SOURCES, 3);
});

describe("a draft", () => {
  it("shows its edits before the server's values, and sends nothing by itself", () => {
    draft.set("risk_weight", 12);
    expect(draft.value("risk_weight")).toBe(12);
    expect(draft.value("speed_mps")).toBe(1.3);
    expect(draft.hasUnsent).toBe(true);
  });

  it("never loses an edit to another operator, whose value stands beside it", () => {
    draft.set("risk_weight", 12);
    draft.heard({ ...SOURCES, risk_weight: { value: 30, from: "world" } }, 4, "otto");
    expect(draft.value("risk_weight")).toBe(12);
    expect(draft.beside("risk_weight")).toEqual({ value: 30, by: "otto" });
  });

  it("follows others in the fields that are not edited", () => {
    draft.set("risk_weight", 12);
    draft.heard({ ...SOURCES, speed_mps: { value: 0.9, from: "world" } }, 4, "otto");
    expect(draft.value("speed_mps")).toBe(0.9);
    expect(draft.beside("speed_mps")).toBeNull();
  });

  it("is checked against the revision from before a change of others, until it is decided", () => {
    draft.set("risk_weight", 12);
    draft.heard(SOURCES, 4);
    expect(draft.knownRevision).toBe(4);
    draft.heard({ ...SOURCES, risk_weight: { value: 30, from: "world" } }, 5);
    expect(draft.knownRevision).toBe(4);
    draft.keepMine("risk_weight");
    expect(draft.knownRevision).toBe(5);
  });

  it("lets one take theirs, or keep the own", () => {
    draft.set("risk_weight", 12);
    draft.heard({ ...SOURCES, risk_weight: { value: 30, from: "world" } }, 4);
    draft.keepMine("risk_weight");
    expect(draft.beside("risk_weight")).toBeNull();
    expect(draft.value("risk_weight")).toBe(12);
    draft.takeTheirs("risk_weight");
    expect(draft.value("risk_weight")).toBe(30);
    expect(draft.isEmpty).toBe(true);
  });

  it("keeps what is typed while an apply is under way, and sends it afterwards", () => {
    draft.set("risk_weight", 12);
    draft.set("speed_mps", 1);
    expect(draft.take()).toEqual({ values: { risk_weight: 12, speed_mps: 1 }, cleared: [] });
    draft.set("risk_weight", 14);
    expect(draft.take()).toBeNull();
    draft.heard({ ...SOURCES, risk_weight: { value: 12, from: "world" } }, 4);
    expect(draft.beside("risk_weight")).toBeNull();
    draft.applied(4);
    expect(draft.names).toEqual(["risk_weight"]);
    expect(draft.take()).toEqual({ values: { risk_weight: 14 }, cleared: [] });
  });

  it("takes own values of the scope away", () => {
    draft.set("speed_mps", null);
    expect(draft.take()).toEqual({ values: {}, cleared: ["speed_mps"] });
  });

  it("undoes and redoes edits, and a drag of a slider as one", () => {
    draft.set("risk_weight", 10);
    for (const value of [11, 12, 13]) draft.set("risk_weight", value, true);
    draft.set("speed_mps", 1);
    draft.undo();
    expect(draft.edit("speed_mps")).toBeUndefined();
    expect(draft.value("risk_weight")).toBe(13);
    draft.undo();
    expect(draft.isEmpty).toBe(true);
    draft.redo();
    expect(draft.value("risk_weight")).toBe(13);
  });
});

describe("faults", () => {
  it("stand at the fields that they name, by path or by text", () => {
    draft.set("risk_weight", 1000);
    draft.set("speed_mps", 2.5);
    const others = draft.checked([
      fault("out_of_range", "at most 200", { path: ["values", "risk_weight"] }),
      fault("invalid", "max_speed_mps (1.7) must not be below speed_mps (2.5)"),
      fault("busy", "try again"),
    ]);
    expect(draft.fault("risk_weight")?.text).toBe("at most 200");
    expect(draft.fault("speed_mps")?.code).toBe("invalid");
    expect(others.map((one) => one.code)).toEqual(["busy"]);
  });

  it("of a conflict show both values", () => {
    draft.set("risk_weight", 12);
    draft.take();
    const differences = [{ subject: "world", field: "risk_weight", yours: 12, now: 30, change: 4 }];
    draft.refused([fault("conflict", "changed: risk_weight", { arguments: { differences } })]);
    expect(draft.isFlying).toBe(false);
    expect(draft.value("risk_weight")).toBe(12);
    expect(draft.beside("risk_weight")?.value).toBe(30);
  });
});

describe("a link", () => {
  it("carries the draft over", () => {
    draft.set("risk_weight", 12);
    draft.set("speed_mps", null);
    const other = new Draft("world");
    const link = JSON.parse(
      JSON.stringify({ ...draft.values, evil: 3, foresight_s: "x" }),
    ) as object;
    other.load({ ...link }, (name) => name in SOURCES);
    expect(other.names).toEqual(["risk_weight", "speed_mps"]);
    other.heard(SOURCES, 3);
    expect(other.value("risk_weight")).toBe(12);
    expect(other.edit("speed_mps")).toBeNull();
  });
});
