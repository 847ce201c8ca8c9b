/**
 * Messages to frames and back: `[code, fields]`, and flat ones, the snapshot
 * `[67, tick, ack, block]` and steps `[76, tick, block]`.
 */

import { decode, encode as pack } from "@msgpack/msgpack";
import { ClientCode, OLDEST_VERSION, ServerCode, VERSION } from "./codes";
import { WireError } from "./errors";
import type { ClientMessage, EntityRecord, Point, ServerMessage } from "./messages";
import { readRecord, RECORD_BYTES } from "./records";

const CLIENT_CODES: Record<ClientMessage["type"], number> = {
  hello: ClientCode.HELLO,
  move: ClientCode.MOVE,
  walk_to: ClientCode.WALK_TO,
  chat: ClientCode.CHAT,
  ping: ClientCode.PING,
  watch: ClientCode.WATCH,
  set_door: ClientCode.SET_DOOR,
  report: ClientCode.REPORT,
  mute: ClientCode.MUTE,
  presence: ClientCode.PRESENCE,
  gesture: ClientCode.GESTURE,
  look: ClientCode.LOOK,
};

const SERVER_TYPES = new Map<unknown, ServerMessage["type"]>([
  [ServerCode.WELCOME, "welcome"],
  [ServerCode.ENTER, "enter"],
  [ServerCode.LEAVE, "leave"],
  [ServerCode.CHAT, "chat"],
  [ServerCode.NOTICE, "notice"],
  [ServerCode.ERROR, "error"],
  [ServerCode.BYE, "bye"],
  [ServerCode.PONG, "pong"],
  [ServerCode.PLAN, "plan"],
  [ServerCode.CENSUS, "census"],
  [ServerCode.DOORS, "doors"],
  [ServerCode.POINT, "point"],
  [ServerCode.RESHAPE, "reshape"],
  [ServerCode.HIDE, "hide"],
  [ServerCode.TRAVEL, "travel"],
  [ServerCode.AWAY, "away"],
  [ServerCode.GESTURE, "gesture"],
]);

/** The version of the protocol that brought a message; all others were there from the beginning. */
const SINCE = new Map<ClientMessage["type"], number>([
  ["presence", 5],
  ["gesture", 5],
  ["look", 6],
]);

/** Fields that servers before them do not send. */
const ADDED = new Map<ServerMessage["type"], object>([
  ["chat", { line: 0 }],
  ["notice", { notice: "", arguments: {} }],
  ["error", { arguments: {} }],
  ["bye", { arguments: {} }],
]);

/** Whether a server that speaks this version knows such a message. */
export function isSpoken(type: ClientMessage["type"], version: number): boolean {
  return version >= (SINCE.get(type) ?? OLDEST_VERSION);
}

/**
 * A frame; the version is the one that a hello asks for. A server that knows no looks would refuse
 * a hello with one.
 */
export function encodeClient(message: ClientMessage, version = VERSION): Uint8Array<ArrayBuffer> {
  if (message.type === "hello") {
    const { type, look, ...fields } = message;
    const looks = look && isSpoken("look", version) ? { look } : {};
    return pack([CLIENT_CODES[type], { ...fields, ...looks, version, at: null }]);
  }
  const { type, ...fields } = message;
  return pack([CLIENT_CODES[type], fields]);
}

/**
 * The message of a frame; null for a code that this client does not know, so that the server may
 * learn new ones.
 *
 * The fields are those of our own server, whose models check them; they are not checked again.
 */
export function decodeServer(frame: ArrayBuffer | Uint8Array): ServerMessage | null {
  const parts = unpack(frame);
  const [code, ...rest] = parts;
  if (code === ServerCode.SNAPSHOT) {
    const [tick, ack, block] = rest;
    if (typeof tick !== "number" || typeof ack !== "number" || !(block instanceof Uint8Array)) {
      throw new WireError("a snapshot is [67, tick, ack, block]");
    }
    return { type: "snapshot", tick, ack, block };
  }
  if (code === ServerCode.STEPS) {
    const [tick, block] = rest;
    if (typeof tick !== "number" || !(block instanceof Uint8Array)) {
      throw new WireError("steps are [76, tick, block]");
    }
    return { type: "steps", tick, block };
  }
  const type = SERVER_TYPES.get(code);
  if (type === undefined) return null;
  const fields: unknown = rest[0];
  if (typeof fields !== "object" || fields === null) {
    throw new WireError(`${type}: the fields are no map`);
  }
  return { ...ADDED.get(type), ...fields, type } as ServerMessage;
}

/** The records of a snapshot's block (see `protocol/snapshot.py`), in world coordinates. */
export function unpackBlock(block: Uint8Array, origin: Point): EntityRecord[] {
  if (block.byteLength % RECORD_BYTES !== 0) {
    throw new WireError(`a block of ${block.byteLength} bytes is no multiple of ${RECORD_BYTES}`);
  }
  const view = new DataView(block.buffer, block.byteOffset, block.byteLength);
  const records: EntityRecord[] = [];
  for (let at = 0; at < block.byteLength; at += RECORD_BYTES) {
    records.push(readRecord(view, at, origin));
  }
  return records;
}

function unpack(frame: ArrayBuffer | Uint8Array): unknown[] {
  let parts: unknown;
  try {
    parts = decode(frame);
  } catch (error) {
    throw new WireError(`not msgpack: ${String(error)}`);
  }
  if (!Array.isArray(parts)) throw new WireError("a frame is a msgpack array");
  return parts;
}
