/** Where the panels stand: a plain document, which is stored, exported and put into links. */

import { type Area, PANELS, type PanelEntry } from "../panels/registry";

export const AREAS = ["left", "centre", "right", "bottom"] as const satisfies readonly Area[];

export interface AreaLayout {
  readonly panels: readonly string[];
  readonly active: string | null;
  /** Width, or height at the bottom, in pixels; the centre takes what is left. */
  readonly size: number;
}

export interface Layout {
  readonly version: 1;
  readonly areas: Readonly<Record<Area, AreaLayout>>;
}

export const LEAST_PX = 140;
const MOST_PX = 2000;
const USUAL_PX: Readonly<Record<Area, number>> = { left: 320, centre: 0, right: 340, bottom: 240 };

export function usualLayout(panels: readonly PanelEntry[] = PANELS): Layout {
  const area = (name: Area): AreaLayout => {
    const ids = panels.filter((panel) => panel.open && panel.area === name).map(({ id }) => id);
    return { panels: ids, active: ids[0] ?? null, size: USUAL_PX[name] };
  };
  return withAreas((name) => area(name));
}

/** The area that holds a panel; undefined where it is shut. */
export function areaOf(layout: Layout, panel: string): Area | undefined {
  return AREAS.find((name) => layout.areas[name].panels.includes(panel));
}

/** Bring a panel to the front, where it stands or else where it belongs. */
export function shown(layout: Layout, { id, area }: Pick<PanelEntry, "id" | "area">): Layout {
  const at = areaOf(layout, id);
  return at ? changed(layout, at, { active: id }) : moved(layout, id, area);
}

export function shut(layout: Layout, panel: string): Layout {
  const at = areaOf(layout, panel);
  if (!at) return layout;
  const before = layout.areas[at];
  const panels = before.panels.filter((id) => id !== panel);
  const next = panels[Math.min(before.panels.indexOf(panel), panels.length - 1)] ?? null;
  return changed(layout, at, { panels, active: before.active === panel ? next : before.active });
}

/** Put a panel into an area as its last tab, and show it. */
export function moved(layout: Layout, panel: string, to: Area): Layout {
  const without = shut(layout, panel);
  const panels = [...without.areas[to].panels, panel];
  return changed(without, to, { panels, active: panel });
}

export function resized(layout: Layout, area: Area, size: number): Layout {
  return changed(layout, area, { size: Math.round(Math.max(LEAST_PX, Math.min(MOST_PX, size))) });
}

/**
 * A layout from a text that may come from anywhere. Panels that this page does not know are left
 * out; null for what is no layout at all.
 */
export function readLayout(text: string, panels: readonly PanelEntry[] = PANELS): Layout | null {
  let given: unknown;
  try {
    given = JSON.parse(text);
  } catch {
    return null;
  }
  const areas = field(given, "areas");
  if (field(given, "version") !== 1 || typeof areas !== "object" || areas === null) return null;
  const known = new Set(panels.map(({ id }) => id));
  return withAreas((name) => {
    const found = field(areas, name);
    const ids = field(found, "panels");
    const kept = (Array.isArray(ids) ? (ids as unknown[]) : []).filter(
      // A panel stands in one place only.
      (id): id is string => typeof id === "string" && known.delete(id),
    );
    const active = field(found, "active");
    const size = field(found, "size");
    return {
      panels: kept,
      active: kept.find((id) => id === active) ?? kept[0] ?? null,
      size: typeof size === "number" && size >= LEAST_PX && size <= MOST_PX ? size : USUAL_PX[name],
    };
  });
}

export function writeLayout(layout: Layout): string {
  return JSON.stringify(layout);
}

function changed(layout: Layout, area: Area, change: Partial<AreaLayout>): Layout {
  return { ...layout, areas: { ...layout.areas, [area]: { ...layout.areas[area], ...change } } };
}

function withAreas(make: (name: Area) => AreaLayout): Layout {
  const [left, centre, right, bottom] = [
    make("left"),
    make("centre"),
    make("right"),
    make("bottom"),
  ];
  return { version: 1, areas: { left, centre, right, bottom } };
}

function field(of: unknown, name: string): unknown {
  return typeof of === "object" && of !== null ? (of as Record<string, unknown>)[name] : undefined;
}
