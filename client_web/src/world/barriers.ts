/** Barriers stop a walking body: sides of solids, walls, closed doors, and edges to fall from. */

import type { Point, SceneData } from "../net/messages";
import type { Floors } from "./floors";
import type { Ring, Solid } from "./solids";

export type Vec2 = readonly [x: number, y: number];

/** A vertical face over the line from `a` to `b`. */
export interface Barrier {
  a: Vec2;
  b: Vec2;
  bottomM: number;
  topM: number;
  /** The door that this barrier is, if any; an open door does not stop anybody. */
  door: string | null;
  /** The direction to the floor of an edge to fall from. A body beyond the edge may come back. */
  inward?: Vec2;
}

/** The measures of a body that decide what stops it, as the server's welcome has them. */
export interface Reach {
  /** A barrier that hangs lower than this above the feet stops the body. */
  heightM: number;
  /** Greatest difference in height that the body steps up or down. */
  stepM: number;
}

/** Things that nobody climbs, such as furniture, stop people however low they are. */
const UNCLIMBED_M = 1.2;

const PIECE_M = 0.25;
/** Floors are looked up this far to both sides of an edge. */
const ASIDE_M = 0.05;
/** A ledge stops bodies whose feet are between these heights below and above it. */
const LEDGE_BELOW_M = 0.05;
const LEDGE_ABOVE_M = 2;

export function barriersOf(
  { walls, doors }: Pick<SceneData, "walls" | "doors">,
  floors: Floors,
  stepM: number,
): Barrier[] {
  const thin = [...walls.map((wall) => ({ ...wall, name: null })), ...doors];
  return [
    ...thin.map(({ start, end, offset_m, height_m, name }) => ({
      a: start,
      b: end,
      bottomM: offset_m,
      topM: offset_m + height_m,
      door: name,
    })),
    ...floors.solids.flatMap((solid) => [
      ...(solid.sheet ? [] : sidesOf(solid)),
      ...(solid.carries ? ledgesOf(solid, floors, stepM) : []),
    ]),
  ];
}

function sidesOf({ ring, bottomM, topM, carries }: Solid): Barrier[] {
  return edgesOf(ring).map(([a, b]) => {
    const foot = Math.min(bottomM(...a), bottomM(...b));
    const least = carries ? 0 : foot + UNCLIMBED_M;
    return {
      a,
      b,
      bottomM: foot,
      topM: Math.max(topM(...a), topM(...b), least),
      door: null,
    };
  });
}

/** Pieces of a top's edge beyond which there is no floor within a step. */
function ledgesOf({ ring, topM }: Solid, floors: Floors, stepM: number): Barrier[] {
  const outwards = isClockwise(ring) ? -1 : 1;
  return edgesOf(ring).flatMap(([a, b]) => {
    const ledges: Barrier[] = [];
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const length = Math.hypot(dx, dy);
    const pieces = Math.max(1, Math.ceil(length / PIECE_M));
    const [nx, ny] = [(outwards * dy * ASIDE_M) / length, (-outwards * dx * ASIDE_M) / length];
    const at = (piece: number): Point => [
      a[0] + (dx * piece) / pieces,
      a[1] + (dy * piece) / pieces,
    ];
    for (let i = 0; i < pieces; i++) {
      const [x, y] = at(i + 0.5);
      const top = topM(x, y);
      const beyond = floors.at(x + nx, y + ny, top);
      if (beyond !== null && beyond > top - stepM - 1e-6) continue;
      const bottomM = top - LEDGE_BELOW_M;
      const last = ledges.at(-1);
      if (last && last.bottomM === bottomM && same(last.b, at(i))) last.b = at(i + 1);
      else {
        const topM = top + LEDGE_ABOVE_M;
        ledges.push({ a: at(i), b: at(i + 1), bottomM, topM, door: null, inward: [-nx, -ny] });
      }
    }
    return ledges;
  });
}

function edgesOf(ring: Ring): [Vec2, Vec2][] {
  return ring.map((a, i) => [a, ring[(i + 1) % ring.length] ?? a]);
}

function isClockwise(ring: Ring): boolean {
  return edgesOf(ring).reduce((sum, [a, b]) => sum + a[0] * b[1] - b[0] * a[1], 0) < 0;
}

const same = (a: Vec2, b: Vec2): boolean => Math.hypot(a[0] - b[0], a[1] - b[1]) < 1e-9;
