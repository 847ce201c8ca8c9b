/** The numbers and names on the wire; the same table as `protocol/codes.py`. */

import type { GestureName } from "./messages";

export const VERSION = 6;
/** The oldest version that this client falls back on. */
export const OLDEST_VERSION = 4;

export const MAX_NAME_CHARS = 32;
export const MAX_CHAT_CHARS = 300;

export const ClientCode = {
  HELLO: 1,
  MOVE: 2,
  WALK_TO: 3,
  CHAT: 4,
  PING: 5,
  WATCH: 6,
  SET_DOOR: 7,
  REPORT: 8,
  MUTE: 9,
  PRESENCE: 10,
  GESTURE: 11,
  LOOK: 12,
} as const;

export const ServerCode = {
  WELCOME: 64,
  ENTER: 65,
  LEAVE: 66,
  SNAPSHOT: 67,
  CHAT: 68,
  NOTICE: 69,
  ERROR: 70,
  BYE: 71,
  PONG: 72,
  PLAN: 73,
  CENSUS: 74,
  DOORS: 75,
  STEPS: 76,
  POINT: 77,
  RESHAPE: 78,
  HIDE: 79,
  TRAVEL: 80,
  AWAY: 81,
  GESTURE: 82,
} as const;

export const Reason = {
  NONE: 0,
  MOVING: 1,
  GIVING_WAY: 2,
  WAITING: 3,
  REPLANNING: 4,
  NO_PATH: 5,
  ARRIVED: 6,
} as const;

/** The gestures of avatars. */
export const Gesture = {
  WAVE: 1,
  NOD: 2,
  POINT: 3,
  CLAP: 4,
  DANCE: 5,
  RAISE_HAND: 6,
} as const;

/** The names of gestures by their numbers; a server may know more of them. */
export const GESTURE_NAMES = new Map<number, GestureName>(
  Object.entries(Gesture).map(([name, number]) => [number, name.toLowerCase() as GestureName]),
);

/** How the trip of an actor ended. */
export const Outcome = {
  ARRIVED: 1,
  NEAR: 2,
  BLOCKED: 3,
  NO_WAY: 4,
} as const;

export const CloseCode = {
  NORMAL: 1000,
  GOING_AWAY: 1001,
  TOO_LARGE: 1009,
  BUSY: 1013,
  UNSUPPORTED_VERSION: 4001,
  MALFORMED: 4002,
  INVALID: 4003,
  FLOODING: 4004,
  HELLO_EXPECTED: 4005,
  HELLO_TIMEOUT: 4006,
  SERVER_FULL: 4007,
  TOO_SLOW: 4008,
  REPLACED: 4009,
  SILENT: 4010,
  NAME_RESERVED: 4011,
  KICKED: 4012,
  ADMISSION_NEEDED: 4020,
  PASSWORD_NEEDED: 4021,
  ADMISSION_REFUSED: 4022,
  BANNED: 4013,
} as const;

export type Kind = "person" | "actor";
