/** The picture of a browser that draws nothing in three dimensions: a large map, north up. */

import type { Place, ScreenPoint } from "../render/picking";
import { MapNames } from "./mapnames";
import { type MapFit, MapMarks } from "../ui/mapmarks";
import { MapGround } from "../ui/mapground";
import { storeyAt } from "../world/storeys";
import type { Triangles } from "../world/mesh";
import type { Avatar, World } from "../world/world";
import { Cost } from "./cost";
import type { Picked, Picture } from "./picture";

const NORTH = Math.PI / 2;
/** Pixels of the page a metre: at first, and as far as one may zoom. */
const FIRST_SCALE = 26;
const LEAST_SCALE = 5;
const MOST_SCALE = 90;
const MARK_SIZE = 2.6;
/** One may click this far beside somebody, or a door, pixels of the page. */
const BESIDE_PX = 14;
const DOOR_PX = 10;
const CHOSEN = "#ffc233";
const TARGET = "#d33f2f";

export class MapView implements Picture {
  readonly placing = new Cost();
  readonly qualityLevel = 0;
  readonly drawsFigures = false;
  readonly camera = {
    yaw: NORTH,
    orbit: (): void => undefined,
    zoom: (factor: number): void => {
      this.scale = Math.max(LEAST_SCALE, Math.min(MOST_SCALE, this.scale / factor));
    },
    turnTo: (): void => undefined,
  };
  readonly marks = {
    walkTarget: (at: Place | null): void => {
      this.target = at;
    },
  };
  /** A map shows no joints. */
  readonly skeletons = { show: (): void => undefined };
  private scale = FIRST_SCALE;
  private target: Place | null = null;
  private world: World | null = null;
  private ground: MapGround | null = null;
  private readonly names = new MapNames();
  private fit: MapFit = { scale: 1, left: 0, top: 0, pixel: 1 };

  constructor(private readonly canvas: HTMLCanvasElement) {}

  enter(world: World, mesh: Triangles | null = null): void {
    this.world = world;
    this.ground = new MapGround(world.scene, mesh);
    this.target = null;
  }

  lookAround(): void {
    // A map shows all that is around.
  }

  choose(): void {
    // A map is drawn in one way only.
  }

  say(avatar: Avatar, text: string): void {
    this.names.say(avatar.id, text);
  }

  pick(at: ScreenPoint, doors: boolean): Picked {
    const { world } = this;
    if (!world?.own) return null;
    const z = world.own.pose.z;
    const { x, y } = this.placeAt(at);
    const reachM = (BESIDE_PX * this.fit.pixel) / this.fit.scale;
    const near = [...world.avatars.values()]
      .filter(({ own, pose }) => !own && this.isHere(world, pose.z))
      .map((avatar) => ({ avatar, apartM: Math.hypot(avatar.pose.x - x, avatar.pose.y - y) }))
      .filter(({ avatar, apartM }) => apartM < Math.max(reachM, avatar.radius))
      .sort((a, b) => a.apartM - b.apartM)[0];
    if (near) return { avatar: near.avatar };
    const door = doors ? this.doorAt(world, x, y) : null;
    if (door !== null) return { door };
    return { floor: { x, y, z: world.floors.at(x, y, z) ?? z } };
  }

  frame(world: World, chosenId: number | null): void {
    const pen = this.canvas.getContext("2d");
    const { own, avatars, scene } = world;
    if (!pen || !own || !this.ground) return;
    this.follow(own);
    const storey = storeyAt(scene.storeys, own.pose.z);
    const floorM = scene.storeys[storey] ?? 0;
    this.ground.draw(pen, this.fit, floorM);
    const marks = new MapMarks(pen, this.fit, (z) => this.isHere(world, z));
    marks.doors(scene, world.doors, floorM);
    if (world.plan) marks.path(world.plan);
    for (const avatar of avatars.values()) if (!avatar.own) marks.other(avatar, MARK_SIZE);
    marks.own(own, own.pose.heading, MARK_SIZE);
    const chosen = chosenId === null ? undefined : avatars.get(chosenId);
    if (chosen) this.ring(pen, marks.at(chosen.pose.x, chosen.pose.y), CHOSEN);
    if (this.target) this.ring(pen, marks.at(this.target.x, this.target.y), TARGET);
    const here = [...avatars.values()].filter(({ pose }) => this.isHere(world, pose.z));
    this.names.draw(pen, this.fit.pixel, here, own, ({ pose }) => marks.at(pose.x, pose.y));
  }

  /** The own avatar is in the middle of a canvas as large as it is shown. */
  private follow({ pose }: Avatar): void {
    const { canvas } = this;
    const pixel = Math.min(2, window.devicePixelRatio);
    const width = Math.max(1, Math.round(canvas.clientWidth * pixel));
    const height = Math.max(1, Math.round(canvas.clientHeight * pixel));
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    const scale = this.scale * pixel;
    const [left, top] = [width / 2 - pose.x * scale, height / 2 + pose.y * scale];
    this.fit = { scale, left, top, pixel };
  }

  private placeAt({ x, y }: ScreenPoint): { x: number; y: number } {
    const { canvas, fit } = this;
    const across = ((x + 1) / 2) * canvas.width;
    const down = ((1 - y) / 2) * canvas.height;
    return { x: (across - fit.left) / fit.scale, y: (fit.top - down) / fit.scale };
  }

  private doorAt({ scene }: World, x: number, y: number): string | null {
    const reachM = (DOOR_PX * this.fit.pixel) / this.fit.scale;
    for (const { name, start, end } of scene.doors) {
      const middle = [(start[0] + end[0]) / 2, (start[1] + end[1]) / 2] as const;
      const halfM = Math.hypot(end[0] - start[0], end[1] - start[1]) / 2;
      if (Math.hypot(x - middle[0], y - middle[1]) < halfM + reachM) return name;
    }
    return null;
  }

  private isHere({ scene, own }: World, z: number): boolean {
    return own !== null && storeyAt(scene.storeys, z) === storeyAt(scene.storeys, own.pose.z);
  }

  private ring(pen: CanvasRenderingContext2D, at: [number, number], color: string): void {
    pen.strokeStyle = color;
    pen.lineWidth = 3 * this.fit.pixel;
    pen.beginPath();
    pen.arc(...at, 13 * this.fit.pixel, 0, 2 * Math.PI);
    pen.stroke();
  }
}
