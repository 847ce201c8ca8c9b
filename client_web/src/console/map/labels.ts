/** Finds room for the names on the map, so that none is printed over another. */

export type Box = readonly [left: number, top: number, right: number, bottom: number];

/** A name that wants to stand beside a point. */
export interface Wish {
  x: number;
  y: number;
  width: number;
}

/** Where the text begins, on its baseline. */
export interface Spot {
  x: number;
  y: number;
}

const EVERYWHERE: Box = [-Infinity, -Infinity, Infinity, Infinity];
const HEIGHT_PX = 12;
const BESIDE_PX = 8;

/**
 * A spot for each name, in their order: to the right of its point, to its left, above, or below.
 * A name for which no room is left has none. Names keep away from each other, and where they can
 * they keep within `within`, and away from `avoided` too.
 */
export function spots(
  wishes: readonly Wish[],
  avoided: readonly Box[] = [],
  within: Box = EVERYWHERE,
): (Spot | null)[] {
  const taken: Box[] = [];
  return wishes.map((wish) => {
    const free = sides(wish).filter((spot) => !hits(boxAt(spot, wish.width), taken));
    const whole = free.filter((spot) => lies(boxAt(spot, wish.width), within));
    const best = whole.length > 0 ? whole : free;
    const spot = best.find((one) => !hits(boxAt(one, wish.width), avoided)) ?? best[0] ?? null;
    if (spot) taken.push(boxAt(spot, wish.width));
    return spot;
  });
}

export function boxAt({ x, y }: Spot, width: number): Box {
  return [x - 1, y - HEIGHT_PX + 2, x + width + 1, y + 3];
}

function sides({ x, y, width }: Wish): Spot[] {
  const left = x - BESIDE_PX - width;
  return [
    { x: x + BESIDE_PX, y: y - 6 },
    { x: left, y: y - 6 },
    { x: x + BESIDE_PX, y: y + 13 },
    { x: left, y: y + 13 },
  ];
}

function hits([left, top, right, bottom]: Box, others: readonly Box[]): boolean {
  return others.some(([l, t, r, b]) => left < r && right > l && top < b && bottom > t);
}

function lies([left, top, right, bottom]: Box, [l, t, r, b]: Box): boolean {
  return left >= l && top >= t && right <= r && bottom <= b;
}
