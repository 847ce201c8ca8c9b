import { describe, expect, it } from "vitest";
import { compare, valueText } from "../../../src/console/inspector/compare";
import { barPart, secondsOf } from "../../../src/console/inspector/costs";
import { comparedPaths } from "../../../src/console/inspector/searchpart";
import { countNodes, segmentsOf, traceOverlay } from "../../../src/console/inspector/tree";
import { momentOf, piecesOf, shares, spanText, stopsOf } from "../../../src/console/inspector/why";
import type { Cost, PricedPath, Trace, WhySpan } from "../../../src/console/net/types";
import { reasonColour, REASONS, reasonText } from "../../../src/console/state/reasons";

const span = (from: number, to: number, reason: string): WhySpan => ({
  from_tick: from,
  to_tick: to,
  reason,
  blocker: reason === "waiting" ? { kind: "person", id: 12, name: "Anna", away_m: 0.84 } : null,
  seconds: (to - from) * 0.05,
});
const SPANS = [span(0, 13_000, "moving"), span(13_000, 13_240, "waiting")];

describe("why", () => {
  it("lays the last ten minutes out from the left to now", () => {
    const pieces = piecesOf(SPANS, 13_240, 0.05);
    expect(pieces.map(({ from }) => from)).toEqual([0, 0.98]);
    expect(pieces[1]?.length).toBeCloseTo(0.02);
    expect(piecesOf(SPANS, 60_000, 0.05)).toEqual([]);
  });

  it("passes pauses over, and knows when a tick was", () => {
    // A second, a pause of a minute, another second at half the pace.
    const moments = [
      [100, 5e6],
      [120, 6e6],
      [121, 66e6],
      [141, 68e6],
    ] as const;
    expect([90, 110, 120, 131, 150].map((tick) => momentOf(moments, tick))).toEqual([
      5e6, 5.5e6, 6e6, 67e6, 68e6,
    ]);
    expect(momentOf([], 5)).toBeNull();
  });

  it("names who held it and for how long", () => {
    const [stop] = stopsOf(SPANS, 5);
    expect(stopsOf([...SPANS, span(13_240, 13_245, "waiting")], 5)).toEqual([stop]);
    expect(stop && spanText(stop)).toBe("waiting for 12 s, Anna, 0.8 m away");
    expect(spanText(SPANS[0] ?? span(0, 0, ""))).toBe("moving for 10 min 50 s");
    expect(shares(SPANS)[0]).toEqual(["moving", 650]);
  });
});

describe("reasons", () => {
  it("have a word and two colours each, and unknown ones have a word", () => {
    for (const reason of REASONS) {
      expect(reasonColour(reason, false)).not.toBe(reasonColour(reason, true));
    }
    expect(reasonText("looking_around")).toBe("looking around");
  });
});

const cost = (time: number, risk: number): Cost => ({
  time,
  risk,
  others: 0,
  turn: 0,
  wall: 0,
  hurry: 0,
  keep_right: 0,
  total: time + risk,
});
const priced = (of: Cost): PricedPath => ({ path: [], cost: of, mean_risk: 0, legal: true });
const TRACE: Trace = {
  actor: "main/actor-1",
  tick: 5,
  exact: true,
  status: "found",
  expansions: 2,
  budget: 70,
  nodes: [
    [0, 0, 1, 0, -1, 0, 0],
    [1, 0, 1, 0.5, 0, 1, 1],
    [2, 0, 1, 1, 1, 2, -1],
  ],
  left_out: 3,
  path: [
    [0, 0, 1, 0],
    [2, 0, 1, 1],
  ],
  cost: cost(4, 1),
  previous: priced(cost(4, 2)),
  searched: priced(cost(4, 1)),
  perturbed: priced(cost(5, 0.5)),
  why: { code: "search", text: "the search found a path", arguments: {} },
  // The float 0.5, little-endian.
  risk: [{ t_s: 0, width: 1, height: 1, cell_m: 1, origin_m: [0, 0], values: "AAAAPw==" }],
  blocker: null,
};
const COLOURS = { taken: "blue", before: "grey" };

describe("search tree", () => {
  it("has a line to each node from the one before, by when it was expanded", () => {
    expect(countNodes(TRACE)).toEqual({ expanded: 2, open: 4 });
    const segments = segmentsOf(TRACE, "order");
    expect(segments.flatMap(({ pairs }) => pairs)).toHaveLength(2);
    expect(new Set(segments.map(({ colour }) => colour)).size).toBe(2);
  });

  it("has other colours by time ahead, for nodes left open too", () => {
    const colours = segmentsOf(TRACE, "time").map(({ colour }) => colour);
    expect(colours).toHaveLength(2);
    expect(colours.every((colour) => colour.startsWith("hsl"))).toBe(true);
  });

  it("shows a slice of the risk at the height of the search, in colours of all slices", () => {
    const overlay = traceOverlay(TRACE, { slice: 0, by: "order" }, COLOURS);
    expect(overlay.raster?.z_m).toBe(1);
    expect(overlay.raster?.most).toBe(0.5);
    expect(traceOverlay(TRACE, { slice: 7, by: "order" }, COLOURS).raster).toBeUndefined();
  });

  it("draws the path taken, and the one before dashed", () => {
    const { lines } = traceOverlay(TRACE, { slice: 0, by: "order" }, COLOURS);
    expect(lines.map(({ colour, dashed }) => [colour, dashed])).toEqual([
      ["grey", true],
      ["blue", false],
    ]);
  });
});

describe("costs", () => {
  it("stand beside each other, each path but once", () => {
    const columns = comparedPaths(TRACE);
    expect(columns.map(({ title }) => title)).toEqual(["taken", "before", "bent"]);
    expect(barPart(5, columns)).toBe(1);
    expect(barPart(1, columns)).toBe(0.2);
    expect(barPart(null, columns)).toBe(0);
    expect(secondsOf(null)).toBe("∞");
  });
});

describe("compare", () => {
  it("tells what differs first", () => {
    const own = { value: 12, level: "own", group: null } as const;
    const usual = { value: 8, level: "default", group: null } as const;
    const rows = compare([
      { a: usual, b: own },
      { a: usual, b: usual },
    ]);
    expect(rows.map(({ name, differs }) => [name, differs])).toEqual([
      ["b", true],
      ["a", false],
    ]);
    expect(valueText(0.123456)).toBe("0.123");
    expect(valueText(undefined)).toBe("–");
  });
});
