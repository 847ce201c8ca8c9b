/** The world from above, north up: what stands, who walks, and what the own camera sees. */

import type { Plan, SceneData } from "../net/messages";
import type { Avatar } from "../world/world";
import { byId } from "./dom";

const KIND_COLORS = {
  building: "#8b8173",
  floor: "#f7f3ea",
  wall: "#6f675c",
  furniture: "#b08c63",
  plant: "#86a667",
  water: "#6fb3cf",
} as const;
const PERSON = "#2563c9";
const ACTOR = "#0b8279";
const OWN = "#e08a00";
const CONE_M = 14;
const CONE_HALF = 0.5;

export class Minimap {
  private readonly canvas = byId("minimap", HTMLCanvasElement);
  private readonly still = document.createElement("canvas");
  private scene: SceneData | null = null;
  private scale = 1;
  private left = 0;
  private top = 0;

  show(scene: SceneData): void {
    this.scene = scene;
    this.layOut();
    new ResizeObserver(() => {
      this.layOut();
    }).observe(this.canvas);
  }

  update(avatars: Iterable<Avatar>, cameraYaw: number, plan: Plan | null): void {
    const pen = this.canvas.getContext("2d");
    if (!pen || !this.scene) return;
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.still, 0, 0);
    if (plan) this.path(pen, plan);
    let own: Avatar | null = null;
    for (const avatar of avatars) {
      if (avatar.own) own = avatar;
      else if (avatar.kind === "actor") this.diamond(pen, avatar);
      else this.dot(pen, avatar, 2.6, PERSON);
    }
    if (!own) return;
    this.cone(pen, own, cameraYaw);
    this.dot(pen, own, 3.6, OWN);
  }

  /** Fit the scene into the canvas as large as it is shown, and draw what never moves. */
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
    if (pen) this.drawStill(pen, scene);
  }

  private drawStill(pen: CanvasRenderingContext2D, { bounds, polygons, walls }: SceneData): void {
    const [x0, y0, x1, y1] = bounds;
    pen.fillStyle = "#ece6da";
    pen.fillRect(...this.at(x0, y1), (x1 - x0) * this.scale, (y1 - y0) * this.scale);
    for (const { points, kind } of polygons) {
      pen.fillStyle = KIND_COLORS[kind];
      pen.beginPath();
      points.forEach(([x, y]) => {
        pen.lineTo(...this.at(x, y));
      });
      pen.fill();
    }
    pen.strokeStyle = KIND_COLORS.wall;
    pen.lineWidth = 1.5;
    pen.beginPath();
    for (const { start, end } of walls) {
      pen.moveTo(...this.at(...start));
      pen.lineTo(...this.at(...end));
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
    pen.beginPath();
    path.forEach(([x, y]) => {
      pen.lineTo(...this.at(x, y));
    });
    pen.stroke();
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
