/** Sentences for people, made from the codes and arguments of the server. */

import type { MoveReason } from "../language/arguments";
import { english } from "../language/english";
import type { Wording } from "../language/phrase";
import { words } from "../language/words";
import type { Ending, EndingCause } from "../net/closing";
import type { Arguments, ServerMessage, Welcome } from "../net/messages";
import type { Stated } from "../net/stated";

type Fault = Extract<ServerMessage, { type: "error" }>;
type Notice = Extract<ServerMessage, { type: "notice" }>;

export interface Saying {
  head: Wording;
  /** The moderator's own words, as they wrote them. */
  words: Wording;
}

/** The head line for a notice of moderators; null for notices of something else. */
export function noticeOf({ notice, text, arguments: given }: Notice): Saying | null {
  const own = textOf(given) ?? text;
  const { notices } = words;
  switch (notice) {
    case "announcement":
      return { head: notices.announcement, words: own };
    case "muted":
      return { head: notices.muted(numberOf(given, "seconds") ?? 0), words: own };
    case "unmuted":
      return { head: notices.unmuted, words: own };
    case "warned":
      return { head: notices.warned, words: own };
    case "walked_out":
      return { head: notices.walkedOut, words: own };
    case "report_taken":
      return { head: notices.reportTaken, words: notices.reportRead };
    case "not_let_in":
      return { head: notices.notLetIn, words: notices.notLetInWhy(textOf(given, "why") ?? own) };
    default:
      return null;
  }
}

/** The sentence of a notice that nobody wrote: in this page's words as far as it has any. */
export function remarkOf({ notice, text, arguments: given }: Notice): Wording {
  return (notice === "goal_moved" ? movedOf(given) : null) ?? text;
}

/** The meaning of a notice of the world's pace; a place that does not answer stands still too. */
export function paceOf({ notice, arguments: given }: Notice): Wording {
  const { notices } = words;
  const factor = numberOf(given, "factor") ?? 1;
  const rate = numberOf(given, "rate") ?? factor;
  const silent = given["silent"] === true;
  if (notice === "paused") return silent ? notices.silent : notices.paused;
  if (silent) return notices.heard;
  if (factor === 1) return notice === "resumed" ? notices.resumed : notices.usual;
  if (rate < factor) return notices.behind(factor, rate);
  return factor < 1 ? notices.slow(factor) : notices.quick(factor);
}

/** The meaning of a fault, as far as this page has words of its own for it. */
export function faultOf({ error, text, arguments: given }: Fault): Wording {
  const seconds = numberOf(given, "seconds") ?? 0;
  const { faults } = words;
  switch (error) {
    case "muted":
      return faults.muted(seconds);
    case "slow_mode":
      return faults.slowMode(seconds);
    case "word_refused":
      return faults.wordRefused;
    case "quiet_zone":
      return faults.quietZone(textOf(given, "name"));
    case "no_path":
      return faults.noPath;
    case "forbidden":
      return faults.forbidden;
    case "lease_ended":
      return faults.leaseEnded;
    default:
      return faults.other(text);
  }
}

/** The causes of which the page's own sentence does not say all that the server says. */
const UNTOLD: ReadonlySet<EndingCause> = new Set([
  "invalid",
  "admissionRefused",
  "banned",
  "kicked",
  "unreadable",
]);

/** The reason for which a connection ended. */
export function endingOf({ cause, stated }: Ending): Wording {
  const ending = words.endings[cause];
  if (stated === null || !UNTOLD.has(cause) || stated.words === english.endings[cause]) {
    return ending;
  }
  return words.endingSaid(ending, saidOf(stated));
}

function saidOf({ words: said, bannedUntilS }: Stated): Wording {
  if (bannedUntilS === undefined) return said;
  if (bannedUntilS === null) return words.bannedForGood(said);
  return words.bannedUntil(said, new Date(bannedUntilS * 1000));
}

function movedOf(given: Arguments): Wording | null {
  const [why, movedM] = [textOf(given, "why"), numberOf(given, "moved")];
  return isMoveReason(why) && movedM !== null ? words.notices.goalMoved(why, movedM) : null;
}

function isMoveReason(why: string | null): why is MoveReason {
  return why !== null && ["inside_wall", "near_wall", "no_ground", "other_region"].includes(why);
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
export function greetingOf({ name, resumed }: Welcome): Wording {
  return resumed ? words.chat.welcomeBack(name) : words.chat.welcome(name);
}

/** The first line in another zone. */
export function arrivalIn({ scene }: Welcome): Wording {
  return words.chat.arrived(scene.name);
}
