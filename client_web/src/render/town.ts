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
import type { SceneData, ScenePolygon } from "../net/messages";
import type { Floors } from "../world/floors";
import type { Triangles } from "../world/mesh";
import { based, type Cutaway } from "./cutaway";
import { doorFrame, DoorLeaves } from "./doors";
import { boardsTexture, facadeTexture, pavingTexture } from "./facade";
import { PAVING } from "./palette";
import { bed, hedge, isTree, tree } from "./plants";
import { merged } from "./shapes";
import { lowestOf, meshGeometry } from "./meshes";
import { freeBoard, portals } from "./portals";
import { signs } from "./signs";
import { furniture, isHung } from "./furniture";
import { floor, indoors, isRailing, railing, stairs } from "./storeys";
import { treesAround } from "./surroundings";
import { basin, building, masonry, type Pieces, thinWall } from "./structures";

const SLAB_M = 1.5;
/** The pattern of boards repeats itself after so much. */
const BOARDS_M = 1.6;
/** Heights that are left of walls, and of furniture, where they are cut before the own avatar. */
const WALL_STUB_M = 0.35;
const TABLE_STUB_M = 1.2;

export interface Town {
  readonly group: Group;
  /** The meshes that hide the view of the camera. */
  readonly occluders: readonly Mesh[];
  readonly doors: DoorLeaves;
  dispose(): void;
}

/** `mesh` holds the triangles of a building that comes as a mesh. */
export function buildTown(
  { scene, floors }: { scene: SceneData; floors: Floors },
  cutaway: Cutaway,
  mesh: Triangles | null,
): Town {
  const lowest = mesh ? lowestOf(mesh) : 0;
  const pieces = piecesOf(scene, lowest);
  if (mesh) pieces.plain.push(meshGeometry(mesh));
  const facade = new MeshLambertMaterial({ vertexColors: true, map: facadeTexture() });
  // Both sides: the inner face of a basin is seen from within.
  const plain = new MeshLambertMaterial({ vertexColors: true, side: DoubleSide });
  const leaves = new MeshLambertMaterial({ vertexColors: true, flatShading: true });
  const water = new MeshPhongMaterial({ vertexColors: true, shininess: 90, specular: "#bfe3f0" });
  const paving = new MeshLambertMaterial({ vertexColors: true, map: pavingTexture() });
  paving.map?.repeat.set(1 / SLAB_M / 2, 1 / SLAB_M / 2);
  const boards = new MeshLambertMaterial({ vertexColors: true, map: boardsTexture() });
  boards.map?.repeat.set(1 / BOARDS_M, 1 / BOARDS_M);
  const wood = new MeshLambertMaterial({ vertexColors: true });
  for (const material of [facade, plain, water, paving, boards, wood]) cutaway.applyTo(material);
  cutaway.applyTo(leaves, true);
  const doors = new DoorLeaves(scene.doors, wood);
  const solid = [
    meshOf(pieces.facade, facade),
    meshOf(pieces.plain, plain),
    meshOf(pieces.paving, paving),
    meshOf(pieces.boards, boards),
  ].filter((m) => m !== null);
  const group = new Group();
  group.add(...ground(scene, lowest, mesh === null), ...solid, doors.group);
  const names = signs(scene, floors, cutaway);
  const ways = portals(scene, floors);
  for (const other of [meshOf(pieces.leaves, leaves), meshOf(pieces.water, water), names, ways]) {
    if (other) group.add(other);
  }
  return {
    group,
    occluders: solid,
    doors,
    dispose() {
      group.traverse((part) => {
        freeBoard(part);
        if (!(part instanceof Mesh)) return;
        const { geometry, material } = part as Mesh<PlaneGeometry, MeshLambertMaterial>;
        geometry.dispose();
        material.map?.dispose();
        material.dispose();
      });
    },
  };
}

type AllPieces = Pieces & { leaves: Pieces["plain"] };

/** Everything that stands, each piece with the height at which it begins. */
function piecesOf(scene: SceneData, landM: number): AllPieces {
  const { polygons, walls, stairs: flights, doors } = scene;
  const all: AllPieces = { plain: [], facade: [], water: [], paving: [], boards: [], leaves: [] };
  const add = (baseM: number, build: (into: AllPieces) => void, stubM?: number): void => {
    const part: AllPieces = {
      plain: [],
      facade: [],
      water: [],
      paving: [],
      boards: [],
      leaves: [],
    };
    build(part);
    for (const kind of Object.keys(part) as (keyof AllPieces)[]) {
      all[kind].push(...part[kind].map((geometry) => based(geometry, baseM, stubM)));
    }
  };
  polygons.forEach((polygon, index) => {
    const { kind, offset_m } = polygon;
    if (kind === "plant" && isTree(polygon)) {
      add(offset_m, (into) => into.plain.push(...bed(polygon)));
      add(offset_m, (into) => into.leaves.push(...tree(polygon, index)), 0);
    } else if (kind === "plant") {
      add(offset_m, (into) => into.plain.push(...hedge(polygon, index)), TABLE_STUB_M);
    } else if (kind === "water") {
      add(offset_m, (into) => {
        basin(polygon, into);
      });
    } else if (kind === "floor" || polygon.ramp) {
      add(offset_m, (into) => {
        floor(polygon, into);
      });
      add(0, (into) => into.paving.push(...indoors(polygon)));
    } else if (kind === "building") {
      add(offset_m, (into) => {
        building(polygon, index, into);
      });
    } else if (kind === "furniture") {
      add(offset_m, (into) => into.plain.push(...furniture(polygon, index)), stubOf(polygon));
    } else {
      add(offset_m, (into) => into.plain.push(...masonry(polygon)), WALL_STUB_M);
    }
  });
  for (const wall of walls) {
    if (isRailing(wall)) add(wall.offset_m, (into) => into.plain.push(...railing(wall)));
    else add(wall.offset_m, (into) => into.plain.push(...thinWall(wall)), WALL_STUB_M);
  }
  for (const flight of flights) {
    add(flight.bottom_m, (into) => {
      stairs(flight, into);
    });
  }
  for (const door of doors) {
    add(door.offset_m, (into) => {
      doorFrame(door, into);
    });
  }
  add(landM, (into) => into.leaves.push(...treesAround(scene.bounds, landM)), 0);
  return all;
}

const stubOf = (furniture: ScenePolygon): number =>
  isHung(furniture) ? WALL_STUB_M : TABLE_STUB_M;

function meshOf(pieces: Pieces["plain"], material: Material): Mesh | null {
  const geometry = merged(pieces);
  if (!geometry) {
    material.dispose();
    return null;
  }
  const made = new Mesh(geometry, material);
  made.castShadow = made.receiveShadow = true;
  return made;
}

/** The paved ground within the bounds, and the land around it, below all that is built. */
function ground({ bounds: [x0, y0, x1, y1] }: SceneData, lowestM: number, pave: boolean): Mesh[] {
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
  land.position.set(x, y, lowestM - 0.05);
  return pave ? [paved, land] : [land];
}
