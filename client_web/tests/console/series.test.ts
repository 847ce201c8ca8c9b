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

  it("leaves longer steps to the server, which knows whether seconds add up in them", () => {
    const window = new SeriesWindow(10, 30);
    window.load({ at_us: [40 * S, 50 * S], values: { contacts: [3, 1] } });
    window.append(60 * S, { contacts: 1, "speed of actor-1": 1.3 });
    expect(window.data(["contacts", "speed of actor-1"])).toEqual([
      [40, 50],
      [3, 1],
      [null, 1.3],
    ]);
    expect(window.endUs(69.5 * S)).toBe(60 * S);
  });

  it("forgets what is older than its span", () => {
    const window = new SeriesWindow(1, 3);
    for (let second = 0; second <= 6; second += 1) window.append(second * S, { people: second });
    expect(window.data(["people"])).toEqual([
      [4, 5, 6],
      [4, 5, 6],
    ]);
  });

  it("keeps what the server does not know when it is asked again", () => {
    const before = new SeriesWindow(1, 600);
    before.load({ at_us: [S], values: { people: [1] } });
    before.append(2 * S, { people: 2, "speed of actor-1": 1.3 });
    const window = new SeriesWindow(1, 600);
    window.load({ at_us: [S, 2 * S, 3 * S], values: { people: [1, 2, 3] } }, before);
    expect(window.data(["speed of actor-1"])[1]).toEqual([null, 1.3, null]);
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
