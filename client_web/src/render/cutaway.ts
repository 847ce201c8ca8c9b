/**
 * What is above the own avatar and hides it dissolves: slabs overhead and all that stands on them,
 * around the avatar and on the way from there to the camera.
 *
 * Every piece of the town knows the height at which it begins (attribute `base`), so that a tall
 * house on the ground stays whole while the room upstairs goes away as one. Dissolving is
 * leaving out pixels in a fixed pattern, so that nothing needs to be sorted.
 */

import { BufferAttribute, type BufferGeometry, type Material, Vector2 } from "three";

/** What begins less far above the feet stays, what begins farther above goes. */
const STAYS_M = 1.7;
const GOES_M = 2.4;
/** All of it goes so near to the line from the avatar to the camera, and nothing beyond. */
const NEAR_M = 22;
const FAR_M = 30;
const FADE_S = 0.18;
/** Once gone, it stays away for so long, so that passing a beam does not flicker. */
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

  /** Once a frame; `hidden` says whether anything is above the avatar or before it. */
  update(feet: Spot, camera: Spot, hidden: boolean, frameS: number): void {
    const { cutFeet, cutStrength, cutFrom, cutTo } = this.uniforms;
    cutFeet.value = feet.z;
    cutFrom.value.set(feet.x, feet.y);
    cutTo.value.set(camera.x, camera.y);
    this.sinceS = hidden ? 0 : this.sinceS + frameS;
    const wanted = this.sinceS < LINGER_S ? 1 : 0;
    cutStrength.value += (wanted - cutStrength.value) * (1 - Math.exp(-frameS / FADE_S));
  }

  /** Whether what begins at this height is high enough above the avatar to be taken away. */
  isAbove(baseM: number): boolean {
    return baseM > this.uniforms.cutFeet.value + (STAYS_M + GOES_M) / 2;
  }

  /** How much is left of what stands at (x, y) and begins at this height: 1 all, 0 nothing. */
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

  /** Let a material of geometries with a `base` take part. */
  applyTo(material: Material): void {
    const before = material.onBeforeCompile.bind(material);
    material.onBeforeCompile = (shader, renderer) => {
      before(shader, renderer);
      Object.assign(shader.uniforms, this.uniforms);
      shader.vertexShader = shader.vertexShader
        .replace("void main() {", `${VARYINGS}attribute float base;\nvoid main() {`)
        .replace("#include <project_vertex>", `#include <project_vertex>\n${PASS_ON}`);
      shader.fragmentShader = shader.fragmentShader.replace(
        "void main() {",
        `${VARYINGS}${UNIFORMS}${REMAINS}void main() {${DISSOLVE}`,
      );
    };
    // Materials that are alike but for this must not share a program.
    material.customProgramCacheKey = () => `cutaway ${material.constructor.name}`;
  }
}

/** The geometry, whose every corner knows at which height its piece begins. */
export function based(geometry: BufferGeometry, baseM: number): BufferGeometry {
  const count = geometry.getAttribute("position").count;
  geometry.setAttribute("base", new BufferAttribute(new Float32Array(count).fill(baseM), 1));
  return geometry;
}

/** At which height the piece of a hit begins. */
export function baseOf(geometry: BufferGeometry, corner: number): number {
  return geometry.getAttribute("base").getX(corner);
}

function smoothstep(from: number, to: number, value: number): number {
  const part = Math.max(0, Math.min(1, (value - from) / (to - from)));
  return part * part * (3 - 2 * part);
}

const VARYINGS = `
varying float cutBase;
varying vec2 cutPlace;
`;

const PASS_ON = `
  cutBase = base;
  cutPlace = (modelMatrix * vec4(transformed, 1.0)).xy;
`;

const UNIFORMS = `
uniform float cutFeet;
uniform float cutStrength;
uniform vec2 cutFrom;
uniform vec2 cutTo;
`;

const REMAINS = `
float cutOrder(vec2 cell) { return mod(2.0 * cell.x + 3.0 * cell.y, 4.0); }

float cutShown() {
  float high = smoothstep(${STAYS_M.toFixed(2)}, ${GOES_M.toFixed(2)}, cutBase - cutFeet);
  vec2 way = cutTo - cutFrom;
  float part = clamp(dot(cutPlace - cutFrom, way) / max(dot(way, way), 1e-6), 0.0, 1.0);
  float off = distance(cutPlace, cutFrom + part * way);
  float near = 1.0 - smoothstep(${NEAR_M.toFixed(2)}, ${FAR_M.toFixed(2)}, off);
  return 1.0 - cutStrength * high * near;
}
`;

/** Sixteen thresholds in a square of four by four pixels. */
const DISSOLVE = `
  vec2 cutCell = mod(floor(gl_FragCoord.xy), 4.0);
  float cutRank = 4.0 * cutOrder(mod(cutCell, 2.0)) + cutOrder(floor(cutCell / 2.0));
  if ((cutRank + 0.5) / 16.0 > cutShown()) discard;
`;
