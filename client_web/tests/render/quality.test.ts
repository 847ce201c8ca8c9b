import { describe, expect, it } from "vitest";
import { LEVELS, QualityControl } from "../../src/render/quality";

const draw = (control: QualityControl, frames: number, frameS: number): void => {
  for (let i = 0; i < frames; i++) control.frame(frameS);
};

describe("QualityControl", () => {
  it("goes down to the fastest level on a slow machine, and stays there", () => {
    const control = new QualityControl("automatic", false);
    draw(control, 1000, 0.07);
    expect(control.level).toBe(LEVELS.length - 1);
  });

  it("does not make people wait on a very slow one", () => {
    const control = new QualityControl("automatic", false);
    draw(control, 8, 0.5);
    expect(control.level).toBe(LEVELS.length - 1);
  });

  it("stays fine on a quick one", () => {
    const control = new QualityControl("automatic", false);
    draw(control, 5000, 1 / 60);
    expect(control.level).toBe(0);
  });

  it("tries something finer again when frames have been quick for long", () => {
    const control = new QualityControl("automatic", false);
    draw(control, 15, 0.07);
    expect(control.level).toBe(1);
    draw(control, 3000, 1 / 60);
    expect(control.level).toBe(0);
  });

  it("begins with a fast level where there is no graphics card", () => {
    const control = new QualityControl("automatic", true);
    expect(control.quality.shadows).toBe(false);
  });

  it("does not take a hidden page for a slow machine", () => {
    const control = new QualityControl("automatic", false);
    draw(control, 100, 30);
    expect(control.level).toBe(0);
  });

  it("leaves alone what the person chose", () => {
    const fine = new QualityControl("fine", false);
    const fast = new QualityControl("fast", false);
    draw(fine, 500, 0.2);
    draw(fast, 500, 0.001);
    expect([fine.level, fast.level]).toEqual([0, LEVELS.length - 1]);
  });
});
