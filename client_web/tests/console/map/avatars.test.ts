import { describe, expect, it } from "vitest";
import { type Avatar, Avatars, type Entered, placeAt } from "../../../src/console/map/avatars";
import { FrameClock } from "../../../src/console/map/frameclock";
import { Trail } from "../../../src/console/map/trail";

type Row = readonly [id: number, x: number, y: number];

/** A frame as the server packs it. */
function frame(tick: number, rows: readonly Row[], whole = false): ArrayBuffer {
  const view = new DataView(new ArrayBuffer(12 + 14 * rows.length));
  view.setUint8(0, 1);
  view.setUint8(1, whole ? 1 : 0);
  view.setUint32(4, tick, true);
  view.setUint32(8, rows.length, true);
  rows.forEach(([id, x, y], index) => {
    const at = 12 + 14 * index;
    view.setUint32(at, id, true);
    view.setUint8(at + 5, 3);
    view.setUint16(at + 6, x * 100, true);
    view.setUint16(at + 8, y * 100, true);
    view.setInt16(at + 10, -50, true);
    view.setUint8(at + 12, 64);
    view.setUint8(at + 13, 50);
  });
  return view.buffer;
}

const enter = (id: number, actor?: string): Entered => ({
  id,
  kind: actor === undefined ? "person" : "actor",
  name: `name ${id}`,
  radius_m: 0.3,
  ...(actor === undefined ? {} : { actor }),
});

function known(avatars: Avatars, key: string): Avatar {
  const avatar = avatars.get(key);
  if (!avatar) throw new Error(`there is no ${key}`);
  return avatar;
}

const at = (avatar: Avatar, timeS: number): number =>
  placeAt(avatar, timeS, { x: 0, y: 0, z: 0, heading: 0 }).x;

describe("Avatars", () => {
  it("knows everybody by the name that they are chosen by", () => {
    const avatars = new Avatars();
    avatars.hear({
      channel: "map",
      entered: [enter(1, "main/actor-1"), enter(2)],
      origin_m: [10, -5],
    });
    avatars.take(frame(20, [[1, 3, 4]], true), 1);
    const actor = known(avatars, "main/actor-1");
    expect(actor.to).toMatchObject({ x: 13, y: -1, z: -0.5 });
    expect(actor.to.heading).toBeCloseTo(Math.PI / 2);
    expect(actor).toMatchObject({ speed: 1, reason: 3, name: "name 1", radiusM: 0.3 });
    // The second one was in no whole frame: it is gone.
    expect(avatars.get("person:2")).toBeUndefined();
  });

  it("draws a walk evenly, and a stand as one", () => {
    const avatars = new Avatars();
    avatars.hear({ channel: "map", entered: [enter(1)], origin_m: [0, 0] });
    avatars.take(frame(0, [[1, 1, 0]]), 0);
    avatars.take(frame(2, [[1, 2, 0]]), 0.1);
    const person = known(avatars, "person:1");
    expect(at(person, 0.05)).toBeCloseTo(1.5);
    expect(at(person, 9)).toBeCloseTo(2);
    avatars.take(frame(4, []), 0.2);
    avatars.take(frame(6, []), 0.3);
    avatars.take(frame(8, [[1, 3, 0]]), 0.4);
    expect(at(person, 0.25)).toBeCloseTo(2);
    expect(at(person, 0.35)).toBeCloseTo(2.5);
  });

  it("forgets everybody who is not named when all are told anew", () => {
    const avatars = new Avatars();
    avatars.hear({ channel: "map", entered: [enter(1), enter(2)] });
    avatars.hear({ channel: "map", reset: true, entered: [enter(2)], left: [] });
    expect([...avatars.byId.keys()]).toEqual([2]);
    avatars.hear({ channel: "map", left: [2] });
    expect(avatars.get("person:2")).toBeUndefined();
    expect(avatars.roster.value).toBe(3);
  });

  it("refuses what is no frame", () => {
    const avatars = new Avatars();
    expect(() => {
      avatars.take(frame(1, [[1, 1, 1]]).slice(0, 20), 0);
    }).toThrow("do not hold 1 records");
    expect(() => {
      avatars.take(new ArrayBuffer(12), 0);
    }).toThrow("no frame");
  });
});

describe("FrameClock", () => {
  it("gives even times to frames that come unevenly", () => {
    const clock = new FrameClock();
    const times = [0, 0.13, 0.19, 0.32, 0.41, 0.48].map((nowS, index) =>
      clock.stamp(2 * index, nowS),
    );
    const apart = times.slice(1).map((time, index) => time - (times[index] ?? 0));
    for (const span of apart) expect(Math.abs(span - 0.1)).toBeLessThan(0.02);
  });

  it("follows a world that runs at another pace, and one that stood", () => {
    const clock = new FrameClock();
    let timeS = 0;
    for (let index = 0; index < 100; index++) timeS = clock.stamp(index, index * 0.2);
    expect(Math.abs(timeS - 19.8)).toBeLessThan(0.05);
    expect(clock.stamp(100, 60)).toBe(60);
  });
});

describe("Trail", () => {
  it("keeps a minute, in points half a second apart", () => {
    const trail = new Trail();
    for (let tick = 0; tick <= 1000; tick++) trail.add(tick, 0, 0, tick * 0.1);
    const seen: number[] = [];
    trail.each(89.9, 100, (x) => seen.push(x));
    expect(seen[0]).toBe(1000);
    expect(seen).toHaveLength(21);
    seen.length = 0;
    trail.each(89.9, 95, (x) => seen.push(x));
    expect(seen[0]).toBe(950);
    expect(seen.at(-1)).toBe(900);
    const all: number[] = [];
    trail.each(0, 100, (x) => all.push(x));
    expect(all).toHaveLength(120);
  });
});
