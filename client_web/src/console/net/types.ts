/** Messages of the interface for operators; a test holds them against the server's schema. */

export const RIGHTS = [
  "watch",
  "announce",
  "moderate",
  "parameters",
  "behaviours",
  "presets",
  "schedules",
  "experiments",
  "actors",
  "doors",
  "pace",
  "recordings",
  "audit",
  "accounts",
] as const;
export type Right = (typeof RIGHTS)[number];

export interface Me {
  account: string;
  role: string;
  rights: readonly Right[];
  via: "session" | "token";
}

export interface Fault {
  code: string;
  /** A sentence for people. */
  text: string;
  /** Where in what was sent. */
  path?: readonly (string | number)[];
  arguments?: Readonly<Record<string, unknown>>;
}

export type Point = readonly [x: number, y: number, z: number];

/** A zone of the world; the interface of another one is behind `/api/v1/zones/NAME`. */
export interface ZoneFacts {
  name: string;
  scene: string;
  people: number;
  actors: number;
}

export interface Zones {
  here: string;
  zones: readonly ZoneFacts[];
}

export interface Recording {
  state: "on" | "off" | "failed";
  file: string | null;
  bytes: number;
  /** Of the world, as far as they are written. */
  seconds: number;
  /** Why it has ended, where it has failed. */
  fault: string | null;
}

export interface World {
  zone: string;
  scene: string;
  bounds: readonly [number, number, number, number];
  tick: number;
  tick_s: number;
  people: number;
  actors: number;
  most_actors: number;
  commands_waiting: number;
  doors: Readonly<Record<string, boolean>>;
  places: Readonly<Record<string, Point>>;
  revision: number;
  pace?: { factor: number; paused: boolean };
  /** Null where the server has no folder for recordings. */
  recording?: Recording | null;
  /** Ticks from one planning of an actor to its next. */
  planning_interval_ticks?: number;
}

export type ReasonName =
  "none" | "moving" | "giving_way" | "waiting" | "replanning" | "no_path" | "arrived";

export interface Actor {
  id: string;
  name: string;
  tags: readonly string[];
  behaviour: string;
  held: boolean;
  avatar: number | null;
  position?: Point;
  heading_rad?: number;
  speed_mps?: number;
  reason?: ReasonName;
}

export interface Actors {
  tick: number;
  revision: number;
  actors: readonly Actor[];
}

/** The person or thing that holds an actor. */
export interface Blocker {
  kind: string;
  id: number | string | null;
  name?: string;
  away_m: number;
}

/** An effective value, and the scope that it comes from. */
export interface Source {
  value: unknown;
  level: "default" | "world" | "group" | "own";
  /** The group, where it comes from one. */
  group: string | null;
}

export interface ActorDetails extends Omit<Actor, "behaviour"> {
  tick: number;
  revision: number;
  behaviour: Readonly<Record<string, unknown>> & { kind: string };
  parameters: Readonly<Record<string, Source>>;
  since_s?: number;
  goal?: Point | null;
  blocker?: Blocker | null;
  outcome?: string | null;
  in_the_way?: Blocker | null;
}

export interface Command {
  op: string;
  note?: string;
  dry_run?: boolean;
  [field: string]: unknown;
}

export interface Answer {
  op: string;
  command: number | string | null;
  tick: number | null;
  revision: number;
  before: unknown;
  after: unknown;
  price: string | null;
  prepare_s?: number;
  shadowed?: readonly string[];
  faults: readonly Fault[];
}

export interface DoorPlace {
  name: string;
  x0: number;
  y0: number;
  x1: number;
  y1: number;
  z_m: number;
  open: boolean;
}

export type Ring = readonly (readonly [x: number, y: number])[];

/** The part of the world that never moves, and the doors. */
export interface MapData {
  scene: string;
  origin_m: readonly [number, number];
  bounds: readonly [number, number, number, number];
  storeys: readonly { z_m: number; name: string }[];
  /** Both ends, and the heights of foot and top. */
  walls: readonly (readonly [number, number, number, number, number, number])[];
  doors: readonly DoorPlace[];
  places: readonly { name: string; x: number; y: number; z: number }[];
  /** For each storey the rings of what stands in the way on it. */
  outlines?: readonly (readonly Ring[])[];
  /** The kinds of the same: furniture, plant, water… */
  kinds?: readonly (readonly string[])[];
  /** For each storey the rings of what one walks on. */
  floors?: readonly (readonly Ring[])[];
}

/** Values in the cells of a storey; rows go from south to north. */
export interface Raster {
  width: number;
  height: number;
  cell_m: number;
  origin_m: readonly [number, number];
  /** float32, little-endian, in base64. */
  values: string;
}

export interface Heat {
  storeys: readonly (Raster & { z_m: number })[];
}

/** A time for which an actor did the same for the same reason. */
export interface WhySpan {
  from_tick: number;
  to_tick: number;
  reason: string;
  blocker: Blocker | null;
  seconds: number;
}

/** A tick, and when it was: microseconds since 1970. */
export type Moment = readonly [tick: number, atUs: number];

/** An actor's doings and its reasons; between two of the moments time passed evenly. */
export interface Why {
  spans: readonly WhySpan[];
  moments: readonly Moment[];
}

/** The parts of the cost of a path, in seconds of walking; null for what has no end. */
export interface Cost {
  time: number | null;
  risk: number | null;
  others: number | null;
  turn: number | null;
  wall: number | null;
  hurry: number | null;
  keep_right: number | null;
  total: number | null;
}

export type PathPoint = readonly [x: number, y: number, z: number, t_s: number];

/** A path, and what it was thought to cost. */
export interface PricedPath {
  path: readonly PathPoint[];
  cost: Cost;
  mean_risk: number;
  legal: boolean;
}

/** The last decision of an actor, made once more. */
export interface Trace {
  actor: string;
  tick: number;
  /** Whether it came out the very same. */
  exact: boolean;
  status: string;
  expansions: number;
  budget: number;
  /** x, y, z, seconds ahead, the node before, cost, and when it was expanded (-1: never). */
  nodes: readonly (readonly [number, number, number, number, number, number, number])[];
  left_out: number;
  path: readonly PathPoint[];
  cost: Cost;
  previous: PricedPath | null;
  searched: PricedPath | null;
  perturbed: PricedPath | null;
  why: { code: string; text: string; arguments: Readonly<Record<string, number | null>> };
  risk: readonly (Raster & { t_s: number })[];
  blocker: Blocker | null;
}
