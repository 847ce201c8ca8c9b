/** All panels of the page. A new one needs a row here, and nothing else. */

import type { Right } from "../net/types";

/** Where a panel stands until somebody moves it. */
export type Area = "left" | "centre" | "right" | "bottom";

export interface PanelEntry {
  id: string;
  title: string;
  /** Without this right the panel is not offered. */
  right: Right;
  tag: `esp-${string}`;
  area: Area;
  /** Whether it is there when the page is opened for the first time. */
  open: boolean;
  /** Brings the element; it is called once, when the panel is first shown. */
  load: () => Promise<unknown>;
}

export const PANELS: readonly PanelEntry[] = [
  {
    id: "everybody",
    title: "Everybody",
    right: "watch",
    tag: "esp-everybody",
    area: "left",
    open: true,
    load: () => import("../everybody/everybody"),
  },
  {
    id: "map",
    title: "Map",
    right: "watch",
    tag: "esp-map",
    area: "centre",
    open: true,
    load: () => import("../map/map"),
  },
  {
    id: "inspector",
    title: "Inspector",
    right: "watch",
    tag: "esp-inspector",
    area: "right",
    open: true,
    load: () => import("../inspector/inspector"),
  },
  {
    id: "connection",
    title: "Connection",
    right: "watch",
    tag: "esp-connection",
    area: "bottom",
    open: true,
    load: () => import("./connection"),
  },
  {
    id: "parameters",
    title: "Parameters",
    right: "watch",
    tag: "esp-parameters",
    area: "left",
    open: true,
    load: () => import("./parameters/parameters"),
  },
];

export function panelOf(id: string): PanelEntry | undefined {
  return PANELS.find((panel) => panel.id === id);
}
