/** The world from above, north up: one storey, everybody in view, and the own camera's cone. */

import type { Doors, Plan, SceneData } from "../net/messages";
import { type MeshParts, meshParts, type Triangles } from "../world/mesh";
import { storeyAt } from "../world/storeys";
import type { Avatar } from "../world/world";
import { byId } from "./dom";
import { drawFloorplan, drawMesh, stands } from "./floorplan";
import { StoreySwitch } from "./storeyswitch";

const PERSON = "#2563c9";
const ACTOR = "#0b8279";
const OWN = "#e08a00";
const DOOR = "#a4551e";
/** Avatars on other storeys are drawn with this opacity. */
const ELSEWHERE = 0.25;
const CONE_M = 14;
const CONE_HALF = 0.5;

export class Minimap {
  private readonly canvas = byId("minimap", HTMLCanvasElement);
  private readonly still = document.createElement("canvas");
  private scene: SceneData | null = null;
  private mesh: MeshParts | null = null;
  private readonly choice = new StoreySwitch(() => {
    this.layOut();
  });
  private scale = 1;
  private left = 0;
  private top = 0;

  constructor() {
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
    if (!pen || !this.scene) return;
    if (own) this.choice.follow(storeyAt(this.scene.storeys, own.pose.z));
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.still, 0, 0);
    this.drawDoors(pen, this.scene, doors);
    if (plan) this.path(pen, plan);
    for (const avatar of avatars.values()) {
      if (avatar.own) continue;
      pen.globalAlpha = this.isHere(avatar.pose.z) ? 1 : ELSEWHERE;
      if (avatar.kind === "actor") this.diamond(pen, avatar);
      else this.dot(pen, avatar, 2.6, PERSON);
    }
    if (own) {
      pen.globalAlpha = this.isHere(own.pose.z) ? 1 : ELSEWHERE;
      this.cone(pen, own, cameraYaw);
      this.dot(pen, own, 3.6, OWN);
    }
    pen.globalAlpha = 1;
  }

  /** Fit the scene into the canvas as large as it is shown, and draw everything that never moves. */
  private layOut(): void {
    if (!this.scene) return;
    const { canvas, still, scene } = this;
    const ratio = Math.min(2, window.devicePixelRatio);
    canvas.width = still.width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    canvas.height = still.height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    const [x0, y0, x1, y1] = scene.bounds;
    this.scale = Math.min(canvas.width / (x1 - x0), canvas.height / (y1 - y0));
    this.left = (canvas.width - (x1 - x0) * this.scale) / 2 - x0 * this.scale;
    this.top = (canvas.height - (y1 - y0) * this.scale) / 2 + y1 * this.scale;
    const pen = still.getContext("2d");
    if (!pen) return;
    const at = (x: number, y: number): [number, number] => this.at(x, y);
    drawFloorplan(pen, scene, this.floorM, at);
    if (this.mesh) drawMesh(pen, this.mesh, this.floorM, at);
  }

  /** Height of the shown storey's floor. */
  private get floorM(): number {
    return this.scene?.storeys[this.choice.shown] ?? 0;
  }

  private isHere(z: number): boolean {
    return storeyAt(this.scene?.storeys ?? [], z) === this.choice.shown;
  }

  /** Closed doors are drawn across their way, open ones swung aside. */
  private drawDoors(
    pen: CanvasRenderingContext2D,
    { doors }: SceneData,
    open: Readonly<Doors>,
  ): void {
    pen.strokeStyle = DOOR;
    pen.lineWidth = 1.6 * this.pixel;
    pen.beginPath();
    for (const { name, start, end, offset_m, height_m } of doors) {
      if (!stands(offset_m, offset_m + height_m, this.floorM)) continue;
      const [dx, dy] = [end[0] - start[0], end[1] - start[1]];
      const tip = open[name] === false ? end : ([start[0] - dy, start[1] + dx] as const);
      pen.moveTo(...this.at(...start));
      pen.lineTo(...this.at(...tip));
    }
    pen.stroke();
  }

  private at(x: number, y: number): [number, number] {
    return [this.left + x * this.scale, this.top - y * this.scale];
  }

  private get pixel(): number {
    return this.canvas.width / Math.max(1, this.canvas.clientWidth);
  }

  private dot(
    pen: CanvasRenderingContext2D,
    { pose }: Avatar,
    radius: number,
    color: string,
  ): void {
    pen.beginPath();
    pen.arc(...this.at(pose.x, pose.y), radius * this.pixel, 0, 2 * Math.PI);
    this.fill(pen, color);
  }

  private diamond(pen: CanvasRenderingContext2D, { pose }: Avatar): void {
    const [x, y] = this.at(pose.x, pose.y);
    const half = 3.2 * this.pixel;
    pen.beginPath();
    pen.moveTo(x, y - half);
    pen.lineTo(x + half, y);
    pen.lineTo(x, y + half);
    pen.lineTo(x - half, y);
    pen.closePath();
    this.fill(pen, ACTOR);
  }

  private fill(pen: CanvasRenderingContext2D, color: string): void {
    pen.fillStyle = color;
    pen.fill();
    pen.strokeStyle = "#ffffff";
    pen.lineWidth = 0.8 * this.pixel;
    pen.stroke();
  }

  private path(pen: CanvasRenderingContext2D, { path }: Plan): void {
    pen.strokeStyle = ACTOR;
    pen.lineWidth = 1.5 * this.pixel;
    path.forEach(([x, y, z], i) => {
      const before = path[i - 1];
      if (!before) return;
      pen.globalAlpha = this.isHere(z) ? 1 : ELSEWHERE;
      pen.beginPath();
      pen.moveTo(...this.at(before[0], before[1]));
      pen.lineTo(...this.at(x, y));
      pen.stroke();
    });
    pen.globalAlpha = 1;
  }

  private cone(pen: CanvasRenderingContext2D, { pose }: Avatar, yaw: number): void {
    const [x, y] = this.at(pose.x, pose.y);
    pen.fillStyle = "rgb(224 138 0 / 28%)";
    pen.beginPath();
    pen.moveTo(x, y);
    pen.arc(x, y, CONE_M * this.scale, -yaw - CONE_HALF, -yaw + CONE_HALF);
    pen.fill();
  }
}
