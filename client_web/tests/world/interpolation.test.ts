import { describe, expect, it } from "vitest";
import { Interpolator, type Pose } from "../../src/world/interpolation";

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
    const interpolator = new Interpolator(0, pose(0));
    interpolator.add(0.1, pose(1));
    interpolator.add(0.2, pose(3));
    expect(interpolator.at(0.05, 0.2).x).toBeCloseTo(0.5);
    expect(interpolator.at(0.15, 0.2).x).toBeCloseTo(2);
  });

  it("turns the short way round", () => {
    const interpolator = new Interpolator(0, pose(0, 3));
    interpolator.add(1, pose(0, -3));
    expect(Math.abs(interpolator.at(0.5, 1).heading)).toBeCloseTo(Math.PI);
  });

  it("changes layer half way", () => {
    const interpolator = new Interpolator(0, pose(0));
    interpolator.add(1, { ...pose(1), layer: 1 });
    expect(interpolator.at(0.4, 1).layer).toBe(0);
    expect(interpolator.at(0.6, 1).layer).toBe(1);
  });

  it("stood still in between when nothing was said of it", () => {
    const interpolator = new Interpolator(0, pose(0));
    interpolator.hold(2);
    interpolator.add(2.1, pose(1));
    expect(interpolator.at(1.9, 2.1).x).toBe(0);
    expect(interpolator.at(2.05, 2.1).x).toBeCloseTo(0.5);
  });

  it("stays when newer snapshots say nothing, and coasts for a moment when there are none", () => {
    const interpolator = new Interpolator(0, pose(0));
    interpolator.add(0.1, pose(0.1));
    expect(interpolator.at(0.3, 0.3).x).toBeCloseTo(0.1);
    expect(interpolator.at(0.2, 0.1).x).toBeCloseTo(0.2);
    expect(interpolator.at(9, 0.1).x).toBeCloseTo(0.35);
  });

  it("ignores what comes out of order", () => {
    const interpolator = new Interpolator(1, pose(1));
    interpolator.add(0.5, pose(9));
    expect(interpolator.at(1, 1).x).toBe(1);
  });

  it("keeps a bounded past", () => {
    const interpolator = new Interpolator(0, pose(0));
    for (let i = 1; i <= 1000; i++) interpolator.add(i, pose(i));
    expect(interpolator.at(0, 1000).x).toBeGreaterThan(900);
  });
});
