/**
 * The protocol of Esplanade for programs in JavaScript: frames to messages and back, the avatars of
 * snapshots, and the walking steps with their poses. It is the code that the page itself runs.
 */

export {
  ClientCode,
  CloseCode,
  Gesture,
  GESTURE_NAMES,
  MAX_CHAT_CHARS,
  MAX_NAME_CHARS,
  OLDEST_VERSION,
  Outcome,
  Reason,
  ServerCode,
  VERSION,
} from "../src/net/codes";
export type { Kind } from "../src/net/codes";
export { decodeServer, encodeClient, isSpoken, unpackBlock } from "../src/net/codec";
export { WireError } from "../src/net/errors";
export type * from "../src/net/messages";
export { KEY_NUMBERS, KeyNumber, STEP_KEYS, unpackSteps } from "../src/net/steps";
export type { Footprint, StepRecord } from "../src/net/steps";
