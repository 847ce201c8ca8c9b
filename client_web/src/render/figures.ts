/** All avatars as articulated figures: one instanced mesh for every part of the body. */

import {
  type Color,
  DynamicDrawUsage,
  Group,
  InstancedMesh,
  Matrix4,
  MeshLambertMaterial,
} from "three";
import type { Avatar } from "../world/world";
import { NECK_M, type PartName, PARTS, TORSO_M, UPPER_ARM_M } from "./body";
import { SHIN_M, stance, strideM, THIGH_M } from "./gait";
import { ACTOR, clothingOf, scatter } from "./palette";

const CAPACITY_STEP = 64;
const SHOULDER_M = 0.215;
const HIP_SIDE_M = 0.095;
const PACE_SMOOTHING_S = 0.15;
/** A larger step in one frame is no walking. */
const JUMP_M = 1;

const PAIRED: ReadonlySet<PartName> = new Set(["upperArm", "forearm", "thigh", "shin", "shoe"]);

/** What a figure remembers from frame to frame. */
interface Walk {
  x: number;
  y: number;
  phase: number;
  paceMps: number;
}

/** Height of the top of the head, metres. */
export function statureM(id: number): number {
  return 1.76 * scaleOf(id);
}

export class Figures {
  readonly group = new Group();
  private readonly material = new MeshLambertMaterial({ vertexColors: true });
  private meshes: Record<PartName, InstancedMesh> | null = null;
  private capacity = 0;
  private readonly walks = new Map<number, Walk>();
  /** Ids in the order of the instances that carry their colours. */
  private dressed: number[] = [];
  private castShadow = true;

  /** Put every avatar's figure where it is drawn in this frame. */
  update(avatars: ReadonlyMap<number, Avatar>, frameS: number): void {
    const meshes = this.roomFor(avatars.size);
    const ids = [...avatars.keys()];
    if (ids.length !== this.dressed.length || ids.some((id, i) => id !== this.dressed[i])) {
      this.dress(meshes, [...avatars.values()]);
      this.dressed = ids;
    }
    let index = 0;
    for (const avatar of avatars.values()) {
      place(meshes, index++, avatar, this.walked(avatar, frameS));
    }
    for (const [name, mesh] of entries(meshes)) {
      mesh.count = avatars.size * (PAIRED.has(name) ? 2 : 1);
      mesh.instanceMatrix.needsUpdate = true;
    }
    for (const id of this.walks.keys()) if (!avatars.has(id)) this.walks.delete(id);
  }

  castShadows(cast: boolean): void {
    this.castShadow = cast;
    if (this.meshes) for (const [, mesh] of entries(this.meshes)) mesh.castShadow = cast;
  }

  /** Advance the gait by the distance from the last frame. */
  private walked({ id, pose }: Avatar, frameS: number): Walk {
    const walk = this.walks.get(id) ?? { x: pose.x, y: pose.y, phase: scatter(id, 9), paceMps: 0 };
    const distance = Math.hypot(pose.x - walk.x, pose.y - walk.y);
    const part = Math.min(1, frameS / PACE_SMOOTHING_S);
    if (distance < JUMP_M && frameS > 0) {
      walk.paceMps += (distance / frameS - walk.paceMps) * part;
      walk.phase += distance / strideM(walk.paceMps);
    }
    walk.x = pose.x;
    walk.y = pose.y;
    this.walks.set(id, walk);
    return walk;
  }

  private roomFor(count: number): Record<PartName, InstancedMesh> {
    if (this.meshes && count <= this.capacity) return this.meshes;
    if (this.meshes) {
      for (const [, mesh] of entries(this.meshes)) {
        this.group.remove(mesh);
        mesh.geometry.dispose();
        mesh.dispose();
      }
    }
    this.capacity = Math.ceil((count + 1) / CAPACITY_STEP) * CAPACITY_STEP;
    this.dressed = [];
    const names = Object.keys(PARTS) as PartName[];
    this.meshes = Object.fromEntries(names.map((name) => [name, this.instances(name)])) as Record<
      PartName,
      InstancedMesh
    >;
    return this.meshes;
  }

