import { expect, it } from "vitest";
import { randomLook, readLook } from "../../src/app/looks";
import wire from "../fixtures/wire.json";

const { most, shortest_cm: shortestCm } = wire.looks;

it("offers what the server knows, and no more", () => {
  expect(readLook(JSON.stringify(most))).toEqual(most);
  expect(readLook(JSON.stringify([1, 1, 1, 1, 1, shortestCm]))).not.toBeNull();
  expect(readLook(JSON.stringify([1, 1, 1, 1, 1, shortestCm - 1]))).toBeNull();
  most.forEach((number, part) => {
    expect(readLook(JSON.stringify(most.with(part, number + 1))), `part ${part}`).toBeNull();
    expect(readLook(JSON.stringify(most.with(part, 0))), `part ${part}`).toBeNull();
  });
});

it("takes nothing else for a look", () => {
  for (const text of [null, "", "{", "[]", "[1,2,3]", '["a",1,1,1,1,170]', "[1.5,1,1,1,1,170]"]) {
    expect(readLook(text)).toBeNull();
  }
});

it("draws looks whose every part there is", () => {
  for (const random of [0, 0.5, 0.999999]) {
    const look = randomLook(() => random);
    expect(readLook(JSON.stringify(look))).toEqual(look);
  }
});
