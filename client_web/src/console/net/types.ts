/** What the interface for operators sends and is sent; a test holds it against the server's schema. */

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

/** Who or what holds an actor. */
export interface Blocker {
  kind: string;
  id: number | string | null;
  name?: string;
  away_m: number;
}

/** An effective value, and the scope that it comes from. */
export interface Source {
  value: unknown;
  source: string;
}

export interface ActorDetails extends Omit<Actor, "behaviour"> {
  tick: number;
  revision: number;
  behaviour: Readonly<Record<string, unknown>> & { kind: string };
  parameters: Readonly<Record<string, Source>>;
  since_s?: number;
  goal?: Point | null;
  blocker?: Blocker | null;
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
