/**
 * The messages on the wire, as `protocol/messages.py` defines them. Metres, radians, seconds; z is
 * the height of the feet above the scene's ground.
 */

import type { Kind } from "./codes";

export type Point = [x: number, y: number];
export type Place = [x: number, y: number, z: number];

export type ClientMessage =
  | {
      type: "hello";
      name: string;
      resume: string | null;
      operator: string | null;
      admission: Admission | null;
      look: Look | null;
    }
  | { type: "move"; seq: number; direction: number; speed: number }
  | { type: "walk_to"; seq: number; x: number; y: number; z: number; strict?: boolean }
  | { type: "chat"; text: string }
  | { type: "ping"; nonce: number }
  | { type: "watch"; id: number | null }
  | { type: "set_door"; name: string; open: boolean }
  | { type: "report"; id: number; line: number | null; text: string }
  | { type: "mute"; id: number; muted: boolean }
  /** The person is away from the screen, or there again. */
  | { type: "presence"; away: boolean }
  | { type: "gesture"; gesture: number }
  | { type: "look"; look: Look };

/**
 * Clothes, hair, skin and stature of an avatar, each a number; 0 is one that is not chosen, and
 * follows from the avatar's id. Guides have a sign, which is 1; nobody can choose one.
 */
export type Look = readonly [
  shirt: number,
  trousers: number,
  hair: number,
  hairColour: number,
  skin: number,
  statureCm: number,
  sign?: number,
];

/** The arguments of a sentence of the server, by names. */
export type Arguments = Record<string, unknown>;

/** The pass that lets somebody into a closed world, or with an operator's rights. */
export interface Admission {
  way: "invitation" | "password" | "pass";
  secret: string;
}

/** The gestures of avatars, by name. */
export type GestureName = "wave" | "nod" | "point" | "clap" | "dance" | "raise_hand";

/** Whether each door stands open, by name. */
export type Doors = Record<string, boolean>;

export interface ScenePolygon {
  points: Point[];
  height_m: number;
  offset_m: number;
  kind: "building" | "floor" | "wall" | "furniture" | "plant" | "water";
  name: string;
  ramp: SceneRamp | null;
}

/** The top rises evenly from `start_height_m` at the start to the polygon's height at the end. */
export interface SceneRamp {
  start: Point;
  end: Point;
  start_height_m: number;
}

export interface SceneWall {
  start: Point;
  end: Point;
  offset_m: number;
  height_m: number;
}

/** From the middle of the foot to the middle of the head; solid below each tread. */
export interface SceneStairs {
  start: Point;
  end: Point;
  width_m: number;
  bottom_m: number;
  top_m: number;
  steps: number;
}

export interface SceneDoor extends SceneWall {
  name: string;
}

/** A point with a name; `z_m` says which floor: the nearest. */
export interface ScenePlace {
  name: string;
  position: Point;
  z_m: number;
}

/** An area in which people come in; `view` is the place that is shown to them first. */
export interface SceneSpawn {
  position: Point;
  z_m: number;
  radius_m: number;
  view?: Point | null;
}

/** An area of a floor from which one goes to another zone. */
export interface ScenePortal {
  name: string;
  points: Point[];
  z_m: number;
  /** The name of the zone that it leads to, and that of its scene, for people to read. */
  zone: string;
  title: string;
}

export interface SceneData {
  name: string;
  bounds: [x0: number, y0: number, x1: number, y1: number];
  polygons: ScenePolygon[];
  walls: SceneWall[];
  stairs: SceneStairs[];
  doors: SceneDoor[];
  places: ScenePlace[];
  /** Servers of before did not send them all with a view. */
  spawns?: SceneSpawn[];
  /** Heights of the storeys, metres, the lowest first. */
  storeys: number[];
  /** The portals; only a zone of a world of several has them. */
  portals?: ScenePortal[];
  /** The address of the triangles, relative to the page; only a building that is a mesh has one. */
  mesh?: string;
}

