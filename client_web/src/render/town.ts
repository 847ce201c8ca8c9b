/** The static world: ground and everything that stands on it, in a handful of meshes. */

import {
  CircleGeometry,
  DoubleSide,
  Group,
  type Material,
  Mesh,
  MeshLambertMaterial,
  MeshPhongMaterial,
  PlaneGeometry,
} from "three";
import type { SceneData } from "../net/messages";
import { facadeTexture, pavingTexture } from "./facade";
import { LeavesMaterial } from "./leaves";
import { PAVING } from "./palette";
import { plant } from "./plants";
import { merged } from "./shapes";
import { basin, building, furniture, masonry, type Pieces, thinWall } from "./structures";

const SLAB_M = 1.5;

export interface Town {
  readonly group: Group;
  /** What hides the view of the camera. */
  readonly occluders: readonly Mesh[];
  /** How far the camera is from the avatar that it follows, metres. */
  lookingFrom(distanceM: number): void;
  dispose(): void;
}

export function buildTown(scene: SceneData): Town {
  const pieces: Pieces & { leaves: Pieces["plain"] } = {
    plain: [],
    facade: [],
    water: [],
    leaves: [],
  };
  scene.polygons.forEach((polygon, index) => {
    if (polygon.kind === "building") building(polygon, index, pieces);
    else if (polygon.kind === "plant") pieces.leaves.push(...plant(polygon, index));
    else if (polygon.kind === "furniture") furniture(polygon, pieces);
    else if (polygon.kind === "water") basin(polygon, pieces);
    else masonry(polygon, pieces);
  });
  scene.walls.forEach((wall) => {
    thinWall(wall, pieces);
  });

  const facade = new MeshLambertMaterial({ vertexColors: true, map: facadeTexture() });
  // Both sides: the inner face of a basin is seen from within.
  const plain = new MeshLambertMaterial({ vertexColors: true, side: DoubleSide });
  const leaves = new LeavesMaterial();
  const water = new MeshPhongMaterial({ vertexColors: true, shininess: 90, specular: "#bfe3f0" });
  const solid = [mesh(pieces.facade, facade), mesh(pieces.plain, plain)].filter((m) => m !== null);
  const group = new Group();
  group.add(...ground(scene), ...solid);
  for (const other of [mesh(pieces.leaves, leaves), mesh(pieces.water, water)]) {
    if (other) group.add(other);
  }
  return {
    group,
    occluders: solid,
    lookingFrom(distanceM) {
      leaves.lookingFrom(distanceM);
    },
    dispose() {
      group.traverse((part) => {
        if (!(part instanceof Mesh)) return;
        const { geometry, material } = part as Mesh<PlaneGeometry, MeshLambertMaterial>;
        geometry.dispose();
        material.map?.dispose();
        material.dispose();
      });
    },
  };
}

function mesh(pieces: Pieces["plain"], material: Material): Mesh | null {
  const geometry = merged(pieces);
  if (!geometry) {
    material.dispose();
    return null;
  }
  const made = new Mesh(geometry, material);
  made.castShadow = made.receiveShadow = true;
  return made;
}

/** The paved ground within the bounds, and the land around it. */
function ground({ bounds: [x0, y0, x1, y1] }: SceneData): Mesh[] {
  const [width, depth] = [x1 - x0, y1 - y0];
  const [x, y] = [(x0 + x1) / 2, (y0 + y1) / 2];
  const map = pavingTexture();
  map.repeat.set(width / SLAB_M / 2, depth / SLAB_M / 2);
  const paved = new Mesh(
    new PlaneGeometry(width, depth),
    new MeshLambertMaterial({ color: PAVING, map }),
  );
  paved.position.set(x, y, 0);
  paved.receiveShadow = true;
  const land = new Mesh(
    new CircleGeometry(Math.hypot(width, depth) / 2 + 300, 40),
    new MeshLambertMaterial({ color: "#a9b48a" }),
  );
  land.position.set(x, y, -0.05);
  return [paved, land];
}
