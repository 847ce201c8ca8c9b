import { describe, expect, it } from "vitest";
import { LayoutStore } from "../../../src/console/layout/keeping";
import {
  areaOf,
  type Layout,
  moved,
  readLayout,
  resized,
  shown,
  shut,
  usualLayout,
  writeLayout,
} from "../../../src/console/layout/layout";
import type { Area, PanelEntry } from "../../../src/console/panels/registry";

const panel = (id: string, area: Area, open = true): PanelEntry => ({
  id,
  title: id,
  right: "watch",
  tag: `esp-${id}`,
  area,
  open,
  load: () => Promise.resolve(),
});
const PANELS = [panel("list", "left"), panel("map", "centre"), panel("log", "bottom", false)];
const usual: Layout = usualLayout(PANELS);

describe("Layout", () => {
  it("begins with the panels that are open at first", () => {
    expect(usual.areas.left.panels).toEqual(["list"]);
    expect(usual.areas.bottom).toMatchObject({ panels: [], active: null });
  });

  it("opens a panel where it belongs, and shuts it again", () => {
    const open = shown(usual, { id: "log", area: "bottom" });
    expect(areaOf(open, "log")).toBe("bottom");
    expect(shut(open, "log")).toEqual(usual);
  });

  it("moves a panel to a tab of another area", () => {
    const two = moved(usual, "list", "centre");
    expect(two.areas.centre).toMatchObject({ panels: ["map", "list"], active: "list" });
    expect(two.areas.left).toMatchObject({ panels: [], active: null });
    expect(shown(two, { id: "map", area: "centre" }).areas.centre.active).toBe("map");
    expect(shut(two, "list").areas.centre.active).toBe("map");
  });

  it("keeps areas within a size that can be seen", () => {
    expect(resized(usual, "left", 3).areas.left.size).toBe(140);
    expect(resized(usual, "left", 1e9).areas.left.size).toBe(2000);
  });

  it("comes back as it was written", () => {
    const layout = resized(moved(usual, "log", "right"), "right", 411);
    expect(readLayout(writeLayout(layout), PANELS)).toEqual(layout);
  });

  it("takes what it can use of a strange one, each panel once", () => {
    const strange = {
      version: 1,
      areas: {
        left: { panels: ["map", "gone", 7, "map"], active: "gone", size: "wide" },
        right: { panels: ["map", "list"], active: "list", size: 300 },
      },
    };
    const layout = readLayout(JSON.stringify(strange), PANELS);
    expect(layout?.areas.left).toEqual({ panels: ["map"], active: "map", size: 320 });
    expect(layout?.areas.right).toEqual({ panels: ["list"], active: "list", size: 300 });
    for (const text of ["", "[]", "null", '{"version":2,"areas":{}}', '{"version":1}']) {
      expect(readLayout(text, PANELS)).toBeNull();
    }
  });
});

describe("LayoutStore", () => {
  it("keeps the layout of each account", () => {
    const kept = new Map<string, string>();
    const store = new LayoutStore({
      getItem: (key) => kept.get(key) ?? null,
      setItem: (key, value) => kept.set(key, value),
    });
    const layout = resized(usualLayout(), "right", 500);
    store.write("olga", layout);
    expect(store.read("olga")).toEqual(layout);
    expect(store.read("paul")).toEqual(usualLayout());
  });

  it("does without a store that is forbidden", () => {
    const forbidden = () => {
      throw new Error("SecurityError");
    };
    const store = new LayoutStore({ getItem: forbidden, setItem: forbidden });
    store.write("olga", usual);
    expect(store.read("olga")).toEqual(usualLayout());
  });
});
