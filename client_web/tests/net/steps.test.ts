import { describe, expect, it } from "vitest";
import { decodeServer } from "../../src/net/codec";
import { KEY_NUMBERS, STEP_KEYS, unpackSteps } from "../../src/net/steps";
import wire from "../fixtures/wire.json";

const frame = Uint8Array.from(wire.steps.frame.match(/../g) ?? [], (pair) => parseInt(pair, 16));

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

  it("refuses a block that is cut off", () => {
    expect(() => unpackSteps(block().subarray(1))).toThrow("no multiple of 225");
  });

  it("reads an empty block", () => {
    expect(unpackSteps(new Uint8Array(0))).toEqual([]);
  });
});
