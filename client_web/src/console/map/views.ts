/** Which part of the world the map shows, and where on the canvas: storeys beside each other. */

export type Bounds = readonly [x0: number, y0: number, x1: number, y1: number];

/** Room between storeys that are shown beside each other, as a part of their width. */
const GAP = 0.06;
const LEAST_PX_PER_M = 0.2;
const MOST_PX_PER_M = 400;

export class MapView {
  width = 1;
  height = 1;
  scale = 1;
  /** The point of the sheet in the middle of the canvas; the sheet has all storeys beside each other. */
  centreX = 0;
  centreY = 0;
  private bounds: Bounds = [0, 0, 1, 1];
  private heights: readonly number[] = [0];
  private columns = 1;
  /** The one storey that is shown; null shows all. */
  only: number | null = null;

  setWorld(bounds: Bounds, heights: readonly number[]): void {
    this.bounds = bounds;
    this.heights = heights.length > 0 ? heights : [0];
  }

  get storeys(): readonly number[] {
    return this.only === null ? this.heights.map((_, index) => index) : [this.only];
  }

  /** The storey on whose floor a height is: the highest whose floor is not well above it. */
  storeyOf(z: number): number {
    let found = 0;
    for (let index = 0; index < this.heights.length; index++) {
      const floor = this.heights[index] ?? 0;
      const best = this.heights[found] ?? 0;
      if (Math.abs(floor - z) < Math.abs(best - z)) found = index;
    }
    return found;
  }

  isShown(storey: number): boolean {
    return this.only === null || this.only === storey;
  }

  /** How far a storey is moved on the sheet. */
  offset(storey: number): readonly [number, number] {
    if (this.only !== null) return [0, 0];
    const [x0, y0, x1, y1] = this.bounds;
    const column = storey % this.columns;
    const row = Math.floor(storey / this.columns);
    const gap = GAP * Math.max(x1 - x0, y1 - y0);
    return [column * (x1 - x0 + gap), -row * (y1 - y0 + gap)];
  }

  /** Differs where the same point of the world may be elsewhere on the canvas. */
  get key(): string {
    const { width, height, scale, centreX, centreY, only, columns, heights } = this;
    return [
      width,
      height,
      scale,
      centreX,
      centreY,
      only,
      columns,
      ...this.bounds,
      ...heights,
    ].join();
  }

  sheetX(sheet: number): number {
    return (sheet - this.centreX) * this.scale + this.width / 2;
  }

  sheetY(sheet: number): number {
    return this.height / 2 - (sheet - this.centreY) * this.scale;
  }

  toCanvas(x: number, y: number, storey: number): [number, number] {
    const [dx, dy] = this.offset(storey);
    return [this.sheetX(x + dx), this.sheetY(y + dy)];
  }

  /** The point of the world at a point of the canvas; null outside of all storeys. */
  toWorld(px: number, py: number): { x: number; y: number; storey: number } | null {
    const sheetX = (px - this.width / 2) / this.scale + this.centreX;
    const sheetY = (this.height / 2 - py) / this.scale + this.centreY;
    const [x0, y0, x1, y1] = this.bounds;
    for (const storey of this.storeys) {
      const [dx, dy] = this.offset(storey);
      const x = sheetX - dx;
      const y = sheetY - dy;
      if (x >= x0 && x <= x1 && y >= y0 && y <= y1) return { x, y, storey };
    }
    return null;
  }

  /**
   * Show all of it, with storeys in as many columns as make it largest; at the bottom some pixels
   * stay free.
   */
  fit(freePx = 0): void {
    const height = Math.max(1, this.height - freePx);
    const [x0, y0, x1, y1] = this.bounds;
    const count = this.storeys.length;
    const gap = GAP * Math.max(x1 - x0, y1 - y0);
    let best = { scale: 0, columns: 1, across: 1, down: 1 };
    for (let columns = 1; columns <= count; columns++) {
      const across = columns * (x1 - x0 + gap) + gap;
      const rows = Math.ceil(count / columns);
      const down = rows * (y1 - y0 + gap) + gap;
      const scale = Math.min(this.width / across, height / down);
      if (scale > best.scale) best = { scale, columns, across, down };
    }
    this.columns = best.columns;
    this.scale = Math.max(LEAST_PX_PER_M, Math.min(MOST_PX_PER_M, best.scale));
    this.centreX = x0 - gap + best.across / 2;
    this.centreY = y1 + gap - best.down / 2 - freePx / 2 / this.scale;
  }

  panPx(dx: number, dy: number): void {
    this.centreX -= dx / this.scale;
    this.centreY += dy / this.scale;
  }

  /** Zoom so that what is at a point of the canvas stays there. */
  zoom(factor: number, px = this.width / 2, py = this.height / 2): void {
    const next = Math.max(LEAST_PX_PER_M, Math.min(MOST_PX_PER_M, this.scale * factor));
    const offX = px - this.width / 2;
    const offY = this.height / 2 - py;
    this.centreX += offX / this.scale - offX / next;
    this.centreY += offY / this.scale - offY / next;
    this.scale = next;
  }

  lookAt(x: number, y: number, storey: number): void {
    const [dx, dy] = this.offset(storey);
    this.centreX = x + dx;
    this.centreY = y + dy;
  }
}
