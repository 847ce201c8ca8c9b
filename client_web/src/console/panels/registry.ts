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
    open: false,
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
  {
    id: "presets",
    title: "Presets",
    right: "watch",
    tag: "esp-presets",
    area: "left",
    open: false,
    load: () => import("./presets"),
  },
  {
    id: "difference",
    title: "Differences",
    right: "watch",
    tag: "esp-difference",
    area: "bottom",
    open: false,
    load: () => import("./difference"),
  },
  {
    id: "groups",
    title: "Groups",
    right: "watch",
    tag: "esp-groups",
    area: "left",
    open: false,
    load: () => import("./groups"),
  },
  {
    id: "schedules",
    title: "Schedules",
    right: "watch",
    tag: "esp-schedules",
    area: "left",
    open: false,
    load: () => import("./schedules"),
  },
  {
    id: "actors",
    title: "Actors",
    right: "watch",
    tag: "esp-actors",
    area: "left",
    open: false,
    load: () => import("./actors/actors"),
  },
  {
    id: "world",
    title: "World",
    right: "watch",
    tag: "esp-world",
    area: "left",
    open: false,
    load: () => import("./world"),
  },
  {
    id: "series",
    title: "Series",
    right: "watch",
    tag: "esp-series",
    area: "bottom",
    open: true,
    load: () => import("./series/series"),
  },
  {
    id: "events",
    title: "Events",
    right: "watch",
    tag: "esp-events",
    area: "bottom",
    open: true,
    load: () => import("./events"),
  },
  {
    id: "changes",
    title: "Changes",
    right: "watch",
    tag: "esp-changes",
    area: "bottom",
    open: true,
    load: () => import("./changes"),
  },
  {
    id: "audit",
    title: "Audit",
    right: "audit",
    tag: "esp-audit",
    area: "bottom",
    open: false,
    load: () => import("./audit"),
  },
  {
    id: "people",
    title: "People",
    right: "watch",
    tag: "esp-people",
    area: "left",
    open: false,
    load: () => import("./people/people"),
  },
  {
    id: "chat",
    title: "Chat",
    right: "moderate",
    tag: "esp-chat",
    area: "right",
    open: false,
    load: () => import("./people/chat"),
  },
  {
    id: "reports",
    title: "Inbox",
    right: "moderate",
    tag: "esp-reports",
    area: "right",
    open: false,
    load: () => import("./people/reports"),
  },
  {
    id: "bans",
    title: "Bans",
    right: "moderate",
    tag: "esp-bans",
    area: "right",
    open: false,
    load: () => import("./people/bans"),
  },
  {
    id: "accounts",
    title: "Accounts",
    right: "accounts",
    tag: "esp-accounts",
    area: "left",
    open: false,
    load: () => import("./accounts/accounts"),
  },
  {
    id: "invitations",
    title: "Invitations",
    right: "moderate",
    tag: "esp-invitations",
    area: "left",
    open: false,
    load: () => import("./accounts/invitations"),
  },
  {
    id: "account",
    title: "My account",
    right: "watch",
    tag: "esp-account",
    area: "left",
    open: false,
    load: () => import("./accounts/account"),
  },
];

export function panelOf(id: string): PanelEntry | undefined {
  return PANELS.find((panel) => panel.id === id);
}
