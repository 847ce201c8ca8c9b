/** The meaning of a connection's end: a sentence for the person, and whether to connect again. */

import { CloseCode } from "./codes";

export interface Closing {
  text: string;
  retry: boolean;
}

const CLOSINGS = new Map<number, Closing>([
  [CloseCode.NORMAL, { text: "The server ended the connection.", retry: true }],
  [CloseCode.GOING_AWAY, { text: "The server is going down for a moment.", retry: true }],
  [CloseCode.TOO_LARGE, { text: "This page sent a message that is too large.", retry: true }],
  [CloseCode.BUSY, { text: "The place does not answer just now.", retry: true }],
  [
    CloseCode.UNSUPPORTED_VERSION,
    { text: "The server speaks another version. Please reload this page.", retry: false },
  ],
  [CloseCode.MALFORMED, { text: "The server could not read a message of ours.", retry: true }],
  [CloseCode.INVALID, { text: "The server refused what this page sent.", retry: false }],
  [CloseCode.FLOODING, { text: "Too many messages in too short a time.", retry: true }],
  [CloseCode.HELLO_EXPECTED, { text: "The server did not get our greeting.", retry: true }],
  [CloseCode.HELLO_TIMEOUT, { text: "Our greeting came too late.", retry: true }],
  [CloseCode.SERVER_FULL, { text: "The place is full. Please try again later.", retry: false }],
  [CloseCode.TOO_SLOW, { text: "This connection is too slow to follow the world.", retry: true }],
  [
    CloseCode.REPLACED,
    { text: "Your avatar went on in another window. This one is at rest.", retry: false },
  ],
  [CloseCode.SILENT, { text: "Nothing came from this page for a while.", retry: true }],
  [CloseCode.NAME_RESERVED, { text: "That name cannot be had here.", retry: false }],
  [CloseCode.ADMISSION_NEEDED, { text: "Not everybody can come in here.", retry: false }],
  [CloseCode.PASSWORD_NEEDED, { text: "Not everybody can come in here.", retry: false }],
  [CloseCode.ADMISSION_REFUSED, { text: "You were not let in.", retry: false }],
  [CloseCode.BANNED, { text: "You cannot come in here.", retry: false }],
  [CloseCode.KICKED, { text: "An operator has asked you to leave.", retry: false }],
]);

/** `stated` is what the server said before it closed (an error or a bye), if anything. */
export function closing(code: number, stated: string | null): Closing {
  const known = CLOSINGS.get(code) ?? { text: "The connection was lost.", retry: true };
  if (stated === known.text) return known;
  return known.retry || stated === null ? known : { ...known, text: `${known.text} (${stated})` };
}
