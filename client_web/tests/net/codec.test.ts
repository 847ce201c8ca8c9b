import { decode, encode } from "@msgpack/msgpack";
import { describe, expect, it } from "vitest";
import * as codes from "../../src/net/codes";
import { decodeServer, encodeClient, unpackBlock } from "../../src/net/codec";
import { WireError } from "../../src/net/errors";
import type { ClientMessage, Point } from "../../src/net/messages";
import { unpackSteps } from "../../src/net/steps";
import wire from "../fixtures/wire.json";

const bytes = (hex: string): Uint8Array =>
  Uint8Array.from(hex.match(/../g) ?? [], (pair) => parseInt(pair, 16));

/** The fields that the caller gives; version and wished place are the codec's own. */
const given = (fields: object): object =>
  Object.fromEntries(Object.entries(fields).filter(([name]) => !["version", "at"].includes(name)));

describe("codes", () => {
  it("are those of the server", () => {
    const { ClientCode, ServerCode, Reason, Outcome, Gesture, CloseCode } = codes;
    expect({ ClientCode, ServerCode, Reason, Outcome, Gesture, CloseCode }).toEqual(wire.codes);
    expect(codes.VERSION).toBe(wire.version);
    const { MAX_NAME_CHARS, MAX_CHAT_CHARS } = codes;
    expect({ MAX_NAME_CHARS, MAX_CHAT_CHARS }).toEqual(wire.limits);
  });
});

describe("encodeClient", () => {
  it.each(wire.client.map((vector) => [vector.type, vector] as const))(
    "packs %s as the server does",
    (type, { fields, frame }) => {
      const message = { type, ...given(fields) } as ClientMessage;
      expect(decode(encodeClient(message))).toEqual(decode(bytes(frame)));
    },
  );
});

it("says nothing of looks to a server that knows none", () => {
  const hello = { name: "Ann", resume: null, operator: null, admission: null };
  const message = { type: "hello", ...hello, look: [1, 2, 3, 4, 5, 171] } as const;
  expect(decode(encodeClient(message, 5))).toEqual([1, { ...hello, version: 5, at: null }]);
});

describe("decodeServer", () => {
  it.each(wire.server.map((vector) => [vector.type, vector] as const))(
    "reads %s",
    (type, { fields, frame }) => {
      expect(decodeServer(bytes(frame))).toEqual({ type, ...fields });
    },
  );

  it("reads a snapshot", () => {
    const { tick, ack, origin, frame, records } = wire.snapshot;
    const message = decodeServer(bytes(frame));
    expect(message).toMatchObject({ type: "snapshot", tick, ack });
    if (message?.type !== "snapshot") return;
    const read = unpackBlock(message.block, origin as Point);
    expect(read).toHaveLength(records.length);
    records.forEach((record, i) => {
      for (const [name, value] of Object.entries(record)) {
        expect(read[i]?.[name as keyof typeof record], name).toBeCloseTo(value, 9);
      }
    });
  });

  it("reads steps", () => {
    const { tick, frame, records } = wire.steps;
    const message = decodeServer(bytes(frame));
    expect(message).toMatchObject({ type: "steps", tick });
    if (message?.type !== "steps") return;
    expect(unpackSteps(message.block)).toHaveLength(records.length);
  });

  it("passes over message codes that it does not know", () => {
    expect(decodeServer(Uint8Array.of(0x92, 0x7f, 0x80))).toBeNull();
    expect(decodeServer(encode([99]))).toBeNull();
    expect(decodeServer(encode([99, 1, "two", new Uint8Array(3)]))).toBeNull();
  });

  it.each([
    ["no msgpack", Uint8Array.of(0xc1)],
    ["no array", Uint8Array.of(0x80)],
    ["no map of fields", Uint8Array.of(0x92, codes.ServerCode.CHAT, 0x01)],
    ["a snapshot without a block", Uint8Array.of(0x93, codes.ServerCode.SNAPSHOT, 1, 2)],
    ["steps without a block", Uint8Array.of(0x92, codes.ServerCode.STEPS, 1)],
  ])("refuses %s", (_what, frame) => {
    expect(() => decodeServer(frame)).toThrow(WireError);
  });
});

describe("unpackBlock", () => {
  it("refuses a block that is cut off", () => {
    expect(() => unpackBlock(new Uint8Array(15), [0, 0])).toThrow("no multiple of 14");
  });
});
