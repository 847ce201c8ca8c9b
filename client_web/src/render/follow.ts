/** The camera that follows the own avatar: turned by dragging, kept out of buildings. */

import { type Mesh, type PerspectiveCamera, Raycaster, Vector3 } from "three";
import type { Pose } from "../world/interpolation";
import { type Cutaway, cutOf, givesWay } from "./cutaway";

const NEAREST_M = 2;
const FARTHEST_M = 30;
const LOWEST = 0.08;
const HIGHEST = 1.35;
/** It looks at this height above the feet: at the hips from near by, over the head from afar. */
const LOOK_NEAR_M = 1.0;
const LOOK_FAR_M = 1.9;
const FAR_M = 8;
const FOLLOW_PER_S = 10;
const OUT_PER_S = 3;
const TURN_PER_S = 5;
/** Nobody sees a turn by so many radians. */
const TURNED = 0.01;
/** Kept between the camera and the wall behind it. */
const GAP_M = 0.3;

export class FollowCamera {
  /** Direction in which the camera looks on the ground, radians from +x. */
  yaw = Math.PI / 2;
  /** The direction to which the camera turns by itself; null while it does not. */
  private wantedYaw: number | null = null;
  private pitch = 0.36;
  private distanceM = 9;
  private freeM = FARTHEST_M;
  private readonly aim = new Vector3();
  private readonly back = new Vector3();
  private readonly ray = new Raycaster();
  private placed = false;

  /** `calm` turns at once instead of moving. */
  constructor(
    private readonly camera: PerspectiveCamera,
    private readonly calm = false,
  ) {}

  /** Turn by angles in radians. */
  orbit(yaw: number, pitch: number): void {
    if (yaw !== 0) this.wantedYaw = null;
    this.yaw += yaw;
    this.pitch = Math.max(LOWEST, Math.min(HIGHEST, this.pitch + pitch));
  }

  /** Turn, in a moment, until the camera looks over the own avatar at a point of the ground. */
  turnTo({ x, y }: { x: number; y: number }): void {
    this.wantedYaw = Math.atan2(y - this.aim.y, x - this.aim.x);
  }

  /** Come nearer (`factor` < 1) or go back. */
  zoom(factor: number): void {
    this.distanceM = Math.max(NEAREST_M, Math.min(FARTHEST_M, this.distanceM * factor));
  }

  /** The distance of the camera from the point that it looks at, metres. */
  get reachM(): number {
    return Math.min(this.distanceM, this.freeM);
  }

  /** Follow; says whether something that can be cut away stands between camera and avatar. */
  update({ x, y, z }: Pose, occluders: readonly Mesh[], cutaway: Cutaway, frameS: number): boolean {
    const part = this.placed ? Math.min(1, FOLLOW_PER_S * frameS) : 1;
    this.aim.x += (x - this.aim.x) * part;
    this.aim.y += (y - this.aim.y) * part;
    const far = Math.min(1, (this.distanceM - NEAREST_M) / (FAR_M - NEAREST_M));
    const lookM = LOOK_NEAR_M + (LOOK_FAR_M - LOOK_NEAR_M) * far;
    this.aim.z += (z + lookM - this.aim.z) * part;
    this.placed = true;
    this.turn(frameS);
    const flat = Math.cos(this.pitch);
    this.back.set(-Math.cos(this.yaw) * flat, -Math.sin(this.yaw) * flat, Math.sin(this.pitch));
    this.ray.set(this.aim, this.back);
    this.ray.far = this.distanceM + GAP_M;
    let freeM = this.distanceM;
    let hidden = false;
    for (const hit of this.ray.intersectObjects<Mesh>([...occluders], false)) {
      const cut = cutOf(hit.object.geometry, hit.face?.a ?? 0);
      if (cutaway.isAbove(cut.baseM)) {
        hidden = true;
        continue;
      }
      if (givesWay(cut)) continue;
      freeM = Math.max(0.6, hit.distance - GAP_M);
      break;
    }
    // In at once, out slowly, so that a pillar passing by does not make it jerk.
    this.freeM =
      freeM < this.freeM
        ? freeM
        : this.freeM + (freeM - this.freeM) * Math.min(1, OUT_PER_S * frameS);
    this.camera.position.copy(this.aim).addScaledVector(this.back, this.reachM);
    this.camera.lookAt(this.aim);
    return hidden;
  }

  private turn(frameS: number): void {
    if (this.wantedYaw === null) return;
    const left = this.wantedYaw - this.yaw;
    const turn = Math.atan2(Math.sin(left), Math.cos(left));
    this.yaw += turn * (this.calm ? 1 : Math.min(1, TURN_PER_S * frameS));
    if (Math.abs(turn) < TURNED) this.wantedYaw = null;
  }
}
