import { Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { Chain } from "../../src/world/hinges";
import vectors from "../fixtures/reach.json";

const TOLERANCE = 1e-3;
const NEAR = 6;

const point = ([x = NaN, y = NaN, z = NaN]: number[]): Vector3 => new Vector3(x, y, z);

describe.each(["left", "right"] as const)("the %s arm", (side) => {
  const { axes, offsets, lows, highs, start, targets, angles, left_over } = vectors[side];
  const hinges = axes.map((axis, k) => ({
    axis: point(axis),
    offset: point(offsets[k] ?? []),
    low: lows[k] ?? NaN,
    high: highs[k] ?? NaN,
  }));

  it.each(targets.map((target, i) => [i, target] as const))(
    "reaches a target as the server's does, case %i",
    (i, target) => {
      const chain = new Chain(hinges);
      chain.angles.set(start);
      const left = chain.reach(point(target), TOLERANCE, vectors.sweeps);
      expect(left).toBeCloseTo(left_over[i] ?? NaN, NEAR);
      chain.angles.forEach((angle, k) => {
        expect(angle, `angle ${k}`).toBeCloseTo(angles[i]?.[k] ?? NaN, NEAR);
      });
    },
  );
});
