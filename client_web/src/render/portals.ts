/** Portals to other zones: a lit floor, a veil of light around it, and the name of where it leads. */

import {
  BufferGeometry,
  CanvasTexture,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  LinearFilter,
  Mesh,
  MeshBasicMaterial,
  Shape,
  ShapeGeometry,
  Sprite,
  SpriteMaterial,
  SRGBColorSpace,
} from "three";
import type { SceneData, ScenePortal } from "../net/messages";
import type { Floors } from "../world/floors";
import { centreOf } from "./shapes";

const LIGHT = [0.23, 0.65, 0.73] as const;
const FLOOR_OPACITY = 0.45;
/** The veil is as dense as this at the floor, and gone at its upper edge. */
const VEIL_OPACITY = 0.55;
const VEIL_M = 2.4;
/** The lit floor lies above the floor, so that it does not shine through. */
const ABOVE_M = 0.02;
const BOARD_M = { width: 3.2, height: 0.5 };
const BOARD_PIXELS = { width: 512, height: 80 };
const BOARD_ABOVE_M = 2.75;

/** All portals of a scene; null where there are none. */
export function portals({ portals: all = [] }: SceneData, floors: Floors): Group | null {
  if (all.length === 0) return null;
  const group = new Group();
  for (const portal of all) {
    const [x, y] = centreOf(portal.points);
    const floorM = floors.at(x, y, portal.z_m) ?? portal.z_m;
    group.add(litFloor(portal, floorM), veil(portal, floorM), board(portal, [x, y, floorM]));
  }
  return group;
}

/** Free what the board of a portal holds; meshes are freed as all others of a town. */
export function freeBoard(part: unknown): void {
  if (!(part instanceof Sprite)) return;
  part.material.map?.dispose();
  part.material.dispose();
}

function litFloor({ points }: ScenePortal, floorM: number): Mesh {
  const shape = new Shape();
  points.forEach(([x, y], corner) => {
    if (corner === 0) shape.moveTo(x, y);
    else shape.lineTo(x, y);
  });
  const material = lit();
  material.color.setRGB(...LIGHT);
  material.opacity = FLOOR_OPACITY;
  const made = new Mesh(new ShapeGeometry(shape), material);
  made.position.z = floorM + ABOVE_M;
  return made;
}

/** Upright planes along the edges, whose light fades upwards. */
function veil({ points }: ScenePortal, floorM: number): Mesh {
  const places: number[] = [];
  const colors: number[] = [];
  const corner = (x: number, y: number, up: boolean): void => {
    places.push(x, y, floorM + (up ? VEIL_M : ABOVE_M));
    colors.push(...LIGHT, up ? 0 : VEIL_OPACITY);
  };
  points.forEach(([ax, ay], place) => {
    const [bx, by] = points[(place + 1) % points.length] ?? [ax, ay];
    corner(ax, ay, false);
    corner(bx, by, false);
    corner(bx, by, true);
    corner(ax, ay, false);
    corner(bx, by, true);
    corner(ax, ay, true);
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(places, 3));
  geometry.setAttribute("color", new Float32BufferAttribute(colors, 4));
  const material = lit();
  material.vertexColors = true;
  return new Mesh(geometry, material);
}

function lit(): MeshBasicMaterial {
  return new MeshBasicMaterial({ transparent: true, depthWrite: false, side: DoubleSide });
}

/** The name of where a portal leads, above it, turned to whoever looks. */
function board({ title }: ScenePortal, [x, y, floorM]: readonly [number, number, number]): Sprite {
  const canvas = document.createElement("canvas");
  canvas.width = BOARD_PIXELS.width;
  canvas.height = BOARD_PIXELS.height;
  const pen = canvas.getContext("2d");
  if (pen) {
    pen.fillStyle = "rgb(16 58 66 / 85%)";
    pen.beginPath();
    pen.roundRect(0, 0, canvas.width, canvas.height, canvas.height / 2);
    pen.fill();
    pen.font = `600 44px Georgia, "Times New Roman", serif`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillStyle = "#ffffff";
    pen.fillText(`→ ${title}`, canvas.width / 2, canvas.height / 2, canvas.width - 48);
  }
  const map = new CanvasTexture(canvas);
  map.colorSpace = SRGBColorSpace;
  map.minFilter = LinearFilter;
  const made = new Sprite(new SpriteMaterial({ map, transparent: true, depthWrite: false }));
  made.scale.set(BOARD_M.width, BOARD_M.height, 1);
  made.position.set(x, y, floorM + BOARD_ABOVE_M);
  return made;
}
