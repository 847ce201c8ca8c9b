/** The material of plants: it thins out where leaves stand between the camera and the own avatar. */

import { MeshLambertMaterial } from "three";

/** Metres that the leaves must be nearer than the avatar to thin out. */
const MARGIN_M = 1;
/** Only leaves this near the middle of the picture, as tangent of the angle. */
const MIDDLE = 0.32;

export class LeavesMaterial extends MeshLambertMaterial {
  private readonly avatarDistance = { value: 0 };

  constructor() {
    super({ vertexColors: true, flatShading: true });
    this.onBeforeCompile = (shader) => {
      shader.uniforms.avatarDistance = this.avatarDistance;
      shader.fragmentShader = shader.fragmentShader
        .replace("void main() {", `uniform float avatarDistance;\nvoid main() {${THIN_OUT}`)
        .replace("avatarMargin", MARGIN_M.toFixed(2))
        .replace("tooNear", TOO_NEAR.toFixed(2))
        .replace("middleTangent", MIDDLE.toFixed(2));
    };
  }

  /** How far the camera is from the avatar, metres. */
  lookingFrom(distanceM: number): void {
    this.avatarDistance.value = distanceM;
  }
}

/** Leaves nearer than this part of the way to the avatar are not drawn at all. */
const TOO_NEAR = 0.45;

/** Three of four pixels, in a fixed pattern, so that nothing needs to be sorted. */
const THIN_OUT = `
  if (vViewPosition.z < tooNear * avatarDistance) discard;
  bool between = vViewPosition.z < avatarDistance - avatarMargin
    && length(vViewPosition.xy) < middleTangent * vViewPosition.z;
  bool kept = mod(floor(gl_FragCoord.x), 2.0) + mod(floor(gl_FragCoord.y), 2.0) < 0.5;
  if (between && !kept) discard;
`;
