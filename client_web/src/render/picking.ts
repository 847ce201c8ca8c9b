/** What is under a point of the screen: an avatar, or a place on the ground. */

import { type Mesh, type PerspectiveCamera, Plane, Raycaster, Vector2, Vector3 } from "three";
import type { Avatar } from "../world/world";
import { statureM } from "./figures";

export interface ScreenPoint {
  /** Device-independent: -1…1 to the right and up. */
  x: number;
  y: number;
}

const REACH_M = 60;
/** How far beside a figure one may click, metres in the world plus a part of the screen's height. */
const BESIDE_M = 0.3;
const BESIDE_SCREEN = 0.015;
const GROUND = new Plane(new Vector3(0, 0, 1), 0);

export class Picking {
  private readonly ray = new Raycaster();
  private readonly pointer = new Vector2();
  private readonly foot = new Vector3();
  private readonly head = new Vector3();
  private readonly beside = new Vector3();

  constructor(private readonly camera: PerspectiveCamera) {}

  /** The avatar whose figure is hit, the nearest of several; never the own one. */
  avatar(at: ScreenPoint, avatars: ReadonlyMap<number, Avatar>): Avatar | null {
    this.aim(at);
    let best: { avatar: Avatar; distanceM: number } | null = null;
    for (const avatar of avatars.values()) {
      if (avatar.own) continue;
      const { x, y } = avatar.pose;
      this.foot.set(x, y, 0);
      this.head.set(x, y, statureM(avatar.id));
      const besideSq = this.ray.ray.distanceSqToSegment(
        this.foot,
        this.head,
        undefined,
        this.beside,
      );
      const distanceM = this.camera.position.distanceTo(this.foot);
      const allowedM = BESIDE_M + BESIDE_SCREEN * distanceM;
      if (distanceM > REACH_M || besideSq > allowedM ** 2) continue;
      if (!best || distanceM < best.distanceM) best = { avatar, distanceM };
    }
    return best?.avatar ?? null;
  }

  /** The point on the ground that is meant, at the foot of what is in the way; null for the sky. */
  ground(at: ScreenPoint, occluders: readonly Mesh[]): { x: number; y: number } | null {
    this.aim(at);
    const hit = this.ray.intersectObjects([...occluders], false)[0];
    const point = hit?.point ?? this.ray.ray.intersectPlane(GROUND, this.foot);
    if (!point || point.distanceTo(this.camera.position) > 2 * REACH_M) return null;
    return { x: point.x, y: point.y };
  }

  private aim({ x, y }: ScreenPoint): void {
    this.ray.setFromCamera(this.pointer.set(x, y), this.camera);
  }
}
