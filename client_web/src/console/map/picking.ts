/** Finding those under a click, in a box, or within a drawn line, in pixels of the canvas. */

export type Pixel = readonly [number, number];

/** The index of the nearest of some points; null where none is near enough. */
export function nearest(points: readonly Pixel[], at: Pixel, withinPx: number): number | null {
  let found: number | null = null;
  let least = withinPx;
  points.forEach(([x, y], index) => {
    const away = Math.hypot(x - at[0], y - at[1]);
    if (away <= least) {
      least = away;
      found = index;
    }
  });
  return found;
}

/** The corners of the box between two points. */
export function boxOf([x0, y0]: Pixel, [x1, y1]: Pixel): readonly Pixel[] {
  return [
    [x0, y0],
    [x1, y0],
    [x1, y1],
    [x0, y1],
  ];
}

/** Whether a point is within a ring, by the even-odd rule. */
export function isWithin([x, y]: Pixel, ring: readonly Pixel[]): boolean {
  let within = false;
  let before = ring.at(-1);
  for (const corner of ring) {
    if (before && corner[1] > y !== before[1] > y) {
      const part = (y - corner[1]) / (before[1] - corner[1]);
      if (x < corner[0] + part * (before[0] - corner[0])) within = !within;
    }
    before = corner;
  }
  return within;
}
