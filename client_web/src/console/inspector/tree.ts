/** The search for a path as lines on the map, coloured by the order in which nodes were expanded. */

import type { Point, Trace } from "../net/types";
import type { Overlay, Segments } from "../state/overlays";

const SHADES = 10;
const UNEXPANDED = "#8a8f96";

export interface TreeCount {
  expanded: number;
  open: number;
}

export function countNodes({ nodes }: Trace): TreeCount {
  const expanded = nodes.filter((node) => node[6] >= 0).length;
  return { expanded, open: nodes.length - expanded };
}

/** What is drawn on the map; `slice` is the index of the slice of the risk field. */
export function traceOverlay(trace: Trace, slice: number | null): Overlay {
  const risk = slice === null ? undefined : trace.risk[slice];
  const z = trace.nodes[0]?.[2] ?? 0;
  return {
    lines: [],
    segments: segmentsOf(trace),
    ...(risk ? { raster: { ...risk, z_m: z } } : {}),
  };
}

export function segmentsOf({ nodes }: Trace): Segments[] {
  const last = Math.max(1, ...nodes.map((node) => node[6]));
  const shades = Array.from({ length: SHADES + 1 }, () => [] as [Point, Point][]);
  for (const node of nodes) {
    const before = nodes[node[4]];
    if (!before) continue;
    const order = node[6];
    const shade = order < 0 ? SHADES : Math.min(SHADES - 1, Math.floor((order / last) * SHADES));
    shades[shade]?.push([
      [before[0], before[1], before[2]],
      [node[0], node[1], node[2]],
    ]);
  }
  return shades
    .map((pairs, shade) => ({ pairs, colour: shade === SHADES ? UNEXPANDED : shadeColour(shade) }))
    .filter(({ pairs }) => pairs.length > 0);
}

/** From blue for the first expanded to orange for the last. */
function shadeColour(shade: number): string {
  const part = shade / (SHADES - 1);
  return `hsl(${Math.round(225 - 195 * part)} 70% 48%)`;
}
