import { Color } from "three";
import { describe, expect, it } from "vitest";
import { unlikeness } from "../../src/render/likeness";
import { clothingOf } from "../../src/render/clothing";

describe("clothes", () => {
  it("are never taken for skin", () => {
    for (let id = 0; id < 400; id++) {
      const { shirt, trousers, skin } = clothingOf(id);
      expect(unlikeness(shirt, skin), `shirt of ${id}`).toBeGreaterThan(0.1);
      expect(unlikeness(trousers, skin), `trousers of ${id}`).toBeGreaterThan(0.1);
    }
  });

  it("are those of a look, whatever the id, but for parts that are not chosen", () => {
    const red = clothingOf(1, [1, 8, 5, 8, 8, 171]);
    expect(clothingOf(2, [1, 8, 5, 8, 8, 171])).toEqual(red);
    expect(red.shirt.getHexString()).toBe("c8413b");
    expect(red.hairdo).toBeNull();
    const natural = clothingOf(1);
    expect(clothingOf(1, [0, 0, 0, 0, 0, 171])).toEqual(natural);
    expect(clothingOf(1, [99, 99, 99, 99, 99, 171]).shirt).toEqual(natural.shirt);
    expect(clothingOf(1, [1, 0, 0, 0, 0, 0]).skin).toEqual(natural.skin);
  });

  it("are of every colour", () => {
    const shirts = new Set(Array.from({ length: 400 }, (_, id) => clothingOf(id).shirt.getHex()));
    expect(shirts.size).toBe(10);
  });
});

describe("unlikeness", () => {
  it("is what one sees: 1 from black to white, and little between two browns", () => {
    expect(unlikeness(new Color("#000000"), new Color("#ffffff"))).toBeCloseTo(1, 3);
    expect(unlikeness(new Color("#8a5a3b"), new Color("#9a643f"))).toBeLessThan(0.05);
    expect(unlikeness(new Color("#2f6fb5"), new Color("#9a643f"))).toBeGreaterThan(0.2);
  });
});
