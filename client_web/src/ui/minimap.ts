/** The world from above, north up: one storey, everybody in view, and the own camera's cone. */

import type { Doors, Plan, SceneData } from "../net/messages";
import { type MeshParts, meshParts, type Triangles } from "../world/mesh";
import { storeyAt } from "../world/storeys";
import type { Avatar } from "../world/world";
import { byId } from "./dom";
import { drawFloorplan, drawMesh } from "./floorplan";
import { MapMarks } from "./mapmarks";
import { StoreySwitch } from "./storeyswitch";

/** One may click this far beside somebody, pixels of the page. */
const BESIDE_PX = 7;

/** A click on the map means somebody, or a place on the shown storey. */
export type Tapped = { avatar: Avatar } | { floor: { x: number; y: number; z: number } };

export class Minimap {
  private readonly canvas = byId("minimap", HTMLCanvasElement);
  private readonly still = document.createElement("canvas");
  private scene: SceneData | null = null;
  private mesh: MeshParts | null = null;
  private readonly choice = new StoreySwitch(() => {
    this.layOut();
  });
  private readonly fit = { scale: 1, left: 0, top: 0, pixel: 1 };

  private avatars: ReadonlyMap<number, Avatar> = new Map();

  constructor(tap: (at: Tapped) => void) {
    this.canvas.addEventListener("click", (event) => {
      const at = this.at(event.offsetX, event.offsetY);
      if (at) tap(at);
    });
    new ResizeObserver(() => {
      this.layOut();
    }).observe(this.canvas);
  }

  /** The map of a scene; `mesh` holds the triangles of a building that comes as one. */
  show(scene: SceneData, mesh: Triangles | null = null): void {
    this.scene = scene;
    this.mesh = mesh && meshParts(mesh);
    this.choice.offer(scene.storeys.length);
    this.layOut();
  }

  update(
    avatars: ReadonlyMap<number, Avatar>,
    own: Avatar | null,
    doors: Readonly<Doors>,
    cameraYaw: number,
    plan: Plan | null,
  ): void {
    const pen = this.canvas.getContext("2d");
    const { scene, choice } = this;
    this.avatars = avatars;
    if (!pen || !scene) return;
    if (own) choice.follow(storeyAt(scene.storeys, own.pose.z));
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.still, 0, 0);
    const isHere = (z: number): boolean => storeyAt(scene.storeys, z) === choice.shown;
    const marks = new MapMarks(pen, this.fit, isHere);
    marks.doors(scene, doors, this.floorM);
    if (plan) marks.path(plan);
    for (const avatar of avatars.values()) if (!avatar.own) marks.other(avatar, 1);
    if (own) marks.own(own, cameraYaw, 1);
  }

  /** Whoever is at a point of the map, pixels of the page, else the place there. */
  private at(left: number, top: number): Tapped | null {
    const { scene, fit } = this;
    if (!scene) return null;
    const x = (left * fit.pixel - fit.left) / fit.scale;
    const y = (fit.top - top * fit.pixel) / fit.scale;
    const reachM = (BESIDE_PX * fit.pixel) / fit.scale;
    const near = [...this.avatars.values()]
      .filter(({ own, pose }) => !own && storeyAt(scene.storeys, pose.z) === this.choice.shown)
      .map((avatar) => ({ avatar, apartM: Math.hypot(avatar.pose.x - x, avatar.pose.y - y) }))
      .filter(({ apartM }) => apartM < reachM)
      .sort((a, b) => a.apartM - b.apartM)[0];
    if (near) return { avatar: near.avatar };
    const [x0, y0, x1, y1] = scene.bounds;
    if (x < x0 || x > x1 || y < y0 || y > y1) return null;
    return { floor: { x, y, z: this.floorM } };
  }

  /** Fit the scene into the canvas as large as it is shown, and draw everything that never moves. */
  private layOut(): void {
    if (!this.scene) return;
    const { canvas, still, scene, fit } = this;
    const ratio = Math.min(2, window.devicePixelRatio);
    canvas.width = still.width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    canvas.height = still.height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    const [x0, y0, x1, y1] = scene.bounds;
    fit.scale = Math.min(canvas.width / (x1 - x0), canvas.height / (y1 - y0));
    fit.left = (canvas.width - (x1 - x0) * fit.scale) / 2 - x0 * fit.scale;
    fit.top = (canvas.height - (y1 - y0) * fit.scale) / 2 + y1 * fit.scale;
    fit.pixel = canvas.width / Math.max(1, canvas.clientWidth);
    const pen = still.getContext("2d");
    if (!pen) return;
    const at = (x: number, y: number): [number, number] => [
      fit.left + x * fit.scale,
      fit.top - y * fit.scale,
    ];
    drawFloorplan(pen, scene, this.floorM, at);
    if (this.mesh) drawMesh(pen, this.mesh, this.floorM, at);
  }

  /** Height of the shown storey's floor. */
  private get floorM(): number {
    return this.scene?.storeys[this.choice.shown] ?? 0;
  }
}
