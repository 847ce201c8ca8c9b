/** What travels on the wire, as `protocol/messages.py` defines it. Metres, radians, seconds. */

import type { Kind } from "./codes";

export type Point = [x: number, y: number];
export type PlacePoint = [x: number, y: number, layer: number];

export type ClientMessage =
  | { type: "hello"; name: string; resume: string | null }
  | { type: "move"; seq: number; direction: number; speed: number }
  | { type: "walk_to"; seq: number; x: number; y: number; layer: number }
  | { type: "chat"; text: string }
  | { type: "ping"; nonce: number }
  | { type: "watch"; id: number | null };

export interface ScenePolygon {
  points: Point[];
  height_m: number;
  offset_m: number;
  kind: "building" | "wall" | "furniture" | "plant" | "water";
  name: string;
}

export interface SceneWall {
  start: Point;
  end: Point;
  height_m: number;
}

export interface ScenePlace {
  name: string;
  position: Point;
  layer: number;
}

export interface SceneData {
  name: string;
  bounds: [x0: number, y0: number, x1: number, y1: number];
  polygons: ScenePolygon[];
  walls: SceneWall[];
  places: ScenePlace[];
}

export interface Welcome {
  type: "welcome";
  version: number;
  id: number;
  name: string;
  resume: string;
  resumed: boolean;
  scene: SceneData;
  tick: number;
  tick_rate: number;
  server_time: number;
  radius: number;
  max_speed: number;
  origin: Point;
}

/** One avatar as it comes into view. */
export interface EntityInfo {
  id: number;
  kind: Kind;
  name: string;
  layer: number;
  x: number;
  y: number;
  heading: number;
  radius: number;
}

/** One avatar's record in a snapshot, in world coordinates. */
export interface EntityRecord {
  id: number;
  layer: number;
  reason: number;
  x: number;
  y: number;
  heading: number;
  speed: number;
}

export interface Snapshot {
  type: "snapshot";
  tick: number;
  ack: number;
  block: Uint8Array;
}

export interface PlanCircle {
  x: number;
  y: number;
  layer: number;
  radius: number;
}

export interface Plan {
  type: "plan";
  tick: number;
  id: number;
  reason: number;
  behaviour: string;
  goal: PlacePoint | null;
  /** Points (x, y, layer, seconds from now). */
  path: [x: number, y: number, layer: number, seconds: number][];
  people: PlanCircle[][];
}

export interface ChatMessage {
  type: "chat";
  id: number;
  name: string;
  text: string;
}

export type ServerMessage =
  | Welcome
  | Snapshot
  | Plan
  | ChatMessage
  | { type: "enter"; tick: number; entities: EntityInfo[] }
  | { type: "leave"; tick: number; ids: number[] }
  | { type: "notice"; text: string }
  | { type: "error"; error: string; text: string }
  | { type: "bye"; reason: string; text: string }
  | { type: "pong"; nonce: number; server_time: number }
  | { type: "census"; people: number; actors: number };