  private instances(name: PartName): InstancedMesh {
    const size = this.capacity * (PAIRED.has(name) ? 2 : 1);
    const mesh = new InstancedMesh(PARTS[name](), this.material, size);
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.castShadow = this.castShadow;
    mesh.frustumCulled = false;
    this.group.add(mesh);
    return mesh;
  }

  private dress(meshes: Record<PartName, InstancedMesh>, avatars: readonly Avatar[]): void {
    avatars.forEach((avatar, i) => {
      const { shirt, trousers, skin, hair, shoes } = clothingOf(avatar.id);
      const colors: Record<PartName, Color> = {
        torso: shirt,
        pelvis: trousers,
        head: skin,
        hair,
        cap: ACTOR,
        upperArm: shirt,
        forearm: skin,
        thigh: trousers,
        shin: trousers,
        shoe: shoes,
      };
      for (const [name, mesh] of entries(meshes)) {
        const times = PAIRED.has(name) ? 2 : 1;
        for (let k = 0; k < times; k++) mesh.setColorAt(i * times + k, colors[name]);
      }
    });
    for (const [, mesh] of entries(meshes)) {
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
  }
}

const root = new Matrix4();
const joint = new Matrix4();
const child = new Matrix4();
const turn = new Matrix4();
const NOTHING = new Matrix4().makeScale(0, 0, 0);

function place(
  meshes: Record<PartName, InstancedMesh>,
  index: number,
  { id, kind, pose }: Avatar,
  walk: Walk,
): void {
  const { hipHeightM, lean, left, right } = stance(walk.phase, walk.paceMps);
  const size = scaleOf(id);
  root.makeRotationZ(pose.heading).setPosition(pose.x, pose.y, pose.z);
  root.multiply(turn.makeScale(size, size, size));

  jointAt(joint, root, 0, hipHeightM, 0);
  meshes.pelvis.setMatrixAt(index, joint);
  jointAt(joint, root, 0, hipHeightM + 0.03, lean);
  meshes.torso.setMatrixAt(index, joint);
  const trunk = joint.clone();
  jointAt(joint, trunk, 0, TORSO_M + NECK_M - 0.05, -lean);
  meshes.head.setMatrixAt(index, joint);
  meshes.hair.setMatrixAt(index, joint);
  meshes.cap.setMatrixAt(index, kind === "actor" ? joint : NOTHING);

  [left, right].forEach(({ leg, arm }, k) => {
    const at = index * 2 + k;
    const side = k === 0 ? 1 : -1;
    // A positive turn about +y swings what hangs down backwards.
    jointAt(joint, trunk, side * SHOULDER_M, TORSO_M, -arm.shoulder - lean);
    meshes.upperArm.setMatrixAt(at, joint);
    jointAt(child, joint, 0, -UPPER_ARM_M, -arm.elbow);
    meshes.forearm.setMatrixAt(at, child);
    jointAt(joint, root, side * HIP_SIDE_M, hipHeightM, -leg.hip);
    meshes.thigh.setMatrixAt(at, joint);
    jointAt(child, joint, 0, -THIGH_M, leg.knee);
    meshes.shin.setMatrixAt(at, child);
    jointAt(joint, child, 0, -SHIN_M, leg.hip - leg.knee - leg.foot);
    meshes.shoe.setMatrixAt(at, joint);
  });
}

/** `into` = `parent`, moved by (0, y, z) and turned about its y axis. */
function jointAt(into: Matrix4, parent: Matrix4, y: number, z: number, angle: number): void {
  turn.makeRotationY(angle).setPosition(0, y, z);
  into.multiplyMatrices(parent, turn);
}

function scaleOf(id: number): number {
  return 0.93 + 0.13 * scatter(id, 8);
}

function entries(meshes: Record<PartName, InstancedMesh>): [PartName, InstancedMesh][] {
  return Object.entries(meshes) as [PartName, InstancedMesh][];
}
