import { describe, expect, it } from "vitest";
import { tickTexts } from "../../src/console/models/times";

/** Seconds since 1970 of a time of day where this runs. */
const at = (day: number, hour: number, minute: number, second: number): number =>
  new Date(2026, 10, day, hour, minute, second).getTime() / 1000;

describe("texts under a chart", () => {
  it("are as short as their step allows", () => {
    expect(tickTexts([at(3, 9, 59, 30), at(3, 10, 0, 0)])).toEqual(["09:59:30", "10:00:00"]);
    expect(tickTexts([at(3, 23, 30, 0), at(4, 0, 0, 0)])).toEqual(["23:30", "00:00"]);
    expect(tickTexts([at(3, 0, 0, 0), at(4, 0, 0, 0)])).toEqual(["11-03", "11-04"]);
    expect(tickTexts([])).toEqual([]);
    expect(tickTexts([at(3, 0, 0, 0)])).toEqual(["11-03"]);
  });
});
