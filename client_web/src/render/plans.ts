/** The overlay of an actor's plan: a path with a dot each second, the goal, predicted circles. */

import {
  BufferGeometry,
  CircleGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  Float32BufferAttribute,
  Group,
  InstancedMesh,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  RingGeometry,
} from "three";
import type { Plan } from "../net/messages";
import type { Floors } from "../world/floors";
import { ACTOR } from "./palette";
import { painted } from "./shapes";

const PATH_HALF_M = 0.06;
/** The overlay lies this far above the floor, so that it does not sink into it. */
const RIBBON_M = 0.045;
/** A path that rises more from point to point is laid in pieces. */
const LEVEL_M = 0.03;
const PIECE_M = 0.1;
/** A floor further than this from a path is not the one that it leads over. */
const ON_IT_M = 0.6;
const MOST_DOTS = 128;
const MOST_CIRCLES = 512;
const SOON = new Color("#e2483d");
const LATE = new Color("#f4b942");
/** This many of the predicted circles of a person are drawn, evenly spread. */
const DRAWN_CIRCLES = 6;

export class Plans {
  readonly group = new Group();
  private readonly path = new Mesh(new BufferGeometry(), overlay({ color: ACTOR, opacity: 0.9 }));
  private readonly dots = instances(new CircleGeometry(0.14, 16), MOST_DOTS, 0.95, ACTOR);
  private readonly rims = instances(new RingGeometry(0.95, 1, 48), MOST_CIRCLES, 0.85);
  private readonly discs = instances(new CircleGeometry(1, 40), MOST_CIRCLES, 0.07);
  private readonly flag = goalFlag();
  private shown: Plan | null = null;
  private readonly matrix = new Matrix4();

  constructor() {
    this.group.add(this.path, this.dots, this.rims, this.discs, this.flag);
    this.group.visible = false;
  }

  show(plan: Plan | null, floors: Floors): void {
    if (plan === this.shown) return;
    this.shown = plan;
    this.group.visible = plan !== null;
    if (!plan) return;
    this.path.geometry.dispose();
    this.path.geometry = ribbon(onFloors(plan.path, floors));
    this.placeDots(plan.path);
    this.placeCircles(plan.people);
    this.flag.visible = plan.goal !== null;
    if (plan.goal) this.flag.position.set(...plan.goal);
  }

  /** One dot for each whole second of the path, and one at its end. */
  private placeDots(path: Plan["path"]): void {
    let count = 0;
    let nextS = 1;
    path.forEach(([x, y, z, seconds], i) => {
      const isLast = i === path.length - 1;
      if ((seconds < nextS && !isLast) || count === MOST_DOTS) return;
      nextS = Math.floor(seconds) + 1;
      this.dots.setMatrixAt(count++, this.matrix.makeTranslation(x, y, z + 0.05));
    });
    this.dots.count = count;
    this.dots.instanceMatrix.needsUpdate = true;
  }

  private placeCircles(people: Plan["people"]): void {
    const color = new Color();
    let count = 0;
    for (const circles of people) {
      const drawn = Math.min(DRAWN_CIRCLES, circles.length);
      for (let i = 0; i < drawn && count < MOST_CIRCLES; i++) {
        const part = drawn > 1 ? i / (drawn - 1) : 0;
        const circle = circles[Math.round(part * (circles.length - 1))];
        if (!circle) continue;
        const { x, y, z, radius } = circle;
        this.matrix.makeScale(radius, radius, 1).setPosition(x, y, z + 0.035);
        color.lerpColors(SOON, LATE, part);
        for (const mesh of [this.rims, this.discs]) {
          mesh.setMatrixAt(count, this.matrix);
          mesh.setColorAt(count, color);
        }
        count++;
      }
    }
    for (const mesh of [this.rims, this.discs]) {
      mesh.count = count;
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
  }
}

type Spot = readonly [x: number, y: number, z: number];

/** The path in pieces so short that it follows the treads of stairs. */
function onFloors(path: Plan["path"], floors: Floors): Spot[] {
  const spots: Spot[] = [];
  path.forEach(([x, y, z], i) => {
    const [ax, ay, az] = path[Math.max(0, i - 1)] ?? [x, y, z];
    const level = Math.abs(z - az) < LEVEL_M;
    const pieces = level ? 1 : Math.ceil(Math.hypot(x - ax, y - ay) / PIECE_M);
    for (let k = 1; k <= pieces; k++) {
      const [px, py] = [ax + ((x - ax) * k) / pieces, ay + ((y - ay) * k) / pieces];
      const pz = az + ((z - az) * k) / pieces;
      const floor = floors.at(px, py, pz);
      spots.push([px, py, floor !== null && Math.abs(floor - pz) < ON_IT_M ? floor : pz]);
    }
  });
  return spots;
}

/** A flat band along the path. */
function ribbon(path: readonly Spot[]): BufferGeometry {
  const position: number[] = [];
  const index: number[] = [];
  path.forEach(([x, y, z], i) => {
    const before = path[Math.max(0, i - 1)] ?? [x, y];
    const after = path[Math.min(path.length - 1, i + 1)] ?? [x, y];
    const [dx, dy] = [after[0] - before[0], after[1] - before[1]];
    const length = Math.hypot(dx, dy) || 1;
    const [sx, sy] = [(-dy / length) * PATH_HALF_M, (dx / length) * PATH_HALF_M];
    position.push(x + sx, y + sy, z + RIBBON_M, x - sx, y - sy, z + RIBBON_M);
    if (i > 0) {
      const k = 2 * i;
      index.push(k - 2, k - 1, k, k, k - 1, k + 1);
    }
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(position, 3));
  geometry.setIndex(index);
  return geometry;
}

function goalFlag(): Group {
  const pole = new CylinderGeometry(0.03, 0.03, 2.2, 8).rotateX(Math.PI / 2).translate(0, 0, 1.1);
  const cloth = new ConeGeometry(0.26, 0.7, 3).scale(1, 1, 0.08);
  cloth
    .rotateZ(-Math.PI / 2)
    .rotateX(Math.PI / 2)
    .translate(0.36, 0, 1.95);
  const group = new Group();
  group.add(
    new Mesh(pole, new MeshBasicMaterial({ color: "#f4f1ea" })),
    new Mesh(cloth, new MeshBasicMaterial({ color: ACTOR })),
    new Mesh(
      new RingGeometry(0.3, 0.4, 32).translate(0, 0, 0.05),
      overlay({ color: ACTOR, opacity: 0.9 }),
    ),
  );
  return group;
}

function instances(
  geometry: BufferGeometry,
  most: number,
  opacity: number,
  color = new Color("#ffffff"),
): InstancedMesh {
  const mesh = new InstancedMesh(
    painted(geometry, color),
    overlay({ vertexColors: true, opacity }),
    most,
  );
  mesh.frustumCulled = false;
  mesh.count = 0;
  return mesh;
}

function overlay(look: ConstructorParameters<typeof MeshBasicMaterial>[0]): MeshBasicMaterial {
  return new MeshBasicMaterial({ ...look, transparent: true, depthWrite: false });
}
