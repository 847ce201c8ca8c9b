import { describe, expect, it } from "vitest";
import { Playout } from "../../src/world/playout";

const TICK_S = 0.05;

/** Snapshots of n ticks that come in late by `latenessS(i)`. */
function fed(n: number, latenessS: (i: number) => number): Playout {
  const playout = new Playout(TICK_S);
  for (let i = 0; i < n; i++) playout.arrived(i * TICK_S, i * TICK_S + latenessS(i));
  return playout;
}

describe("Playout", () => {
  it("stays about 120 ms behind on a good connection", () => {
    expect(fed(200, () => 0.02).delayS).toBeCloseTo(0.12, 2);
  });

  it("stays further behind when snapshots come unevenly", () => {
    const even = fed(200, () => 0.05).delayS;
    const uneven = fed(200, (i) => (i % 2) * 0.1).delayS;
    expect(uneven).toBeGreaterThan(even + 0.04);
  });

  it("takes a clock that is far off for what it is", () => {
    expect(fed(400, () => 30).delayS).toBeCloseTo(30.1, 1);
  });

  it("never runs backwards, and stretches time by a tenth at most", () => {
    const playout = fed(20, () => 0.02);
    let before = playout.advance(1, 0.016);
    for (let frame = 1; frame < 300; frame++) {
      const serverNowS = 1 + frame * 0.016;
      if (frame % 3 === 0) playout.arrived(serverNowS - (frame % 7) * 0.02, serverNowS);
      const now = playout.advance(serverNowS, 0.016);
      expect(now - before).toBeGreaterThanOrEqual(0.016 * 0.9 - 1e-9);
      expect(now - before).toBeLessThanOrEqual(0.016 * 1.1 + 1e-9);
      before = now;
    }
  });

  it("slows down, and does not run backwards, when the server falls behind", () => {
    const playout = fed(20, () => 0.02);
    let before = playout.advance(1, 0.016);
    for (let i = 0; i < 100; i++) playout.arrived(1 + i * TICK_S, 3 + i * TICK_S);
    for (let frame = 1; frame < 300; frame++) {
      const now = playout.advance(1 + frame * 0.016, 0.016);
      expect(now - before).toBeGreaterThanOrEqual(0.016 * 0.5 - 1e-9);
      before = now;
    }
    expect(before).toBeLessThan(1 + 300 * 0.016 - 1);
  });

  it("jumps after a long pause", () => {
    const playout = fed(20, () => 0.02);
    playout.advance(1, 0.016);
    expect(playout.advance(20, 0.25)).toBeCloseTo(20 - playout.delayS);
  });

  it("comes to rest where a paused world stands, and goes on from there", () => {
    const playout = fed(20, () => 0.02);
    let before = playout.advance(1, 0.016);
    for (let frame = 1; frame < 40; frame++) {
      const now = playout.advance(1.08, 0.016, 0);
      expect(now - before).toBeGreaterThanOrEqual(0);
      expect(now - before).toBeLessThanOrEqual(0.016 + 1e-9);
      before = now;
    }
    expect(before).toBeCloseTo(1.08 - playout.delayS);
    const next = playout.advance(1.08, 0.016);
    expect(next - before).toBeLessThanOrEqual(0.016 * 1.1);
  });

  it("draws all ticks of a paused world although the delay has just grown", () => {
    const playout = fed(20, () => 0.02);
    playout.advance(1, 0.016);
    for (let tick = 20; tick < 30; tick++) playout.arrived(tick * TICK_S, tick * TICK_S + 1);
    expect(playout.delayS).toBeGreaterThan(0.7);
    let rested = playout.advance(1, 0.016, 0);
    for (let frame = 1; frame < 40; frame++) rested = playout.advance(1, 0.016, 0);
    let stepped = rested;
    for (let frame = 1; frame < 40; frame++) stepped = playout.advance(1.5, 0.016, 0);
    expect(stepped - rested).toBeCloseTo(0.5);
  });

  it("takes messages to be later in a world that runs faster", () => {
    const playout = fed(200, () => 0.02);
    playout.advance(10, 0.016, 4);
    expect(playout.delayS).toBeGreaterThan(0.08 + 0.1 - 1e-3);
  });
});
