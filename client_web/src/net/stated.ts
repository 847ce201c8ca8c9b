/** The reason that the server states before it ends a connection, in words for the person. */

import type { ServerMessage } from "./messages";

type Ending = Extract<ServerMessage, { type: "error" | "bye" }>;

/** `locale` is that of the browser unless a test says otherwise. */
export function stated(message: Ending, locale?: string): string {
  const code = message.type === "error" ? message.error : message.reason;
  const { text, until_s: untilS } = message.arguments;
  const words = typeof text === "string" ? text : message.text;
  if (code !== "banned") return words;
  if (typeof untilS !== "number") return `${words} No end is set.`;
  const end = new Date(untilS * 1000);
  const when = end.toLocaleString(locale, { dateStyle: "medium", timeStyle: "short" });
  return `${words} You may come back after ${when}.`;
}
