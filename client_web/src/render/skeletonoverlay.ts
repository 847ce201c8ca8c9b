/**
 * The debug overlay of skeletons: footprints, joints and bones, and the targets of legs and of a
 * pointing arm, before and after their joints are solved.
 */

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DynamicDrawUsage,
  Group,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  MeshBasicMaterial,
  OctahedronGeometry,
  Shape,
  ShapeGeometry,
  type Vector3Like,
} from "three";
import type { Limb } from "../world/body";
import { FOOT } from "../world/skeleton";
import type { Step } from "../world/steps";
import type { Animator } from "../world/animator";
import type { Avatar } from "../world/world";

const MOST_PRINTS = 600;
const MOST_POINTS = 2400;
const MOST_BONES = 1200;
/** It is shown for this many avatars, the first in view. */
const MOST_FIGURES = 60;
const ABOVE_M = 0.012;

const LEFT = new Color("#2f6fb5");
const RIGHT = new Color("#c8413b");
const JOINT = new Color("#ffffff");
const BEFORE = new Color("#ff9d2e");
const AFTER = new Color("#1fc46b");

export class SkeletonOverlay {
  readonly group = new Group();
  private readonly prints = overlay(sole(), 0.75, MOST_PRINTS);
  private readonly points = overlay(new OctahedronGeometry(1), 1, MOST_POINTS);
  private readonly bones = new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ color: "#20242a", depthTest: false, transparent: true }),
  );
  private readonly ends = new Float32Array(MOST_BONES * 6);
  private readonly matrix = new Matrix4();
  /** The step whose footprint was printed last, of each avatar. */
  private readonly printed = new Map<number, Step>();
  private printCount = 0;
  private pointCount = 0;
  private boneCount = 0;

  constructor() {
    const ends = new BufferAttribute(this.ends, 3).setUsage(DynamicDrawUsage);
    this.bones.geometry.setAttribute("position", ends);
    this.bones.frustumCulled = false;
    this.points.renderOrder = this.bones.renderOrder = 10;
    this.group.add(this.prints, this.bones, this.points);
    this.group.visible = false;
  }

  show(shown: boolean): void {
    this.group.visible = shown;
    this.printed.clear();
    this.printCount = 0;
  }

  update(avatars: ReadonlyMap<number, Avatar>): void {
    if (!this.group.visible) return;
    this.pointCount = this.boneCount = 0;
    let figures = 0;
    for (const { id, animator } of avatars.values()) {
      if (figures++ === MOST_FIGURES) break;
      this.print(id, animator);
      this.skeleton(animator);
      this.reaching(animator);
    }
    this.prints.count = Math.min(this.printCount, MOST_PRINTS);
    this.points.count = this.pointCount;
    for (const mesh of [this.prints, this.points]) {
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
    this.bones.geometry.setDrawRange(0, this.boneCount * 2);
    this.bones.geometry.getAttribute("position").needsUpdate = true;
  }

  /** Draw the footprint that a new step leads to; the oldest ones go when there are too many. */
  private print(id: number, { step, build }: Animator): void {
    if (!step || this.printed.get(id) === step) return;
    this.printed.set(id, step);
    const { x, y, z, heading } = step.landing;
    const index = this.printCount++ % MOST_PRINTS;
    const [c, s] = [Math.cos(heading) * build.legM, Math.sin(heading) * build.legM];
    this.matrix.set(c, -s, 0, x, s, c, 0, y, 0, 0, 1, z + ABOVE_M, 0, 0, 0, 1);
    this.prints.setMatrixAt(index, this.matrix);
    this.prints.setColorAt(index, step.rightStands ? LEFT : RIGHT);
  }

  private skeleton({ body }: Animator): void {
    const { root, lumbar, neck, left, right } = body;
    this.bone(root, lumbar);
    this.bone(lumbar, neck);
    for (const { leg, arm, foot } of [left, right]) {
      this.bone(root, leg.start);
      this.limb(leg);
      this.bone(foot.heel, foot.toe);
      this.point(foot.toe, 0.014, JOINT);
      this.bone(neck, arm.start);
      this.limb(arm);
    }
    this.point(lumbar, 0.02, JOINT);
    this.point(neck, 0.02, JOINT);
  }

  private limb({ start, hinge, end }: Limb): void {
    this.bone(start, hinge);
    this.bone(hinge, end);
    for (const joint of [start, hinge]) this.point(joint, 0.02, JOINT);
  }

  /** A target is orange, the solved joint green. */
  private reaching({ posture, body, pointing }: Animator): void {
    this.pair(posture.root, body.root);
    this.pair(posture.left.heel, body.left.leg.end);
    this.pair(posture.right.heel, body.right.leg.end);
    if (!pointing.active) return;
    this.point(pointing.before, 0.02, JOINT);
    this.pair(pointing.wanted, pointing.hand(body));
    this.bone(pointing.before, pointing.wanted);
    if (pointing.target) this.bone(pointing.hand(body), pointing.target);
  }

  private pair(before: Vector3Like, after: Vector3Like): void {
    this.point(before, 0.038, BEFORE);
    this.point(after, 0.026, AFTER);
  }

  private point({ x, y, z }: Vector3Like, sizeM: number, color: Color): void {
    if (this.pointCount === MOST_POINTS) return;
    this.matrix.makeScale(sizeM, sizeM, sizeM).setPosition(x, y, z);
    this.points.setMatrixAt(this.pointCount, this.matrix);
    this.points.setColorAt(this.pointCount++, color);
  }

  private bone(from: Vector3Like, to: Vector3Like): void {
    if (this.boneCount === MOST_BONES) return;
    this.ends.set([from.x, from.y, from.z, to.x, to.y, to.z], this.boneCount++ * 6);
  }
}

/** The outline of a sole, the heel at the origin; in shares of the leg. */
function sole(): BufferGeometry {
  const outline = new Shape();
  outline.moveTo(-0.05, 0);
  outline.bezierCurveTo(-0.05, 0.04, 0.02, 0.045, 0.07, 0.038);
  outline.bezierCurveTo(0.12, 0.04, FOOT, 0.07, FOOT + 0.06, 0.03);
  outline.bezierCurveTo(FOOT + 0.08, 0, FOOT + 0.08, 0, FOOT + 0.06, -0.03);
  outline.bezierCurveTo(FOOT, -0.07, 0.12, -0.04, 0.07, -0.038);
  outline.bezierCurveTo(0.02, -0.045, -0.05, -0.04, -0.05, 0);
  return new ShapeGeometry(outline, 6);
}

function overlay(geometry: BufferGeometry, opacity: number, most: number): InstancedMesh {
  const material = new MeshBasicMaterial({
    transparent: true,
    opacity,
    depthWrite: false,
    depthTest: opacity < 1,
  });
  const mesh = new InstancedMesh(geometry, material, most);
  mesh.frustumCulled = false;
  mesh.count = 0;
  return mesh;
}
