/** Lofts: surfaces through a row of cross sections, of which limbs, shoes and heads are made. */

import { BufferGeometry, Color, Float32BufferAttribute } from "three";

type Point = readonly [x: number, y: number, z: number];

/** A cross section: a closed ring of points, with the colour of the surface there. */
export interface Section {
  readonly points: readonly Point[];
  readonly color: Color;
}

export const WHITE = new Color("#ffffff");

/** A level oval at height z, `depth` to front and back and `width` to the sides. */
export interface Oval {
  z: number;
  depth: number;
  width: number;
  /** Its middle, to the front. */
  x?: number;
  /** 1 is an ellipse, less is more like a box. */
  roundness?: number;
  color?: Color;
}

export function oval(
  { z, depth, width, x = 0, roundness = 1, color = WHITE }: Oval,
  corners: number,
): Section {
  const points = Array.from({ length: corners }, (_, i): Point => {
    const angle = (2 * Math.PI * i) / corners;
    return [
      x + depth * rounded(Math.cos(angle), roundness),
      width * rounded(Math.sin(angle), roundness),
      z,
    ];
  });
  return { points, color };
}

/** Shapes with fewer corners are seen from afar: every second section is enough for them. */
const FEW_CORNERS = 8;

/** The surface through ovals from the top down, closed at both ends. */
export function loft(ovals: readonly Oval[], corners: number): BufferGeometry {
  return skin(ovals.map((each) => oval(each, corners)));
}

/** The surface through sections of equally many points, closed at both ends by their middles. */
export function skin(all: readonly Section[]): BufferGeometry {
  const corners = all[0]?.points.length ?? 0;
  const sections =
    corners < FEW_CORNERS ? all.filter((_, i) => i % 2 === 0 || i === all.length - 1) : all;
  const position: number[] = [];
  const colors: number[] = [];
  for (const { points, color } of [end(sections[0]), ...sections, end(sections.at(-1))]) {
    for (const point of points) {
      position.push(...point);
      colors.push(color.r, color.g, color.b);
    }
  }
  const last = position.length / 3 - 1;
  const index: number[] = [];
  for (let ring = 0; ring < sections.length; ring++) {
    for (let i = 0; i < corners; i++) {
      const next = (i + 1) % corners;
      const a = 1 + ring * corners + i;
      const b = 1 + ring * corners + next;
      if (ring === 0) index.push(0, a, b);
      if (ring === sections.length - 1) index.push(last, b, a);
      else index.push(a, a + corners, b, b, a + corners, b + corners);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(position, 3));
  geometry.setAttribute("color", new Float32BufferAttribute(colors, 3));
  geometry.setIndex(index);
  geometry.computeVertexNormals();
  return geometry;
}

/** A section that is drawn together to its middle. */
function end(section: Section | undefined): Section {
  if (!section) throw new RangeError("a skin goes over at least one section");
  const n = section.points.length;
  const middle = ([0, 1, 2] as const).map(
    (axis) => section.points.reduce((sum, point) => sum + point[axis], 0) / n,
  ) as unknown as Point;
  return { points: [middle], color: section.color };
}

function rounded(value: number, roundness: number): number {
  return Math.sign(value) * Math.abs(value) ** roundness;
}
