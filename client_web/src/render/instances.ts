/** One part of the body for everybody: an instanced mesh, filled anew in every frame. */

import {
  type BufferGeometry,
  type Color,
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedMesh,
  type Material,
  type QuaternionLike,
  type Vector3Like,
} from "three";
import type { Foot, Limb } from "../world/body";

/** Room for instances grows by this many at a time. */
const LOT = 64;

export class Instances {
  readonly mesh: InstancedMesh;
  private count = 0;
  private matrices = new Float32Array(0);
  private colors = new Float32Array(0);
  /** The avatar of each instance: colours are written only when that changes. */
  private owners = new Float64Array(0);
  private repainted = false;

  constructor(geometry: BufferGeometry, material: Material) {
    this.mesh = new InstancedMesh(geometry, material, LOT);
    this.mesh.frustumCulled = false;
    this.grow();
  }

  begin(): void {
    this.count = 0;
  }

  finish(): void {
    this.mesh.count = this.count;
    // Nothing is drawn of an empty mesh, not even a call.
    this.mesh.visible = this.count > 0;
    this.mesh.instanceMatrix.needsUpdate = true;
    if (this.repainted && this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
    this.repainted = false;
  }

  /** Place a part, turned and scaled. */
  put(
    owner: number,
    color: Color,
    at: Vector3Like,
    { w, x, y, z }: QuaternionLike,
    scale: number,
  ): void {
    this.write(
      this.next(owner, color),
      (1 - 2 * (y * y + z * z)) * scale,
      2 * (x * y + w * z) * scale,
      2 * (x * z - w * y) * scale,
      2 * (x * y - w * z) * scale,
      (1 - 2 * (x * x + z * z)) * scale,
      2 * (y * z + w * x) * scale,
      2 * (x * z + w * y) * scale,
      2 * (y * z - w * x) * scale,
      (1 - 2 * (x * x + y * y)) * scale,
      at,
    );
  }

  /** Place a part that hangs from a joint towards another one. */
  hang(
    owner: number,
    color: Color,
    from: Vector3Like,
    to: Vector3Like,
    axis: Vector3Like,
    scale: number,
  ): void {
    const x = from.x - to.x;
    const y = from.y - to.y;
    const z = from.z - to.z;
    const part = scale / Math.max(1e-9, Math.hypot(x, y, z));
    this.write(
      this.next(owner, color),
      (axis.y * z - axis.z * y) * part,
      (axis.z * x - axis.x * z) * part,
      (axis.x * y - axis.y * x) * part,
      axis.x * scale,
      axis.y * scale,
      axis.z * scale,
      x * part,
      y * part,
      z * part,
      from,
    );
  }

  /** Place a part at the end of a limb's second bone, in line with it. */
  extend(owner: number, color: Color, { hinge, end, axis }: Limb, scale: number): void {
    this.hang(owner, color, hinge, end, axis, scale);
    const at = (this.count - 1) * 16;
    this.matrices[at + 12] = end.x;
    this.matrices[at + 13] = end.y;
    this.matrices[at + 14] = end.z;
  }

  /** Place a foot, or its toes, at a place of the sole. */
  stand(
    owner: number,
    color: Color,
    at: Vector3Like,
    { heading }: Foot,
    pitch: number,
    scale: number,
  ): void {
    const ch = Math.cos(heading);
    const sh = Math.sin(heading);
    const cp = Math.cos(pitch);
    const sp = Math.sin(pitch);
    this.write(
      this.next(owner, color),
      cp * ch * scale,
      cp * sh * scale,
      sp * scale,
      -sh * scale,
      ch * scale,
      0,
      -sp * ch * scale,
      -sp * sh * scale,
      cp * scale,
      at,
    );
  }

  /** Colour all instances anew: somebody wears something else. */
  repaint(): void {
    this.owners.fill(-1);
  }

  /** Index of the next instance, in its owner's colour. */
  private next(owner: number, color: Color): number {
    if (this.count === this.owners.length) this.grow();
    const index = this.count++;
    if (this.owners[index] !== owner) {
      this.owners[index] = owner;
      this.colors[index * 3] = color.r;
      this.colors[index * 3 + 1] = color.g;
      this.colors[index * 3 + 2] = color.b;
      this.repainted = true;
    }
    return index;
  }

  /** The columns of a matrix: forwards, left, up, place. */
  private write(
    index: number,
    fx: number,
    fy: number,
    fz: number,
    lx: number,
    ly: number,
    lz: number,
    ux: number,
    uy: number,
    uz: number,
    at: Vector3Like,
  ): void {
    const { matrices } = this;
    const i = index * 16;
    matrices[i] = fx;
    matrices[i + 1] = fy;
    matrices[i + 2] = fz;
    matrices[i + 3] = 0;
    matrices[i + 4] = lx;
    matrices[i + 5] = ly;
    matrices[i + 6] = lz;
    matrices[i + 7] = 0;
    matrices[i + 8] = ux;
    matrices[i + 9] = uy;
    matrices[i + 10] = uz;
    matrices[i + 11] = 0;
    matrices[i + 12] = at.x;
    matrices[i + 13] = at.y;
    matrices[i + 14] = at.z;
    matrices[i + 15] = 1;
  }

  private grow(): void {
    const capacity = this.owners.length + LOT;
    this.matrices = wider(this.matrices, new Float32Array(capacity * 16));
    this.colors = wider(this.colors, new Float32Array(capacity * 3));
    this.owners = wider(this.owners, new Float64Array(capacity).fill(-1));
    this.repainted = true;
    // The buffers on the graphics card are of the old size.
    this.mesh.dispose();
    this.mesh.instanceMatrix = new InstancedBufferAttribute(this.matrices, 16);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.instanceColor = new InstancedBufferAttribute(this.colors, 3);
  }
}

function wider<T extends Float32Array | Float64Array>(old: T, fresh: T): T {
  fresh.set(old);
  return fresh;
}
