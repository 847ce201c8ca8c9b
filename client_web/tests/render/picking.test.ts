import { Mesh, PerspectiveCamera } from "three";
import { beforeEach, describe, expect, it } from "vitest";
import { based, Cutaway } from "../../src/render/cutaway";
import { Picking } from "../../src/render/picking";
import { box as cuboid } from "../../src/render/shapes";
import { STONE } from "../../src/render/palette";

/** A slab at 3 m over the left half, a post of 1 m on it, and a house on the ground to the right. */
const slab = new Mesh(based(cuboid([-5, 0, 2.9], [10, 20, 0.2], 0, STONE), 2.8));
const post = new Mesh(based(cuboid([-3, 0, 3.5], [1, 1, 1], 0, STONE), 3));
const house = new Mesh(based(cuboid([8, 0, 4], [4, 4, 8], 0, STONE), 0));
const occluders = [slab, post, house];
const NEVER = 1e3;

let camera: PerspectiveCamera;
let cutaway: Cutaway;
let picking: Picking;

/** The place on the screen of a point of the world. */
const screen = (x: number, y: number, z: number): { x: number; y: number } =>
  camera.position.clone().set(x, y, z).project(camera);

beforeEach(() => {
  camera = new PerspectiveCamera(55, 1, 0.1, 500);
  camera.up.set(0, 0, 1);
  camera.position.set(-2, -16, 12);
  camera.lookAt(-2, 0, 2);
  camera.updateMatrixWorld();
  for (const mesh of occluders) mesh.updateMatrixWorld();
  cutaway = new Cutaway();
  picking = new Picking(camera);
});

describe("picking a floor", () => {
  it("finds the upper one where it is seen", () => {
    const place = picking.floor(screen(-6, -2, 3), occluders, cutaway);
    expect(place).toEqual({
      x: expect.closeTo(-6) as number,
      y: expect.closeTo(-2) as number,
      z: expect.closeTo(3) as number,
    });
  });

  it("finds the ground below it once it is cut away", () => {
    cutaway.update({ x: -6, y: -2, z: 0 }, camera.position, true, NEVER);
    const place = picking.floor(screen(-6, -2, 0), occluders, cutaway);
    expect(place?.x).toBeCloseTo(-6);
    expect(place?.z).toBeCloseTo(0);
  });

  it("keeps the upper one for who stands on it", () => {
    cutaway.update({ x: -6, y: -2, z: 3 }, camera.position, true, NEVER);
    expect(picking.floor(screen(-6, -2, 3), occluders, cutaway)?.z).toBeCloseTo(3);
  });

  it("takes the foot of what cannot be stood on", () => {
    expect(picking.floor(screen(-3, -0.5, 3.6), occluders, cutaway)?.z).toBe(3);
    expect(picking.floor(screen(8, -2, 5), occluders, cutaway)?.z).toBe(0);
  });

  it("is the bare ground elsewhere, and nothing in the sky", () => {
    expect(picking.floor(screen(3, -5, 0), occluders, cutaway)?.z).toBeCloseTo(0);
    camera.lookAt(-2, 0, 40);
    camera.updateMatrixWorld();
    expect(picking.floor({ x: 0, y: 0 }, occluders, cutaway)).toBeNull();
  });
});

describe("cutting away", () => {
  it("spares what stands on the ground, however tall", () => {
    cutaway.update({ x: 0, y: 0, z: 0 }, camera.position, true, NEVER);
    expect(cutaway.shown(0, 0, 0)).toBe(1);
    expect(cutaway.shown(0, 0, 2.8)).toBeCloseTo(0);
    expect(cutaway.isAbove(2.8)).toBe(true);
  });

  it("spares what is far away", () => {
    cutaway.update({ x: 0, y: 0, z: 0 }, { x: 0, y: -10, z: 8 }, true, NEVER);
    expect(cutaway.shown(60, 0, 2.8)).toBe(1);
    expect(cutaway.shown(0, -12, 2.8)).toBeCloseTo(0);
  });

  it("comes and goes smoothly, and stays a while", () => {
    const feet = { x: 0, y: 0, z: 0 };
    const seen: number[] = [];
    for (let frame = 0; frame < 150; frame++) {
      cutaway.update(feet, camera.position, frame < 30, 1 / 60);
      seen.push(cutaway.shown(0, 0, 2.8));
    }
    expect(seen[0]).toBeGreaterThan(0.85);
    expect(seen[30]).toBeLessThan(0.1);
    expect(seen[60]).toBeLessThan(0.1);
    expect(seen[149]).toBeGreaterThan(0.9);
    const steps = seen.map((now, i) => Math.abs(now - (seen[i - 1] ?? 1)));
    expect(Math.max(...steps)).toBeLessThan(0.15);
  });
});
