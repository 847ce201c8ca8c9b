import type { Quaternion, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { unpackSteps } from "../../src/net/steps";
import { type Body, body, solve } from "../../src/world/body";
import { posture } from "../../src/world/posture";
import * as skeleton from "../../src/world/skeleton";
import { readyToDraw, underWay } from "../../src/world/steps";
import vectors from "../fixtures/steps.json";

const NEAR = 8;

const bytes = (hex: string): Uint8Array =>
  Uint8Array.from(hex.match(/../g) ?? [], (pair) => parseInt(pair, 16));
const numbers = ({ x, y, z }: Vector3): number[] => [x, y, z];
const unsigned = ({ w, x, y, z }: Quaternion): number[] =>
  [w, x, y, z].map((value) => value * Math.sign(w));
const both = <T>({ left, right }: Body, part: (side: Body["left"]) => T): [T, T] => [
  part(left),
  part(right),
];

function expectNear(actual: number[], expected: number[], what: string): void {
  expect(actual.length, what).toBe(expected.length);
  actual.forEach((value, i) => {
    expect(value, `${what} ${i}`).toBeCloseTo(expected[i] ?? NaN, NEAR);
  });
}

describe("the skeleton", () => {
  it("is the server's", () => {
    const { TRACK_HALF_WIDTH, HIP_DEPTH, HEAD_TOP, STATURE, ...alike } = vectors.skeleton;
    expect(skeleton).toMatchObject({
      ...alike,
      HIP_ASIDE: TRACK_HALF_WIDTH,
      LUMBAR_UP: HIP_DEPTH,
      HEAD_UP: HEAD_TOP,
    });
    expect(skeleton.statureOf(skeleton.buildOf(1, STATURE))).toBeCloseTo(STATURE);
    expect(skeleton.buildOf(1, STATURE).trunkM).toBeCloseTo(1);
  });
});

describe("a step under way", () => {
  it.each(vectors.cases.map((each, i) => [i, each] as const))(
    "has the joints that the server gives it, case %i",
    (_i, { record, leg_m, stature_m, poses }) => {
      const build = skeleton.buildOf(leg_m, stature_m);
      const [known] = unpackSteps(bytes(record));
      if (!known) throw new Error("a record");
      const step = readyToDraw(known, build);
      const [from, joints] = [posture(), body()];
      for (const { u, ...expected } of poses) {
        underWay(step, u, build, from);
        solve(from, build, joints);
        const at = `at ${u}:`;
        expectNear(numbers(joints.root), expected.root, `${at} root`);
        expectNear(unsigned(joints.pelvis), unsign(expected.pelvis), `${at} pelvis`);
        expectNear(unsigned(joints.chest), unsign(expected.chest), `${at} chest`);
        expectNear(numbers(joints.lumbar), expected.lumbar, `${at} lumbar`);
        expectNear(numbers(joints.neck), expected.neck, `${at} neck`);
        for (const [part, name] of [
          [({ leg }: Body["left"]) => leg.start, "hips"],
          [({ leg }: Body["left"]) => leg.hinge, "knees"],
          [({ leg }: Body["left"]) => leg.end, "ankles"],
          [({ foot }: Body["left"]) => foot.toe, "toes"],
          [({ arm }: Body["left"]) => arm.start, "shoulders"],
          [({ arm }: Body["left"]) => arm.hinge, "elbows"],
          [({ arm }: Body["left"]) => arm.end, "hands"],
        ] as const) {
          expectNear(
            both(joints, (side) => numbers(part(side))).flat(),
            expected[name].flat(),
            `${at} ${name}`,
          );
        }
        expectNear(
          both(joints, ({ foot }) => foot.pitch),
          expected.pitches,
          `${at} pitches`,
        );
      }
    },
  );
});

function unsign(quaternion: number[]): number[] {
  const sign = Math.sign(quaternion[0] ?? 1);
  return quaternion.map((value) => value * sign);
}
