/** The ground of a map that moves with somebody: drawn anew only when they come to its edge. */

import type { SceneData } from "../net/messages";
import { type MeshParts, meshParts, type Triangles } from "../world/mesh";
import { drawFloorplan, drawMesh } from "./floorplan";
import type { MapFit } from "./mapmarks";

/** The ground is drawn this much further than the canvas reaches, of its size to each side. */
const MARGIN = 0.25;
const BESIDE = "#d8d2c6";

export class MapGround {
  private readonly still = document.createElement("canvas");
  private readonly mesh: MeshParts | null;
  private drawn: { fit: MapFit; floorM: number } | null = null;

  /** `mesh` holds the triangles of a building that comes as one. */
  constructor(
    private readonly scene: SceneData,
    mesh: Triangles | null,
  ) {
    this.mesh = mesh && meshParts(mesh);
  }

  /** Draw the storey with the floor at `floorM` as `fit` has it. */
  draw(pen: CanvasRenderingContext2D, fit: MapFit, floorM: number): void {
    const { width, height } = pen.canvas;
    if (!this.holds(fit, floorM, width, height)) this.redraw(fit, floorM, width, height);
    const { left = 0, top = 0 } = this.drawn?.fit ?? {};
    pen.drawImage(this.still, fit.left - left - MARGIN * width, fit.top - top - MARGIN * height);
  }

  private holds(fit: MapFit, floorM: number, width: number, height: number): boolean {
    const { drawn, still } = this;
    return (
      drawn !== null &&
      drawn.floorM === floorM &&
      drawn.fit.scale === fit.scale &&
      still.width === withMargin(width) &&
      still.height === withMargin(height) &&
      Math.abs(fit.left - drawn.fit.left) <= MARGIN * width &&
      Math.abs(fit.top - drawn.fit.top) <= MARGIN * height
    );
  }

  private redraw(fit: MapFit, floorM: number, width: number, height: number): void {
    const { still, scene, mesh } = this;
    still.width = withMargin(width);
    still.height = withMargin(height);
    const pen = still.getContext("2d");
    if (!pen) return;
    pen.fillStyle = BESIDE;
    pen.fillRect(0, 0, still.width, still.height);
    const at = (x: number, y: number): [number, number] => [
      fit.left + x * fit.scale + MARGIN * width,
      fit.top - y * fit.scale + MARGIN * height,
    ];
    drawFloorplan(pen, scene, floorM, at);
    if (mesh) drawMesh(pen, mesh, floorM, at);
    this.drawn = { fit, floorM };
  }
}

function withMargin(size: number): number {
  return Math.ceil(size * (1 + 2 * MARGIN));
}
