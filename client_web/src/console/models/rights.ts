/** The right that each command needs, as in the server's own table, which is what counts. */

import type { Right } from "../net/types";

export const COMMAND_RIGHTS: Readonly<Record<string, Right>> = {
  set_parameters: "parameters",
  clear_parameters: "parameters",
  apply_preset: "parameters",
  revert: "parameters",
  save_preset: "presets",
  delete_preset: "presets",
  set_group: "behaviours",
  set_behaviour: "behaviours",
  send_actor: "behaviours",
  hold_actor: "behaviours",
  add_actors: "actors",
  remove_actors: "actors",
  move_door: "doors",
  pace: "pace",
  record: "recordings",
  announce: "announce",
  warn: "moderate",
  mute: "moderate",
  kick: "moderate",
  ban: "moderate",
  unban: "moderate",
  walk_out: "moderate",
  hide_line: "moderate",
  slow_mode: "moderate",
  word_filter: "moderate",
  quiet_zone: "moderate",
  settle_report: "moderate",
  mark: "schedules",
  schedule: "schedules",
  cancel_schedule: "schedules",
};

const MEANING: Readonly<Record<string, string>> = {
  announce: "say something to people",
  moderate: "mute, kick and ban people",
  parameters: "change parameters",
  behaviours: "say where actors go",
  presets: "save presets",
  schedules: "schedule commands and mark moments",
  actors: "add and remove actors",
  doors: "open and close doors",
  pace: "pause the world or change its pace",
  recordings: "record the world",
  audit: "read the audit",
  accounts: "change accounts",
};

/** Why a command cannot be given with these rights; null if it can. */
export function whyNot(
  command: string,
  may: (right: string) => boolean,
  role: string,
): string | null {
  const right = COMMAND_RIGHTS[command] ?? command;
  if (may(right)) return null;
  return `The role ${role} may not ${MEANING[right] ?? right}.`;
}
