import { describe, expect, it } from "vitest";
import { LabelRoom } from "../../src/render/labelroom";

describe("room for labels", () => {
  it("is given to the first who asks, and to those beside and above", () => {
    const room = new LabelRoom();
    expect(room.take({ x: 100, y: 100, width: 60, height: 20 })).toBe(true);
    expect(room.take({ x: 130, y: 110, width: 60, height: 20 })).toBe(false);
    expect(room.take({ x: 162, y: 100, width: 60, height: 20 })).toBe(true);
    expect(room.take({ x: 100, y: 78, width: 60, height: 20 })).toBe(true);
  });

  it("is not taken by those who found none", () => {
    const room = new LabelRoom();
    room.take({ x: 0, y: 0, width: 10, height: 10 });
    room.take({ x: 9, y: 0, width: 10, height: 10 });
    expect(room.take({ x: 18, y: 0, width: 10, height: 10 })).toBe(true);
  });

  it("is all free again in the next frame", () => {
    const room = new LabelRoom();
    room.take({ x: 0, y: 0, width: 10, height: 10 });
    room.clear();
    expect(room.take({ x: 0, y: 0, width: 10, height: 10 })).toBe(true);
  });
});
