/** The reason that the server states before it ends a connection. */

import type { ServerMessage } from "./messages";

type Last = Extract<ServerMessage, { type: "error" | "bye" }>;

export interface Stated {
  /** The moderator's own words, else the server's. */
  words: string;
  /** The end of a ban, seconds since 1970; null for one without an end, undefined without a ban. */
  bannedUntilS?: number | null;
}

export function stated(message: Last): Stated {
  const code = message.type === "error" ? message.error : message.reason;
  const { text, until_s: untilS } = message.arguments;
  const words = typeof text === "string" ? text : message.text;
  if (code !== "banned") return { words };
  return { words, bannedUntilS: typeof untilS === "number" ? untilS : null };
}
