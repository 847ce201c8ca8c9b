/** Finds the avatar, the door or the place to walk to under a point of the screen. */

import { type Mesh, type PerspectiveCamera, Plane, Raycaster, Vector2, Vector3 } from "three";
import { crown } from "../world/body";
import type { Avatar } from "../world/world";
import { type Cutaway, cutOf } from "./cutaway";
import type { Town } from "./town";

export interface ScreenPoint {
  /** Device-independent: -1…1 to the right and up. */
  x: number;
  y: number;
}

/** A place to walk to; z is the height of its floor. */
export interface Place {
  x: number;
  y: number;
  z: number;
}

interface Hit {
  point: Vector3;
  distance: number;
  /** The height at which the piece that is hit begins. */
  baseM: number;
  /** Upward part of the face's normal: 1 is level. */
  slope: number;
}

/** A face that slopes more is no floor: 45 degrees. */
const LEVEL = Math.SQRT1_2;
const REACH_M = 60;
const EYES_M = 1.6;
/** One may click this far beside a figure, or on a wider body: metres plus a part of the screen's height. */
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
      const { x, y, z } = avatar.pose;
      this.foot.set(x, y, z);
      crown(avatar.animator.body, avatar.animator.build, this.head);
      const besideSq = this.ray.ray.distanceSqToSegment(
        this.foot,
        this.head,
        undefined,
        this.beside,
      );
      const distanceM = this.camera.position.distanceTo(this.foot);
      const allowedM = Math.max(BESIDE_M, avatar.radius) + BESIDE_SCREEN * distanceM;
      if (distanceM > REACH_M || besideSq > allowedM ** 2) continue;
      if (!best || distanceM < best.distanceM) best = { avatar, distanceM };
    }
    return best?.avatar ?? null;
  }

  /** The name of the door that is hit, if nothing stands before it. */
  door(at: ScreenPoint, { doors, occluders }: Town, cutaway: Cutaway): string | null {
    this.aim(at);
    const door = doors.hit(this.ray);
    if (!door) return null;
    const before = this.firstSeen(occluders, cutaway);
    return before && before.distance < door.distanceM ? null : door.name;
  }

  /**
   * The place on the floor that is seen there, or at the foot of a thing that nobody can stand on.
   * Rays pass through pieces that are cut away. It is null for the sky.
   */
  floor(at: ScreenPoint, occluders: readonly Mesh[], cutaway: Cutaway): Place | null {
    this.aim(at);
    const hit = this.firstSeen(occluders, cutaway);
    const point = hit?.point ?? this.ray.ray.intersectPlane(GROUND, this.foot);
    if (!point || point.distanceTo(this.camera.position) > 2 * REACH_M) return null;
    const { x, y } = point;
    return { x, y, z: hit && hit.slope < LEVEL ? hit.baseM : point.z };
  }

  /** How far one sees from a place, at the height of the eyes, in a direction on the ground. */
  freeM({ x, y, z }: Place, yaw: number, occluders: readonly Mesh[]): number {
    this.ray.set(this.foot.set(x, y, z + EYES_M), this.head.set(Math.cos(yaw), Math.sin(yaw), 0));
    const [hit] = this.ray.intersectObjects<Mesh>([...occluders]);
    return hit ? Math.min(hit.distance, REACH_M) : REACH_M;
  }

  private firstSeen(occluders: readonly Mesh[], cutaway: Cutaway): Hit | null {
    for (const { object, face, point, distance } of this.ray.intersectObjects<Mesh>([
      ...occluders,
    ])) {
      if (!face) continue;
      const cut = cutOf(object.geometry, face.a);
      if (cutaway.remains(point, cut) < 0.5) continue;
      return { point, distance, baseM: cut.baseM, slope: face.normal.z };
    }
    return null;
  }

  private aim({ x, y }: ScreenPoint): void {
    this.ray.setFromCamera(this.pointer.set(x, y), this.camera);
  }
}
