import { describe, expect, it } from "vitest";
import { ANKLE_M, SHIN_M, stance, strideM, THIGH_M } from "../../src/render/gait";

/** Where the ankle of the left leg is, relative to the point below the hips on the ground. */
function ankle(phase: number, speedMps: number): { x: number; z: number } {
  const { hipHeightM, left } = stance(phase, speedMps);
  const { hip, knee } = left.leg;
  return {
    x: THIGH_M * Math.sin(hip) + SHIN_M * Math.sin(hip - knee),
    z: hipHeightM - THIGH_M * Math.cos(hip) - SHIN_M * Math.cos(hip - knee),
  };
}

describe("stance", () => {
  it.each([0.6, 1.2, 1.6])("keeps a standing foot where it is put, at %f m/s", (speed) => {
    const places = [0.1, 0.2, 0.3, 0.4].map(
      (phase) => ankle(phase, speed).x + phase * strideM(speed),
    );
    const slipM = Math.max(...places) - Math.min(...places);
    expect(slipM).toBeLessThan(0.02);
  });

  it("swings the legs in turn", () => {
    const { left, right } = stance(0, 1.4);
    expect(left.leg.hip).toBeGreaterThan(right.leg.hip);
    expect(left.arm.shoulder).toBeLessThan(right.arm.shoulder);
  });

  it("stands upright on both feet when it does not walk", () => {
    for (const phase of [0, 0.3, 0.8]) {
      expect(ankle(phase, 0).x).toBeCloseTo(0);
      expect(ankle(phase, 0).z).toBeCloseTo(ANKLE_M);
    }
  });

  it("never puts a foot into the ground", () => {
    for (let phase = 0; phase < 1; phase += 0.02) {
      expect(ankle(phase, 1.6).z).toBeGreaterThan(ANKLE_M - 1e-6);
    }
  });
});
