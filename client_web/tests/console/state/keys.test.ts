import { describe, expect, it } from "vitest";
import { rove } from "../../../src/console/state/roving";
import { Shortcuts } from "../../../src/console/state/shortcuts";
import { Signal } from "../../../src/console/state/signal";

const key = (name: string, held = {}) => ({
  key: name,
  altKey: false,
  ctrlKey: false,
  metaKey: false,
  ...held,
});

describe("Shortcuts", () => {
  it("leaves letters to those who type, and to those who switched them off", () => {
    const shortcuts = new Shortcuts();
    let pressed = 0;
    shortcuts.add({ key: "f", text: "follow", call: () => pressed++ });
    expect(shortcuts.press(key("f"), true)).toBe(false);
    expect(shortcuts.press(key("f", { ctrlKey: true }), false)).toBe(false);
    expect(shortcuts.press(key("f"), false)).toBe(true);
    shortcuts.lettersOn = false;
    expect(shortcuts.press(key("f"), false)).toBe(false);
    expect(pressed).toBe(1);
  });

  it("gives a key to the one who asked last, until they go", () => {
    const shortcuts = new Shortcuts();
    const heard: string[] = [];
    shortcuts.add({ key: "Escape", text: "page", call: () => heard.push("page") });
    const stop = shortcuts.add({ key: "Escape", text: "panel", call: () => heard.push("panel") });
    shortcuts.press(key("Escape"), true);
    stop();
    shortcuts.press(key("Escape"), true);
    expect(heard).toEqual(["panel", "page"]);
  });
});

describe("rove", () => {
  it.each([
    ["ArrowRight", 0, 1],
    ["ArrowRight", 2, 0],
    ["ArrowUp", 0, 2],
    ["Home", 2, 0],
    ["End", 0, 2],
  ])("%s from %i", (name, from, to) => {
    expect(rove(name, from, 3)).toBe(to);
  });

  it("leaves other keys alone", () => {
    expect(rove("a", 0, 3)).toBeNull();
    expect(rove("Home", 0, 0)).toBeNull();
  });
});

describe("Signal", () => {
  it("tells of other values only, and nobody who has gone", () => {
    const signal = new Signal(1);
    const heard: number[] = [];
    const stop = signal.watch((value) => heard.push(value));
    signal.value = 1;
    signal.value = 2;
    stop();
    signal.value = 3;
    expect(heard).toEqual([2]);
  });
});
