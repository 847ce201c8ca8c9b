/** What a walking disc bumps into: the edges of the scene's prisms and its thin walls. */

export type Vec2 = readonly [x: number, y: number];

interface Ground {
  bounds: readonly [x0: number, y0: number, x1: number, y1: number];
  polygons: readonly { points: readonly Vec2[] }[];
  walls: readonly { start: Vec2; end: Vec2 }[];
}

interface Edge {
  a: Vec2;
  b: Vec2;
}

const BUCKET_M = 2;
/** Discs may be as large as this. */
const LARGEST_RADIUS_M = 0.75;
const STEP_M = 0.1;
const PUSHES = 4;

/** The obstacles of one layer. There is one layer, 0. */
export class Obstacles {
  private readonly buckets = new Map<string, Edge[]>();
  private readonly bounds: Ground["bounds"];

  constructor(ground: Ground) {
    this.bounds = ground.bounds;
    for (const { points } of ground.polygons) {
      points.forEach((a, i) => {
        this.add({ a, b: points[(i + 1) % points.length] ?? a });
      });
    }
    for (const { start, end } of ground.walls) this.add({ a: start, b: end });
  }

  /** Where a disc gets to that wants to move by (dx, dy): it slides along what is in the way. */
  walk(from: Vec2, dx: number, dy: number, radiusM: number): Vec2 {
    const steps = Math.max(1, Math.ceil(Math.hypot(dx, dy) / STEP_M));
    let at = from;
    for (let i = 0; i < steps; i++) {
      at = this.pushOut([at[0] + dx / steps, at[1] + dy / steps], radiusM);
    }
    return at;
  }

  /** Whether a disc can go straight from one point to the other. */
  clear(from: Vec2, to: Vec2, radiusM: number): boolean {
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    const steps = Math.ceil(length / STEP_M);
    for (let i = 1; i <= steps; i++) {
      const part = i / steps;
      const at: Vec2 = [from[0] + (to[0] - from[0]) * part, from[1] + (to[1] - from[1]) * part];
      const meets = this.near(at).some((edge) => {
        const [x, y] = nearestOn(edge, at);
        return Math.hypot(at[0] - x, at[1] - y) < radiusM;
      });
      if (meets) return false;
    }
    return true;
  }

  private pushOut(wish: Vec2, radiusM: number): Vec2 {
    let [x, y] = wish;
    for (let push = 0; push < PUSHES; push++) {
      let moved = false;
      for (const edge of this.near([x, y])) {
        const [ex, ey] = nearestOn(edge, [x, y]);
        const distance = Math.hypot(x - ex, y - ey);
        if (distance >= radiusM || distance < 1e-9) continue;
        x = ex + ((x - ex) / distance) * radiusM;
        y = ey + ((y - ey) / distance) * radiusM;
        moved = true;
      }
      if (!moved) break;
    }
    const [x0, y0, x1, y1] = this.bounds;
    return [Math.min(x1, Math.max(x0, x)), Math.min(y1, Math.max(y0, y))];
  }

  private near([x, y]: Vec2): readonly Edge[] {
    return this.buckets.get(bucketKey(x, y)) ?? [];
  }

  /** Into every bucket from which the edge can be touched. */
  private add(edge: Edge): void {
    const [ax, ay] = edge.a;
    const [bx, by] = edge.b;
    const reach = LARGEST_RADIUS_M;
    const across = reach + BUCKET_M * Math.SQRT1_2;
    const [i0, i1] = [Math.min(ax, bx) - reach, Math.max(ax, bx) + reach].map(bucketOf) as [
      number,
      number,
    ];
    const [j0, j1] = [Math.min(ay, by) - reach, Math.max(ay, by) + reach].map(bucketOf) as [
      number,
      number,
    ];
    for (let i = i0; i <= i1; i++) {
      for (let j = j0; j <= j1; j++) {
        const centre: Vec2 = [(i + 0.5) * BUCKET_M, (j + 0.5) * BUCKET_M];
        const [x, y] = nearestOn(edge, centre);
        if (Math.hypot(centre[0] - x, centre[1] - y) > across) continue;
        const key = `${i},${j}`;
        const bucket = this.buckets.get(key);
        if (bucket) bucket.push(edge);
        else this.buckets.set(key, [edge]);
      }
    }
  }
}

const bucketOf = (metres: number): number => Math.floor(metres / BUCKET_M);
const bucketKey = (x: number, y: number): string => `${bucketOf(x)},${bucketOf(y)}`;

function nearestOn({ a, b }: Edge, [x, y]: Vec2): Vec2 {
  const dx = b[0] - a[0];
  const dy = b[1] - a[1];
  const lengthSq = dx * dx + dy * dy;
  if (lengthSq === 0) return a;
  const part = Math.max(0, Math.min(1, ((x - a[0]) * dx + (y - a[1]) * dy) / lengthSq));
  return [a[0] + dx * part, a[1] + dy * part];
}
