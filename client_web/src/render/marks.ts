/** Marks on the floor: discs under feet, rings of the own and the chosen avatar, the walk's goal. */

import {
  CircleGeometry,
  type ColorRepresentation,
  DynamicDrawUsage,
  Group,
  InstancedMesh,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  RingGeometry,
} from "three";
import type { Pose } from "../world/interpolation";
import type { Avatar } from "../world/world";
import { ACCENT, ACTOR } from "./palette";

const MOST = 512;
const PULSE_S = 1.2;

export class Marks {
  readonly group = new Group();
  private readonly feet = new InstancedMesh(
    new CircleGeometry(0.32, 14),
    flat("#2a2620", 0.28),
    MOST,
  );
  private readonly own = ring(0.4, 0.47, ACCENT, 0.9);
  private readonly chosen = ring(0.46, 0.56, ACTOR, 0.95);
  private readonly target = ring(0.22, 0.32, ACCENT, 0.95);
  private readonly matrix = new Matrix4();
  private targetAgeS = 0;

  constructor(private readonly calm: boolean) {
    this.feet.instanceMatrix.setUsage(DynamicDrawUsage);
    this.feet.frustumCulled = false;
    this.target.visible = this.chosen.visible = this.own.visible = false;
    this.group.add(this.feet, this.own, this.chosen, this.target);
  }

  /** Soft discs stand in for the shadows of figures where those are not drawn. */
  softShadows(show: boolean): void {
    this.feet.visible = show;
  }

  /** Mark the place that the own avatar walks to; null when it has arrived or was called off. */
  walkTarget(at: { x: number; y: number; z: number } | null): void {
    this.target.visible = at !== null;
    if (at) this.target.position.set(at.x, at.y, at.z + 0.03);
    this.targetAgeS = 0;
  }

  update(
    avatars: ReadonlyMap<number, Avatar>,
    own: Pose | undefined,
    chosen: Pose | undefined,
    frameS: number,
  ): void {
    let count = 0;
    for (const { pose } of avatars.values()) {
      if (count === MOST) break;
      this.feet.setMatrixAt(count++, this.matrix.makeTranslation(pose.x, pose.y, pose.z + 0.015));
    }
    this.feet.count = count;
    this.feet.instanceMatrix.needsUpdate = true;
    put(this.own, own, 0.02);
    put(this.chosen, chosen, 0.025);
    this.targetAgeS += frameS;
    const beat = this.calm ? 0 : Math.sin((this.targetAgeS / PULSE_S) * 2 * Math.PI);
    this.target.scale.setScalar(1 + 0.12 * beat);
  }
}

function put(mark: Mesh, pose: Pose | undefined, aboveM: number): void {
  mark.visible = pose !== undefined;
  if (pose) mark.position.set(pose.x, pose.y, pose.z + aboveM);
}

function ring(inner: number, outer: number, color: ColorRepresentation, opacity: number): Mesh {
  return new Mesh(new RingGeometry(inner, outer, 32), flat(color, opacity));
}

function flat(color: ColorRepresentation, opacity: number): MeshBasicMaterial {
  return new MeshBasicMaterial({ color, opacity, transparent: true, depthWrite: false });
}
