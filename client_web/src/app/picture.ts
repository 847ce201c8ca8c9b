/** The picture as a session uses it, drawn in three dimensions or as a map. */

import type { Place, ScreenPoint } from "../render/picking";
import type { Choice } from "../render/quality";
import type { Triangles } from "../world/mesh";
import type { Avatar, World } from "../world/world";
import type { Cost } from "./cost";

/** The thing at a point of the screen. */
export type Picked = { avatar: Avatar } | { door: string } | { floor: Place } | null;

export interface Picture {
  readonly camera: {
    /** Direction in which it looks on the ground, radians from +x. */
    yaw: number;
    orbit(yaw: number, pitch: number): void;
    zoom(factor: number): void;
    turnTo(at: { x: number; y: number }): void;
  };
  readonly marks: { walkTarget(at: Place | null): void };
  readonly skeletons: { show(shown: boolean): void };
  readonly placing: Cost;
  readonly qualityLevel: number;
  /** Whether it shows people as figures. */
  readonly drawsFigures: boolean;
  /** Show this world from now on. */
  enter(world: World, mesh?: Triangles | null): void;
  /** Turn the camera to where the own avatar sees people, or furthest. */
  lookAround(world: World): void;
  choose(choice: Choice): void;
  say(avatar: Avatar, text: string): void;
  /** Doors are found only for those who may move them. */
  pick(at: ScreenPoint, doors: boolean): Picked;
  frame(world: World, chosenId: number | null, frameS: number): void;
}
