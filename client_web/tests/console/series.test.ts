import { describe, expect, it } from "vitest";

import { SeriesWindow } from "../../src/console/models/series";

const S = 1e6;

describe("a window of series", () => {
  it("goes on from what the server kept, with gaps where a name is new", () => {
    const window = new SeriesWindow(1, 600);
    window.load({ at_us: [S, 2 * S], values: { people: [1, 2] } });
    window.append(3 * S, { people: 3, actors: 9 });
    expect(window.data(["people", "actors", "unknown"])).toEqual([
      [1, 2, 3],
      [1, 2, 3],
      [null, null, 9],
      [null, null, null],
    ]);
  });

  it("puts the seconds of a longer step into it, and forgets what is older than its span", () => {
    const window = new SeriesWindow(10, 30);
    for (let second = 0; second <= 60; second += 1) window.append(second * S, { people: second });
    expect(window.data(["people"])).toEqual([
      [40, 50, 60],
      [49, 59, 60],
    ]);
  });

  it("takes no figure of the past", () => {
    const window = new SeriesWindow(1, 60);
    window.append(5 * S, { people: 1 });
    window.append(4 * S, { people: 2 });
    expect(window.length).toBe(1);
  });

  it("has a mark for every change, once, and finds those near the pointer", () => {
    const window = new SeriesWindow(1, 60);
    window.append(5 * S, { people: 1 });
    const mark = { atUs: 4.5 * S, text: "risk_weight 12", account: "olga" };
    window.mark(mark);
    window.mark(mark);
    expect(window.marks).toEqual([mark]);
    expect(window.near(5, 1)).toEqual([mark]);
    expect(window.near(9, 1)).toEqual([]);
  });
});
