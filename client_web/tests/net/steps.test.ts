import { describe, expect, it } from "vitest";
import { decodeServer } from "../../src/net/codec";
import { WireError } from "../../src/net/errors";
import { KEY_NUMBERS, STEP_KEYS, unpackSteps } from "../../src/net/steps";
import wire from "../fixtures/wire.json";

const bytes = (hex: string): Uint8Array =>
  Uint8Array.from(hex.match(/../g) ?? [], (pair) => parseInt(pair, 16));
const frame = bytes(wire.steps.frame);
const join = (...parts: ArrayLike<number>[]): Uint8Array =>
  Uint8Array.from(parts.flatMap((part) => Array.from(part)));

function block(): Uint8Array {
  const message = decodeServer(frame);
  if (message?.type !== "steps") throw new Error("the fixture holds no steps");
  return message.block;
}

describe("unpackSteps", () => {
  const read = unpackSteps(block());

  it.each(wire.steps.records.map((known, row) => [row, known] as const))(
    "reads record %i as the server wrote it",
    (row, known) => {
      const record = read[row];
      const { id, rightStands, continues, tick, ticks } = known;
      expect(record).toMatchObject({ id, rightStands, continues, tick, ticks });
      expect(record?.lift).toBeCloseTo(known.lift, 12);
      expect(record?.flight).toBe(known.flight);
      for (const foot of ["standing", "landing"] as const) {
        for (const name of ["x", "y", "z", "heading"] as const) {
          expect(record?.[foot][name], `${foot} ${name}`).toBeCloseTo(known[foot][name], 9);
        }
      }
      expect(record?.keys).toHaveLength(STEP_KEYS * KEY_NUMBERS);
      known.keys.forEach((value, place) => {
        expect(record?.keys[place], `number ${place}`).toBeCloseTo(value, 10);
      });
    },
  );

  it("passes over records of other kinds, and over what later versions add to steps", () => {
    expect(unpackSteps(bytes(wire.steps.mixed))).toEqual(read);
    expect(unpackSteps(Uint8Array.of(2, 3, 0))).toEqual([]);
  });

  const whole = block().subarray(0, 140);
  it.each<[string, Uint8Array, string]>([
    ["a head cut off", Uint8Array.of(1), "record 0 at byte 0 of a block of steps ends after 1 of"],
    ["a second head cut off", join(whole, [2, 3]), "record 1 at byte 140 of a block of steps ends"],
    ["zeros", new Uint8Array(140), "length of 0 bytes, one of kind 0 has at least 3"],
    [
      "length 0",
      join(whole, [2, 0, 0]),
      "record 1 at byte 140 of a block of steps says a length of 0",
    ],
    ["length 2", join(whole, [2, 2, 0]), "length of 2 bytes, one of kind 2 has at least 3"],
    ["a step too short", join([1, 139, 0], whole.subarray(3, 139)), "kind 1 has at least 140"],
    ["a step cut off", whole.subarray(0, 139), "length of 140 bytes, 139 are left"],
    ["a record over the end", join(whole, [2, 255, 255]), "length of 65535 bytes, 3 are left"],
  ])("refuses %s by name", (_what, broken, fault) => {
    expect(() => unpackSteps(broken)).toThrow(WireError);
    expect(() => unpackSteps(broken)).toThrow(fault);
  });

  it("reads an empty block", () => {
    expect(unpackSteps(new Uint8Array(0))).toEqual([]);
  });
});
