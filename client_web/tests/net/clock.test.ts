import { expect, it } from "vitest";
import { ServerClock } from "../../src/net/clock";

it("trusts the quickest of the recent round trips", () => {
  const clock = new ServerClock();
  clock.add(10, 10.5, 100.4);
  clock.add(11, 11.02, 101.01);
  clock.add(12, 12.8, 102.7);
  expect(clock.at(20)).toBeCloseTo(110);
  expect(clock.roundTripS).toBeCloseTo(0.8);
});

it("forgets old round trips, so that it follows a drifting clock", () => {
  const clock = new ServerClock();
  clock.add(0, 0.01, 100.005);
  for (let s = 1; s <= 8; s++) clock.add(s, s + 0.1, 200 + s + 0.05);
  expect(clock.at(10)).toBeCloseTo(210);
});

it("starts from a reading without a round trip", () => {
  const clock = new ServerClock();
  clock.seed(50, 3);
  expect(clock.at(4)).toBe(51);
  expect(clock.roundTripS).toBeNull();
});
