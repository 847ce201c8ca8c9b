import { describe, expect, it } from "vitest";
import { Interpolator, type Pose } from "../../src/world/interpolation";

const TICK_S = 0.05;

const pose = (x: number, heading = 0): Pose => ({
  x,
  y: 0,
  z: 0,
  layer: 0,
  heading,
  speed: 1,
  reason: 0,
});

describe("Interpolator", () => {
  it("goes straight from sample to sample", () => {
    const interpolator = new Interpolator(0, pose(0), TICK_S);
    interpolator.add(0.1, pose(1));
    interpolator.add(0.2, pose(3));
    expect(interpolator.at(0.05, 0.2).x).toBeCloseTo(0.5);
    expect(interpolator.at(0.15, 0.2).x).toBeCloseTo(2);
  });

  it("turns the short way round", () => {
    const interpolator = new Interpolator(0, pose(0, 3), TICK_S);
    interpolator.add(1, pose(0, -3));
    expect(Math.abs(interpolator.at(0.5, 1).heading)).toBeCloseTo(Math.PI);
  });

  it("changes layer half way", () => {
    const interpolator = new Interpolator(0, pose(0), TICK_S);
    interpolator.add(1, { ...pose(1), layer: 1 });
    expect(interpolator.at(0.4, 1).layer).toBe(0);
    expect(interpolator.at(0.6, 1).layer).toBe(1);
  });

  it("stood still until its way to the next place began", () => {
    const interpolator = new Interpolator(0, { ...pose(0), speed: 0 }, TICK_S);
    interpolator.add(2.2, pose(0.2));
    expect(interpolator.at(1.95, 2.2).x).toBe(0);
    expect(interpolator.at(2.1, 2.2).x).toBeCloseTo(0.1);
  });

  it("walked all the time between two records of a walk that came apart", () => {
    const interpolator = new Interpolator(0, pose(0), TICK_S);
    interpolator.add(0.2, pose(0.2));
    interpolator.add(0.4, pose(0.4));
    expect(interpolator.at(0.25, 0.4).x).toBeCloseTo(0.25);
  });

  it("draws a walk whose records come apart later, without a jump, and in time again", () => {
    const interpolator = new Interpolator(0, pose(0), TICK_S);
    let drawnS = 0;
    let toldS = 0;
    let beforeM = 0;
    const walk = (untilS: number, apartS: number) => {
      for (; drawnS < untilS; drawnS += 0.01) {
        const nowS = drawnS + 0.1;
        for (; toldS + apartS <= nowS; toldS += apartS) {
          interpolator.add(toldS + apartS, pose(toldS + apartS));
        }
        const { x } = interpolator.advance(drawnS, nowS, 0.01);
        if (drawnS > 0.1) {
          expect(x - beforeM).toBeGreaterThan(0.008);
          expect(x - beforeM).toBeLessThan(0.012);
        }
        beforeM = x;
      }
      return beforeM - drawnS;
    };
    expect(walk(1, 0.05)).toBeCloseTo(-0.01, 1);
    expect(walk(4, 0.2)).toBeCloseTo(-0.16, 1);
    expect(walk(7, 0.05)).toBeCloseTo(-0.01, 1);
  });

  it("stays where it stood, and coasts for a moment when nothing more is told of a walk", () => {
    const interpolator = new Interpolator(0, pose(0), TICK_S);
    interpolator.add(0.1, pose(0.1));
    expect(interpolator.at(0.2, 0.1).x).toBeCloseTo(0.2);
    expect(interpolator.at(0.2, 0.3).x).toBeCloseTo(0.2);
    expect(interpolator.at(9, 0.1).x).toBeCloseTo(0.35);
    expect(interpolator.at(0.5, 0.5).x).toBeCloseTo(0.1);
    interpolator.add(0.2, { ...pose(0.2), speed: 0 });
    expect(interpolator.at(0.4, 0.4).x).toBeCloseTo(0.2);
  });

  it("ignores what comes out of order", () => {
    const interpolator = new Interpolator(1, pose(1), TICK_S);
    interpolator.add(0.5, pose(9));
    expect(interpolator.at(1, 1).x).toBe(1);
  });

  it("keeps a bounded past", () => {
    const interpolator = new Interpolator(0, pose(0), TICK_S);
    for (let i = 1; i <= 1000; i++) interpolator.add(i, pose(i));
    expect(interpolator.at(0, 1000).x).toBeGreaterThan(900);
  });
});
