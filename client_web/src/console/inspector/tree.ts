/** A decision on the map: the search as lines, the paths that were compared, a slice of risk. */

import { valuesOf } from "../map/raster";
import type { Point, Trace } from "../net/types";
import type { Line, Overlay, Segments } from "../state/overlays";

const SHADES = 10;
/** A risk below this never has the darkest colour. */
const LEAST_FULL_RISK = 0.1;
const UNEXPANDED = "#8a8f96";

/** The meaning of the colour of a line of the search. */
export type ColourBy = "order" | "time";

export interface TraceView {
  /** The index of the slice of the risk field. */
  slice: number;
  by: ColourBy;
}

export interface TreeCount {
  expanded: number;
  open: number;
}

export function countNodes({ nodes, left_out }: Trace): TreeCount {
  const expanded = nodes.filter((node) => node[6] >= 0).length;
  return { expanded, open: nodes.length - expanded + left_out };
}

/** The parts that are drawn on the map; paths have the colours of those that are drawn live. */
export function traceOverlay(
  trace: Trace,
  { slice, by }: TraceView,
  colours: { taken: string; before: string },
): Overlay {
  const risk = trace.risk[slice];
  const z = trace.nodes[0]?.[2] ?? 0;
  const lines: Line[] = [];
  if (trace.previous) lines.push(lineOf(trace.previous.path, colours.before, true));
  lines.push(lineOf(trace.path, colours.taken, false));
  return {
    lines,
    segments: segmentsOf(trace, by),
    ...(risk
      ? { raster: { ...risk, z_m: z, most: Math.max(LEAST_FULL_RISK, mostRisk(trace)) } }
      : {}),
  };
}

const mostRisks = new WeakMap<Trace, number>();

/** The greatest value of all slices, so that one colour is the same at all times. */
export function mostRisk(trace: Trace): number {
  const known = mostRisks.get(trace);
  if (known !== undefined) return known;
  const greatest = (most: number, value: number): number => Math.max(most, value);
  const most = trace.risk.reduce((found, slice) => valuesOf(slice).reduce(greatest, found), 0);
  mostRisks.set(trace, most);
  return most;
}

export function segmentsOf({ nodes }: Trace, by: ColourBy): Segments[] {
  const column = by === "order" ? 6 : 3;
  const last = Math.max(by === "order" ? 1 : 0.1, ...nodes.map((node) => node[column]));
  const shades = Array.from({ length: SHADES + 1 }, () => [] as [Point, Point][]);
  for (const node of nodes) {
    const before = nodes[node[4]];
    if (!before) continue;
    const part = node[column] / last;
    const open = by === "order" && node[6] < 0;
    const shade = open ? SHADES : Math.min(SHADES - 1, Math.floor(part * SHADES));
    shades[shade]?.push([
      [before[0], before[1], before[2]],
      [node[0], node[1], node[2]],
    ]);
  }
  // Those left open are many, and lie below the others.
  return shades
    .map((pairs, shade) => ({ pairs, colour: shade === SHADES ? UNEXPANDED : shadeColour(shade) }))
    .reverse()
    .filter(({ pairs }) => pairs.length > 0);
}

/** From blue for the first to orange for the last. */
function shadeColour(shade: number): string {
  const part = shade / (SHADES - 1);
  return `hsl(${Math.round(225 - 195 * part)} 70% 48%)`;
}

function lineOf(
  path: readonly (readonly [number, number, number, number])[],
  colour: string,
  dashed: boolean,
): Line {
  return { points: path.map(([x, y, z]) => [x, y, z]), colour, widthPx: dashed ? 2 : 3, dashed };
}
