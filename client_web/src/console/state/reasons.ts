/** Why actors do what they do: numbers of the wire, names, words for people, and colours. */

import type { ReasonName } from "../net/types";

/** In the order of their numbers. */
export const REASONS: readonly ReasonName[] = [
  "none",
  "moving",
  "giving_way",
  "waiting",
  "replanning",
  "no_path",
  "arrived",
];

const TEXTS: Readonly<Partial<Record<string, string>> & Record<ReasonName, string>> = {
  none: "nothing",
  moving: "moving",
  giving_way: "giving way",
  waiting: "waiting",
  replanning: "planning anew",
  no_path: "no path",
  arrived: "arrived",
};

type Pair = readonly [light: string, dark: string];
/** For light and dark ground; told apart without red and green too. */
const COLOURS: Readonly<Partial<Record<string, Pair>> & Record<ReasonName, Pair>> = {
  none: ["#6b7280", "#9ca3af"],
  moving: ["#0b6f67", "#5ecdc1"],
  giving_way: ["#a3266f", "#f5a3cf"],
  waiting: ["#a85a00", "#f0b45c"],
  replanning: ["#7a3fb0", "#cba6f7"],
  no_path: ["#b3261e", "#ff9c92"],
  arrived: ["#4b5a1e", "#b9cf7a"],
};

export function reasonName(number: number): ReasonName {
  return REASONS[number] ?? "none";
}

export function reasonText(reason: string): string {
  return TEXTS[reason] ?? reason.replaceAll("_", " ");
}

export function reasonColour(reason: string, dark: boolean): string {
  return (COLOURS[reason] ?? COLOURS.none)[dark ? 1 : 0];
}