export interface Welcome {
  type: "welcome";
  /** The version that is spoken: the one that this client asked for. */
  version: number;
  id: number;
  name: string;
  resume: string;
  resumed: boolean;
  scene: SceneData;
  tick: number;
  tick_rate: number;
  server_time: number;
  /** The time for which the avatar waits for a client whose connection was lost. */
  resume_seconds: number;
  radius: number;
  /** Distance that a person's centre keeps from walls. */
  clearance: number;
  /** A barrier that hangs lower than this above the feet stops a person. */
  body_height: number;
  /** Greatest difference in height that a person steps up or down. */
  step_height: number;
  max_speed: number;
  /** Speed of a walk to a point, and of a walk in no hurry. */
  walk_speed: number;
  origin: Point;
  doors: Doors;
  operator: boolean;
}

/** One avatar as it comes into view. */
export interface EntityInfo {
  id: number;
  kind: Kind;
  name: string;
  layer: number;
  x: number;
  y: number;
  z: number;
  heading: number;
  radius: number;
  /** Length of a leg from hip to ankle. */
  leg_m: number;
  stature_m: number;
  /** The place that an actor which explains points at. */
  points_at: Place | null;
  /** The look that its person has chosen, if any. */
  look?: Look;
}

/** One avatar's record in a snapshot, in world coordinates. */
export interface EntityRecord {
  id: number;
  layer: number;
  reason: number;
  x: number;
  y: number;
  z: number;
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
  z: number;
  radius: number;
}

export interface PlanBlocker {
  kind: string;
  id: number | null;
  door: string | null;
  away: number | null;
}

export interface Plan {
  type: "plan";
  tick: number;
  id: number;
  reason: number;
  behaviour: string;
  goal: Place | null;
  /** Points (x, y, z, seconds from now). */
  path: [x: number, y: number, z: number, seconds: number][];
  people: PlanCircle[][];
  /** For how long the reason has been that. */
  since_s: number;
  /** The person, actor or door that holds the actor. */
  blocker: PlanBlocker | null;
  /** How its trip ended; null while it goes on, and without a goal. */
  outcome: number | null;
  /** The person, actor or door for which the trip did not end at the goal. */
  in_the_way: PlanBlocker | null;
  /** The tour of a guide. */
  tour?: PlanTour | null;
}

/** The tour on which a guide leads people. */
export interface PlanTour {
  /** Names of places; an empty one for a stop that has none. */
  stops: string[];
  /** The place among them of the stop to which it leads, or where it is. */
  next: number;
  /** The people who are being led. */
  followers: number[];
}

export interface ChatMessage {
  type: "chat";
  id: number;
  name: string;
  text: string;
  /** The number by which it can be hidden and reported. */
  line: number;
}

export type ServerMessage =
  | Welcome
  | Snapshot
  | Plan
  | ChatMessage
  | { type: "enter"; tick: number; entities: EntityInfo[] }
  | { type: "leave"; tick: number; ids: number[] }
  | { type: "notice"; notice: string; text: string; arguments: Arguments }
  | { type: "error"; error: string; text: string; arguments: Arguments }
  | { type: "bye"; reason: string; text: string; arguments: Arguments }
  /** Lines of chat that are to be shown no more. */
  | { type: "hide"; lines: number[] }
  | { type: "pong"; nonce: number; server_time: number }
  | { type: "census"; people: number; actors: number }
  | { type: "doors"; doors: Doors }
  /** Records of steps, see `unpackSteps`. */
  | { type: "steps"; tick: number; block: Uint8Array }
  /** An actor in view points at something from now on, or at nothing any more. */
  | { type: "point"; id: number; target: Place | null }
  /** An avatar in view has another body or look from now on. */
  | {
      type: "reshape";
      id: number;
      radius: number;
      leg_m: number;
      stature_m: number;
      look?: Look;
    }
  /** The person has come into another zone; the welcome of there follows. */
  | { type: "travel"; zone: string; portal: string }
  /** The person of an avatar in view is away from now on, or there again. */
  | { type: "away"; id: number; away: boolean }
  | { type: "gesture"; id: number; gesture: number };
