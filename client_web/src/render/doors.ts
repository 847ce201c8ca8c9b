/** Doors: a frame that stands, and one or two leaves that swing. */

import { Group, type Material, Mesh, type Raycaster } from "three";
import type { Doors as Open, SceneDoor } from "../net/messages";
import { based } from "./cutaway";
import { IRON, WOOD } from "./palette";
import { box, merged } from "./shapes";
import type { Pieces } from "./structures";

const FRAME_M = 0.12;
const LEAF_M = 0.06;
const HANDLE_M = 1.05;
/** A wider door has two leaves. */
const ONE_LEAF_M = 1.3;
/** An open leaf is swung aside by this angle, radians. */
const SWUNG = 1.65;
const SWING_S = 0.25;

interface Leaf {
  hinge: Group;
  /** The angle of the closed leaf, and the sense in which it opens. */
  closed: number;
  side: number;
  swing: number;
}

interface Door {
  name: string;
  leaves: Leaf[];
}

export class DoorLeaves {
  readonly group = new Group();
  private readonly doors: Door[];

  constructor(doors: readonly SceneDoor[], material: Material) {
    this.doors = doors.map((door) => ({ name: door.name, leaves: this.leaves(door, material) }));
  }

  /** Swing the leaves towards the state of the doors; doors that are not listed stand open. */
  update(open: Readonly<Open>, frameS: number): void {
    for (const { name, leaves } of this.doors) {
      const wanted = open[name] === false ? 0 : 1;
      for (const leaf of leaves) {
        leaf.swing += (wanted - leaf.swing) * (1 - Math.exp(-frameS / SWING_S));
        leaf.hinge.rotation.z = leaf.closed + leaf.side * SWUNG * leaf.swing;
      }
    }
  }

  /** The nearest door that a ray meets, by name. */
  hit(ray: Raycaster): { name: string; distanceM: number } | null {
    const [hit] = ray.intersectObject(this.group);
    if (!hit) return null;
    const door = this.doors.find(({ leaves }) =>
      leaves.some(({ hinge }) => hinge === hit.object.parent),
    );
    return door ? { name: door.name, distanceM: hit.distance } : null;
  }

  private leaves({ start, end, offset_m, height_m }: SceneDoor, material: Material): Leaf[] {
    const width = Math.hypot(end[0] - start[0], end[1] - start[1]);
    const angle = Math.atan2(end[1] - start[1], end[0] - start[0]);
    const two = width > ONE_LEAF_M;
    const leafM = two ? width / 2 : width;
    const hung = [{ at: start, closed: angle, side: 1 }];
    if (two) hung.push({ at: end, closed: angle + Math.PI, side: -1 });
    return hung.map(({ at, closed, side }) => {
      const board = box(
        [leafM / 2, 0, height_m / 2],
        [leafM - 0.04, LEAF_M, height_m - 0.04],
        0,
        WOOD,
      );
      const handle = box([leafM - 0.14, 0, HANDLE_M], [0.16, LEAF_M + 0.1, 0.04], 0, IRON);
      const geometry = merged([board, handle].map((piece) => based(piece, offset_m)));
      const mesh = new Mesh(geometry ?? undefined, material);
      mesh.castShadow = mesh.receiveShadow = true;
      const hinge = new Group();
      hinge.add(mesh);
      hinge.position.set(at[0], at[1], offset_m);
      hinge.rotation.z = closed;
      this.group.add(hinge);
      return { hinge, closed, side, swing: 0 };
    });
  }
}

/** The posts and the lintel. */
export function doorFrame({ start, end, offset_m, height_m }: SceneDoor, into: Pieces): void {
  const angle = Math.atan2(end[1] - start[1], end[0] - start[0]);
  const width = Math.hypot(end[0] - start[0], end[1] - start[1]);
  const middle = [(start[0] + end[0]) / 2, (start[1] + end[1]) / 2] as const;
  for (const [x, y] of [start, end]) {
    into.plain.push(
      box([x, y, offset_m + height_m / 2], [FRAME_M, FRAME_M + 0.06, height_m], angle, IRON),
    );
  }
  const top = offset_m + height_m + FRAME_M / 2;
  into.plain.push(
    box([...middle, top], [width + 2 * FRAME_M, FRAME_M + 0.06, FRAME_M], angle, IRON),
  );
}
