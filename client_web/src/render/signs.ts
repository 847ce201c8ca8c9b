/** The names of places, written on the floor to be read from the south, as on the map. */

import {
  BufferGeometry,
  CanvasTexture,
  Float32BufferAttribute,
  Mesh,
  MeshLambertMaterial,
  SRGBColorSpace,
} from "three";
import type { SceneData } from "../net/messages";
import type { Floors } from "../world/floors";
import { based, type Cutaway } from "./cutaway";
import { merged } from "./shapes";

const WIDTH_M = 4.4;
const HEIGHT_M = 0.55;
const ROW_PIXELS = 64;
const ROW_WIDTH = (ROW_PIXELS * WIDTH_M) / HEIGHT_M;
const LETTERS_PIXELS = 40;
/** Names lie above the floor, so that it does not shine through. */
const ABOVE_M = 0.015;
const INK = "rgb(60 44 30 / 75%)";

/** One mesh for all names; null where there are none. */
export function signs(
  { places }: Pick<SceneData, "places">,
  floors: Floors,
  cutaway: Cutaway,
): Mesh | null {
  const planes = places.map(({ position: [x, y], z_m }, row) =>
    plane([x, y, (floors.at(x, y, z_m) ?? z_m) + ABOVE_M], row, places.length),
  );
  const geometry = merged(planes);
  if (!geometry) return null;
  const map = written(places.map(({ name }) => name));
  const material = new MeshLambertMaterial({ map, transparent: true, depthWrite: false });
  material.polygonOffset = true;
  material.polygonOffsetFactor = material.polygonOffsetUnits = -2;
  cutaway.applyTo(material);
  const mesh = new Mesh(geometry, material);
  mesh.receiveShadow = true;
  return mesh;
}

function plane(
  [x, y, z]: readonly [number, number, number],
  row: number,
  rows: number,
): BufferGeometry {
  const [x0, x1] = [x - WIDTH_M / 2, x + WIDTH_M / 2];
  const [y0, y1] = [y - HEIGHT_M / 2, y + HEIGHT_M / 2];
  const [v0, v1] = [1 - (row + 1) / rows, 1 - row / rows];
  const geometry = new BufferGeometry();
  const attribute = (name: string, size: number, values: number[]): void => {
    geometry.setAttribute(name, new Float32BufferAttribute(values, size));
  };
  attribute("position", 3, [x0, y0, z, x1, y0, z, x1, y1, z, x0, y0, z, x1, y1, z, x0, y1, z]);
  attribute("normal", 3, Array.from({ length: 6 }, () => [0, 0, 1]).flat());
  attribute("uv", 2, [0, v0, 1, v0, 1, v1, 0, v0, 1, v1, 0, v1]);
  return based(geometry, z);
}

/** All names below each other, as a texture. */
function written(names: readonly string[]): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = ROW_WIDTH;
  canvas.height = ROW_PIXELS * names.length;
  const pen = canvas.getContext("2d");
  if (pen) {
    pen.font = `600 ${LETTERS_PIXELS}px Georgia, "Times New Roman", serif`;
    pen.letterSpacing = "3px";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillStyle = INK;
    names.forEach((name, row) => {
      pen.fillText(name, ROW_WIDTH / 2, (row + 0.5) * ROW_PIXELS, ROW_WIDTH - 16);
    });
  }
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = 8;
  return texture;
}
