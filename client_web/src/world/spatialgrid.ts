/** A uniform grid over the ground; each square lists the items that can be met from within it. */

const BUCKET_M = 2;

export class SpatialGrid<T> {
  private readonly buckets = new Map<string, T[]>();

  /** The items of the square that holds (x, y). */
  at(x: number, y: number): readonly T[] {
    return this.buckets.get(`${indexOf(x)},${indexOf(y)}`) ?? [];
  }

  /**
   * Put an item into every square that the box touches, or, with `meets`, into those for whose middle it
   * holds; that is asked with half the diagonal of a square, metres.
   */
  put(
    item: T,
    [x0, y0, x1, y1]: readonly [number, number, number, number],
    meets: (x: number, y: number, reachM: number) => boolean = () => true,
  ): void {
    for (let i = indexOf(x0); i <= indexOf(x1); i++) {
      for (let j = indexOf(y0); j <= indexOf(y1); j++) {
        const [x, y] = [(i + 0.5) * BUCKET_M, (j + 0.5) * BUCKET_M];
        if (!meets(x, y, BUCKET_M * Math.SQRT1_2)) continue;
        const key = `${i},${j}`;
        const bucket = this.buckets.get(key);
        if (bucket) bucket.push(item);
        else this.buckets.set(key, [item]);
      }
    }
  }
}

const indexOf = (metres: number): number => Math.floor(metres / BUCKET_M);
