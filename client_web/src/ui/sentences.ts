/** Sentences for people, made from the codes and arguments of the server in this page's words. */

import type { Arguments, ServerMessage, Welcome } from "../net/messages";

type Fault = Extract<ServerMessage, { type: "error" }>;
type Notice = Extract<ServerMessage, { type: "notice" }>;

export interface Saying {
  head: string;
  /** The moderator's own words. */
  words: string;
}

/** The head line for a notice of moderators; null for notices of something else. */
export function noticeOf({ notice, text, arguments: given }: Notice): Saying | null {
  const words = textOf(given) ?? text;
  switch (notice) {
    case "announcement":
      return { head: "Announcement", words };
    case "muted":
      return { head: `You are muted for ${spanOf(numberOf(given, "seconds") ?? 0)}.`, words };
    case "unmuted":
      return { head: "You are heard again.", words };
    case "warned":
      return { head: "A moderator warns you.", words };
    case "walked_out":
      return { head: "You are being walked to the way out.", words };
    case "report_taken":
      return {
        head: "Thank you.",
        words: "The people who look after this place can read your report now.",
      };
    case "not_let_in":
      return {
        head: "You are not let in there just now.",
        words: `${textOf(given, "why") ?? words}.`,
      };
    default:
      return null;
  }
}

/** The meaning of a fault, as far as this page has words of its own for it. */
export function faultOf({ error, text, arguments: given }: Fault): string {
  const seconds = numberOf(given, "seconds");
  switch (error) {
    case "muted":
      return `Nobody heard that: you are muted for ${spanOf(seconds ?? 0)} more.`;
    case "slow_mode":
      return `Nobody heard that: it is slow mode, so wait for ${spanOf(seconds ?? 0)}.`;
    case "word_refused":
      return "Nobody heard that: there is a word in it that is not said here.";
    case "quiet_zone": {
      const name = typeof given["name"] === "string" ? ` (${given["name"]})` : "";
      return `Nobody heard that: where you stand it is quiet${name}.`;
    }
    default:
      return `The server says: ${text}.`;
  }
}

/** A length of time in words, such as "9:58 minutes". */
export function spanOf(seconds: number): string {
  const whole = Math.max(0, Math.ceil(seconds));
  if (whole < 60) return counted(whole, 0, "second");
  if (whole < 3600) return counted(Math.floor(whole / 60), whole % 60, "minute");
  return counted(Math.floor(whole / 3600), Math.floor((whole % 3600) / 60), "hour");
}

/** A number of units and of sixtieths of them. */
function counted(number: number, sixtieths: number, unit: string): string {
  if (sixtieths > 0) return `${number}:${two(sixtieths)} ${unit}s`;
  return number === 1 ? `1 ${unit}` : `${number} ${unit}s`;
}

function two(number: number): string {
  return String(number).padStart(2, "0");
}

function numberOf(given: Arguments, name: string): number | null {
  const value = given[name];
  return typeof value === "number" ? value : null;
}

function textOf(given: Arguments, name = "text"): string | null {
  const value = given[name];
  return typeof value === "string" ? value : null;
}

/** The first line for somebody who comes in. */
export function greetingOf({ name, resumed }: Welcome): string {
  return resumed ? `Welcome back, ${name}.` : `Welcome, ${name}. See Help for how to get about.`;
}

/** The first line in another zone. */
export function arrivalIn({ scene }: Welcome): string {
  return `You have come to ${scene.name}.`;
}
