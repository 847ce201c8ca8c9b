/**
 * Everything that hides the own avatar gives way. Slabs overhead dissolve with all that stands on
 * them, around the avatar and on the way from there to the camera. Walls on the camera's side of the
 * avatar are cut down to stubs.
 *
 * Every piece of the town carries the height at which it begins (attribute `base`), so that a tall
 * house on the ground stays whole while the room upstairs goes away as one, and the height that is
 * left of it above the avatar's feet (attribute `stub`). Pieces dissolve by leaving out pixels in a
 * fixed pattern, so that nothing needs to be sorted.
 */

import { BufferAttribute, type BufferGeometry, type Material, Vector2 } from "three";

/** A piece that begins lower above the feet stays, one that begins higher goes. */
const STAYS_M = 1.7;
const GOES_M = 2.4;
/** Pieces go altogether this near to the line from the avatar to the camera, and stay beyond. */
const NEAR_M = 22;
const FAR_M = 30;
const FADE_S = 0.18;
/** Walls are cut from this far towards the camera. */
const BEFORE_M = { from: 0.05, to: 0.4 };
/** They are cut this far to both sides of the line to the camera; crowns of trees go as a whole. */
const BESIDE_M = { from: 8, to: 11 };
const CROWN_BESIDE_M = { from: 2.2, to: 3.4 };
/** The cut is as sharp as this. */
const EDGE_M = 0.04;
/** `stub` of a piece that is never cut. */
const WHOLE_M = 1000;
/** A piece that is gone stays away for this long, so that passing a beam does not flicker. */
const LINGER_S = 0.7;

interface Spot {
  x: number;
  y: number;
  z: number;
}

export class Cutaway {
  private readonly uniforms = {
    cutFeet: { value: 0 },
    cutStrength: { value: 0 },
    cutFrom: { value: new Vector2() },
    cutTo: { value: new Vector2() },
  };
  private sinceS = LINGER_S;

  /** Call this once a frame; `hidden` says whether anything is above the avatar or before it. */
  update(feet: Spot, camera: Spot, hidden: boolean, frameS: number): void {
    const { cutFeet, cutStrength, cutFrom, cutTo } = this.uniforms;
    cutFeet.value = feet.z;
    cutFrom.value.set(feet.x, feet.y);
    cutTo.value.set(camera.x, camera.y);
    this.sinceS = hidden ? 0 : this.sinceS + frameS;
    const wanted = this.sinceS < LINGER_S ? 1 : 0;
    cutStrength.value += (wanted - cutStrength.value) * (1 - Math.exp(-frameS / FADE_S));
  }

  /** Whether a piece that begins at this height is high enough above the avatar to go. */
  isAbove(baseM: number): boolean {
    return baseM > this.uniforms.cutFeet.value + (STAYS_M + GOES_M) / 2;
  }

  /** The share of a piece that is left at a point: 1 is all, 0 nothing. */
  remains({ x, y, z }: Spot, { baseM, stubM }: Cut): number {
    const { cutFeet, cutFrom, cutTo } = this.uniforms;
    const [a, b] = [cutFrom.value, cutTo.value];
    const length = Math.max(Math.hypot(b.x - a.x, b.y - a.y), 1e-6);
    const [dx, dy] = [(b.x - a.x) / length, (b.y - a.y) / length];
    const before = (x - a.x) * dx + (y - a.y) * dy;
    const beside = Math.abs((y - a.y) * dx - (x - a.x) * dy);
    const cut =
      smoothstep(BEFORE_M.from, BEFORE_M.to, before) *
      (1 - smoothstep(BESIDE_M.from, BESIDE_M.to, beside)) *
      smoothstep(stubM, stubM + EDGE_M, z - cutFeet.value);
    return this.shown(x, y, baseM) * (1 - cut);
  }

  /** The share that is left at (x, y) of a piece that begins at this height: 1 is all, 0 nothing. */
  shown(x: number, y: number, baseM: number): number {
    const { cutFeet, cutStrength, cutFrom, cutTo } = this.uniforms;
    const high = smoothstep(STAYS_M, GOES_M, baseM - cutFeet.value);
    if (high === 0) return 1;
    const [a, b] = [cutFrom.value, cutTo.value];
    const [dx, dy] = [b.x - a.x, b.y - a.y];
    const along = ((x - a.x) * dx + (y - a.y) * dy) / Math.max(dx * dx + dy * dy, 1e-6);
    const part = Math.max(0, Math.min(1, along));
    const off = Math.hypot(x - a.x - part * dx, y - a.y - part * dy);
    return 1 - cutStrength.value * high * (1 - smoothstep(NEAR_M, FAR_M, off));
  }

