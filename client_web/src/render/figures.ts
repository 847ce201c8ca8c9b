/** All avatars as articulated figures: one instanced mesh for every part of the body. */

import { type Camera, Frustum, Group, Matrix4, MeshLambertMaterial, Sphere } from "three";
import type { Side } from "../world/body";
import type { Look } from "../net/messages";
import { hasSign } from "../world/guides";
import type { Avatar } from "../world/world";
import { Instances } from "./instances";
import { type Clothing, clothingOf } from "./clothing";
import { ACTOR, GUIDE, IRON } from "./palette";
import { type PartName, PARTS } from "./parts";

/** Corners around a limb, of figures near by and far away. */
const FINE_CORNERS = 12;
const COARSE_CORNERS = 6;
/** A coarse figure stays coarse until it is this much nearer, so that it does not flicker. */
const NEARER = 0.88;

/** The clothes of this many avatars are remembered, including some that have left. */
const MOST_KNOWN = 2000;

/** A figure reaches this far from its hips, and its shadow on the ground this far. */
const FIGURE_M = 1.3;
const SHADOW_M = 5;

/** A wider body, as of a cart or a wheelchair, is shown by a rail around the figure, so high up. */
const FIGURE_WIDE_M = 0.4;
const RAIL_UP_M = 0.4;
const LEVEL = { w: 1, x: 0, y: 0, z: 0 };

type PartMeshes = Record<PartName, Instances>;

export class Figures {
  readonly group = new Group();
  private readonly material = new MeshLambertMaterial({ vertexColors: true });
  private readonly fine = this.partMeshes(FINE_CORNERS);
  private readonly coarse = this.partMeshes(COARSE_CORNERS);
  private readonly all = [...Object.values(this.fine), ...Object.values(this.coarse)];
  private readonly clothes = new Map<number, { look: Look | null; clothing: Clothing }>();
  private readonly view = new Frustum();
  private readonly projection = new Matrix4();
  private readonly room = new Sphere();
  private fineM = 0;
  private readonly coarsely = new Set<number>();

  /** Draw every avatar in the picture with the joints that it has in this frame. */
  update(avatars: ReadonlyMap<number, Avatar>, camera: Camera): void {
    if (this.clothes.size > MOST_KNOWN) {
      this.clothes.clear();
      this.coarsely.clear();
    }
    this.lookThrough(camera);
    for (const part of this.all) part.begin();
    for (const avatar of avatars.values()) {
      if (!this.isSeen(avatar)) continue;
      const parts = this.isCoarse(avatar, camera) ? this.coarse : this.fine;
      placeParts(parts, avatar, this.clothesOf(avatar));
    }
    for (const part of this.all) part.finish();
  }

  /** Figures are fine up to this distance. */
  fineUpTo(metres: number): void {
    this.fineM = metres;
  }

  castShadows(cast: boolean): void {
    this.room.radius = cast ? SHADOW_M : FIGURE_M;
    for (const { mesh } of this.all) mesh.castShadow = cast;
  }

  private lookThrough(camera: Camera): void {
    camera.updateMatrixWorld();
    this.projection.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    this.view.setFromProjectionMatrix(this.projection);
  }

  private isSeen({ animator: { body } }: Avatar): boolean {
    const { x, y, z } = body.root;
    this.room.center.set(x, y, z);
    return this.view.intersectsSphere(this.room);
  }

  private isCoarse(
    {
      id,
      animator: {
        body: { root },
      },
    }: Avatar,
    camera: Camera,
  ): boolean {
    const { x, y, z } = camera.position;
    const distanceM = Math.hypot(root.x - x, root.y - y, root.z - z);
    const coarse = distanceM > this.fineM * (this.coarsely.has(id) ? NEARER : 1);
    if (coarse) this.coarsely.add(id);
    else this.coarsely.delete(id);
    return coarse;
  }

  private clothesOf({ id, look }: Avatar): Clothing {
    const known = this.clothes.get(id);
    if (known?.look === look) return known.clothing;
    const clothing = clothingOf(id, look);
    this.clothes.set(id, { look, clothing });
    if (known) for (const part of this.all) part.repaint();
    return clothing;
  }

  /** Free the memory of the graphics card. */
  dispose(): void {
    for (const { mesh } of this.all) {
      mesh.geometry.dispose();
      mesh.dispose();
    }
    this.material.dispose();
  }

  private partMeshes(corners: number): PartMeshes {
    const parts = Object.entries(PARTS).map(([name, shape]) => {
      const part = new Instances(shape(corners), this.material);
      this.group.add(part.mesh);
      return [name, part] as const;
    });
    return Object.fromEntries(parts) as PartMeshes;
  }
}

function placeParts(
  parts: PartMeshes,
  { id, kind, look, animator, pose, radius }: Avatar,
  clothes: Clothing,
): void {
  const {
    body,
    build: { legM, trunkM },
  } = animator;
  parts.pelvis.put(id, clothes.trousers, body.root, body.pelvis, legM);
  parts.torso.put(id, clothes.shirt, body.lumbar, body.chest, trunkM);
  parts.head.put(id, clothes.skin, body.neck, body.head, trunkM);
  const { hairdo } = clothes;
  if (hairdo) parts[hairdo].put(id, clothes.hair, body.neck, body.head, trunkM);
  if (kind === "actor") parts.hat.put(id, ACTOR, body.neck, body.head, trunkM);
  if (hasSign(look)) parts.sign.put(id, GUIDE, body.neck, body.head, trunkM);
  if (radius > FIGURE_WIDE_M) {
    const { x, y, z } = pose;
    parts.rail.put(id, IRON, { x, y, z: z + RAIL_UP_M }, LEVEL, radius);
  }
  limbs(parts, id, body.left, clothes, legM, trunkM);
  limbs(parts, id, body.right, clothes, legM, trunkM);
}

function limbs(
  parts: PartMeshes,
  id: number,
  { arm, leg, foot }: Side,
  { shirt, forearm, skin, trousers, shin, shoes }: Clothing,
  legM: number,
  trunkM: number,
): void {
  parts.upperArm.hang(id, shirt, arm.start, arm.hinge, arm.axis, trunkM);
  parts.forearm.hang(id, forearm, arm.hinge, arm.end, arm.axis, trunkM);
  parts.hand.extend(id, skin, arm, trunkM);
  parts.thigh.hang(id, trousers, leg.start, leg.hinge, leg.axis, legM);
  parts.shin.hang(id, shin, leg.hinge, leg.end, leg.axis, legM);
  parts.shoe.stand(id, shoes, foot.heel, foot, foot.pitch, legM);
  parts.toes.stand(id, shoes, foot.toe, foot, foot.pitch + foot.bend, legM);
}
