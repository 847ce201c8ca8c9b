/** The floors of a building as people count them. */

/** The storey, counted from 0, that is nearest to a height. */
export function storeyAt(heights: readonly number[], z: number): number {
  const off = heights.map((height) => Math.abs(height - z));
  return off.indexOf(Math.min(...off));
}
