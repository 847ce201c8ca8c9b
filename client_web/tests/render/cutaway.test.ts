import { describe, expect, it } from "vitest";
import { Cutaway } from "../../src/render/cutaway";

const NEVER = 1e3;
const WALL = { baseM: 0, stubM: 0.35 };
const HOUSE = { baseM: 0, stubM: NEVER };
const UPSTAIRS = { baseM: 3.5, stubM: 0.35 };
/** The avatar in the origin, the camera to the south. */
const cutaway = new Cutaway();
cutaway.update({ x: 0, y: 0, z: 0 }, { x: 0, y: -9, z: 6 }, false, 0);

describe("a piece between camera and avatar", () => {
  it.each<[string, [number, number, number], number]>([
    ["is cut above a stub", [0, -2, 1.5], 0],
    ["keeps the stub", [0, -2, 0.3], 1],
    ["stays behind the avatar", [0, 2, 1.5], 1],
    ["stays right beside the avatar", [2, 0, 1.5], 1],
    ["stays far to the side", [12, -2, 1.5], 1],
  ])("%s", (_what, [x, y, z], left) => {
    expect(cutaway.remains({ x, y, z }, WALL)).toBeCloseTo(left);
  });

  it("is not cut if it is a whole house", () => {
    expect(cutaway.remains({ x: 0, y: -2, z: 1.5 }, HOUSE)).toBe(1);
  });

  it("is measured from the avatar's feet", () => {
    const upstairs = new Cutaway();
    upstairs.update({ x: 0, y: 0, z: 3.5 }, { x: 0, y: -9, z: 9 }, false, 0);
    expect(upstairs.remains({ x: 0, y: -2, z: 3.8 }, UPSTAIRS)).toBeCloseTo(1);
    expect(upstairs.remains({ x: 0, y: -2, z: 4.5 }, UPSTAIRS)).toBeCloseTo(0);
    expect(upstairs.remains({ x: 0, y: -2, z: 3 }, WALL)).toBeCloseTo(1);
  });

  it("is gone whole where it is overhead and hides the avatar", () => {
    const covered = new Cutaway();
    covered.update({ x: 0, y: 0, z: 0 }, { x: 0, y: -9, z: 6 }, true, NEVER);
    expect(covered.remains({ x: 0, y: 2, z: 3.6 }, UPSTAIRS)).toBeCloseTo(0);
  });
});
