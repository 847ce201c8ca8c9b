/** The moving things on a map: doors, people, actors, the path of a plan, and where the own camera looks. */

import type { Doors, Plan, SceneData } from "../net/messages";
import { hasSign } from "../world/guides";
import type { Avatar } from "../world/world";
import { stands } from "./floorplan";

const PERSON = "#2563c9";
const ACTOR = "#0b8279";
const GUIDE = "#b3261e";
const OWN = "#e08a00";
const DOOR = "#a4551e";
/** Avatars on other storeys are drawn with this opacity. */
const ELSEWHERE = 0.25;
const CONE_M = 14;
/** On a large map the cone ends sooner, after so many pixels of the page. */
const CONE_PX = 70;
const CONE_HALF = 0.5;

/** Where a map lies on its canvas: pixels of the canvas a metre, and of the world's origin. */
export interface MapFit {
  scale: number;
  left: number;
  top: number;
  /** Pixels of the canvas for one of the page. */
  pixel: number;
}

export class MapMarks {
  /** `isHere` tells whether a height belongs to the storey that is shown. */
  constructor(
    private readonly pen: CanvasRenderingContext2D,
    private readonly fit: MapFit,
    private readonly isHere: (z: number) => boolean,
  ) {}

  at(x: number, y: number): [number, number] {
    return [this.fit.left + x * this.fit.scale, this.fit.top - y * this.fit.scale];
  }

  /** Closed doors are drawn across their way, open ones swung aside. */
  doors({ doors }: SceneData, open: Readonly<Doors>, floorM: number): void {
    const { pen } = this;
    pen.strokeStyle = DOOR;
    pen.lineWidth = 1.6 * this.fit.pixel;
    pen.beginPath();
    for (const { name, start, end, offset_m, height_m } of doors) {
      if (!stands(offset_m, offset_m + height_m, floorM)) continue;
      const [dx, dy] = [end[0] - start[0], end[1] - start[1]];
      const tip = open[name] === false ? end : ([start[0] - dy, start[1] + dx] as const);
      pen.moveTo(...this.at(...start));
      pen.lineTo(...this.at(...tip));
    }
    pen.stroke();
  }

  /** Somebody else: people are dots, actors are diamonds, guides larger ones. `size` is 1 on a small map. */
  other({ kind, pose, look }: Avatar, size: number): void {
    this.pen.globalAlpha = this.isHere(pose.z) ? 1 : ELSEWHERE;
    if (hasSign(look)) this.diamond(pose, 4.8 * size, GUIDE);
    else if (kind === "actor") this.diamond(pose, 3.2 * size, ACTOR);
    else this.dot(pose, 2.6 * size, PERSON);
    this.pen.globalAlpha = 1;
  }

  /** The own avatar, with the cone into which its camera looks. */
  own({ pose }: Avatar, yaw: number, size: number): void {
    this.pen.globalAlpha = this.isHere(pose.z) ? 1 : ELSEWHERE;
    this.cone(pose, yaw);
    this.dot(pose, 3.6 * size, OWN);
    this.pen.globalAlpha = 1;
  }

  path({ path }: Plan): void {
    const { pen } = this;
    pen.strokeStyle = ACTOR;
    pen.lineWidth = 1.5 * this.fit.pixel;
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

  private dot({ x, y }: { x: number; y: number }, radius: number, color: string): void {
    this.pen.beginPath();
    this.pen.arc(...this.at(x, y), radius * this.fit.pixel, 0, 2 * Math.PI);
    this.fill(color);
  }

  private diamond(pose: { x: number; y: number }, halfPx: number, color: string): void {
    const [x, y] = this.at(pose.x, pose.y);
    const half = halfPx * this.fit.pixel;
    this.pen.beginPath();
    this.pen.moveTo(x, y - half);
    this.pen.lineTo(x + half, y);
    this.pen.lineTo(x, y + half);
    this.pen.lineTo(x - half, y);
    this.pen.closePath();
    this.fill(color);
  }

  private fill(color: string): void {
    this.pen.fillStyle = color;
    this.pen.fill();
    this.pen.strokeStyle = "#ffffff";
    this.pen.lineWidth = 0.8 * this.fit.pixel;
    this.pen.stroke();
  }

  private cone(pose: { x: number; y: number }, yaw: number): void {
    const [x, y] = this.at(pose.x, pose.y);
    this.pen.fillStyle = "rgb(224 138 0 / 28%)";
    this.pen.beginPath();
    this.pen.moveTo(x, y);
    const reach = Math.min(CONE_M * this.fit.scale, CONE_PX * this.fit.pixel);
    this.pen.arc(x, y, reach, -yaw - CONE_HALF, -yaw + CONE_HALF);
    this.pen.fill();
  }
}