  /**
   * Let a material of geometries that are `based` take part; if they are also `gathered`, each
   * piece as a whole.
   */
  applyTo(material: Material, gathered = false): void {
    const before = material.onBeforeCompile.bind(material);
    material.onBeforeCompile = (shader, renderer) => {
      before(shader, renderer);
      Object.assign(shader.uniforms, this.uniforms);
      shader.vertexShader = shader.vertexShader
        .replace("void main() {", `${VARYINGS}${ATTRIBUTES}void main() {`)
        .replace("#include <project_vertex>", `#include <project_vertex>\n${passOn(gathered)}`);
      shader.fragmentShader = shader.fragmentShader.replace(
        "void main() {",
        `${VARYINGS}${UNIFORMS}${remains(gathered)}void main() {${DISSOLVE}`,
      );
    };
    // Materials that are alike but for this must not share a program.
    const key = `cutaway ${material.constructor.name} ${String(gathered)}`;
    material.customProgramCacheKey = () => key;
  }
}

/** The height at which a piece begins, and what is left of it above the feet where it is cut. */
export interface Cut {
  baseM: number;
  stubM: number;
}

/** The geometry, whose every corner knows how its piece is cut; without `stubM` it never is. */
export function based(
  geometry: BufferGeometry,
  baseM: number,
  stubM: number = WHOLE_M,
): BufferGeometry {
  const count = geometry.getAttribute("position").count;
  for (const [name, value] of [
    ["base", baseM],
    ["stub", stubM],
  ] as const) {
    geometry.setAttribute(name, new BufferAttribute(new Float32Array(count).fill(value), 1));
  }
  return geometry;
}

/** The geometry, whose every corner knows the middle of what it belongs to. */
export function gathered(
  geometry: BufferGeometry,
  [x, y]: readonly [number, number],
): BufferGeometry {
  const count = geometry.getAttribute("position").count;
  const middles = Float32Array.from({ length: 2 * count }, (_, i) => (i % 2 === 0 ? x : y));
  geometry.setAttribute("middle", new BufferAttribute(middles, 2));
  return geometry;
}

/** The cut of the piece that a corner belongs to. */
export function cutOf(geometry: BufferGeometry, corner: number): Cut {
  const [base, stub] = [geometry.getAttribute("base"), geometry.getAttribute("stub")];
  return { baseM: base.getX(corner), stubM: stub.getX(corner) };
}

/** Whether a piece gives way when it is between camera and avatar. */
export const givesWay = ({ stubM }: Cut): boolean => stubM < WHOLE_M;

function smoothstep(from: number, to: number, value: number): number {
  const part = Math.max(0, Math.min(1, (value - from) / (to - from)));
  return part * part * (3 - 2 * part);
}

const glsl = (metres: number): string => metres.toFixed(2);

const VARYINGS = `
varying vec2 cutPiece;
varying vec3 cutPlace;
`;

const ATTRIBUTES = `
attribute float base;
attribute float stub;
attribute vec2 middle;
`;

const passOn = (gathered: boolean): string => `
  cutPiece = vec2(base, stub);
  cutPlace = (modelMatrix * vec4(transformed, 1.0)).xyz;
  ${gathered ? "cutPlace.xy = middle;" : ""}
`;

const UNIFORMS = `
uniform float cutFeet;
uniform float cutStrength;
uniform vec2 cutFrom;
uniform vec2 cutTo;
`;

const remains = (gathered: boolean): string => {
  const { from, to } = gathered ? CROWN_BESIDE_M : BESIDE_M;
  return `
float cutOrder(vec2 cell) { return mod(2.0 * cell.x + 3.0 * cell.y, 4.0); }

float cutShown() {
  vec2 way = cutTo - cutFrom;
  vec2 place = cutPlace.xy - cutFrom;
  float high = smoothstep(${glsl(STAYS_M)}, ${glsl(GOES_M)}, cutPiece.x - cutFeet);
  float part = clamp(dot(place, way) / max(dot(way, way), 1e-6), 0.0, 1.0);
  float near = 1.0 - smoothstep(${glsl(NEAR_M)}, ${glsl(FAR_M)}, distance(place, part * way));
  vec2 ahead = way / max(length(way), 1e-6);
  float before = smoothstep(${glsl(BEFORE_M.from)}, ${glsl(BEFORE_M.to)}, dot(place, ahead));
  float beside = abs(place.y * ahead.x - place.x * ahead.y);
  float cut = before * (1.0 - smoothstep(${glsl(from)}, ${glsl(to)}, beside))
    * smoothstep(cutPiece.y, cutPiece.y + ${glsl(EDGE_M)}, cutPlace.z - cutFeet);
  return (1.0 - cutStrength * high * near) * (1.0 - cut);
}
`;
};

/** Sixteen thresholds in a square of four by four pixels. */
const DISSOLVE = `
  vec2 cutCell = mod(floor(gl_FragCoord.xy), 4.0);
  float cutRank = 4.0 * cutOrder(mod(cutCell, 2.0)) + cutOrder(floor(cutCell / 2.0));
  if ((cutRank + 0.5) / 16.0 > cutShown()) discard;
`;
