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

it("runs at the pace of the world, and goes on from there without a leap", () => {
  const clock = new ServerClock();
  clock.seed(50, 3);
  clock.add(3, 3.1, 50.05);
  clock.pace(0.25, 52, 5);
  expect(clock.at(5)).toBeCloseTo(52 + 0.25 * 0.05);
  expect(clock.at(9)).toBeCloseTo(53, 1);
  clock.add(9, 9.2, 53.025);
  expect(clock.at(9.2)).toBeCloseTo(53.05);
});

it("stands in a pause, but for the ticks that are run meanwhile", () => {
  const clock = new ServerClock();
  clock.seed(50, 3);
  clock.pace(0, 52, 5);
  expect(clock.at(100)).toBe(52);
  clock.add(100, 100.1, 52.05);
  clock.add(101, 101.3, 52.1);
  expect(clock.at(200)).toBe(52.1);
});
