import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { ClientCode, CloseCode, ServerCode, VERSION } from "../../src/net/codes";
import { Connection, type ConnectionState } from "../../src/net/connection";
import type { ServerMessage } from "../../src/net/messages";
import { FakeSocket, WELCOME } from "./sockets";

let sockets: FakeSocket[];
let states: ConnectionState[];
let messages: ServerMessage[];
let connection: Connection;

const newest = (): FakeSocket => {
  const socket = sockets.at(-1);
  if (!socket) throw new Error("no socket was opened");
  return socket;
};
const phases = (): string[] => states.map(({ phase }) => phase);

beforeEach(() => {
  vi.useFakeTimers();
  [sockets, states, messages] = [[], [], []];
  connection = new Connection(
    () => {
      const socket = new FakeSocket();
      sockets.push(socket);
      return socket;
    },
    { state: (state) => states.push(state), message: (message) => messages.push(message) },
    () => 0.5,
  );
});

afterEach(() => {
  vi.useRealTimers();
});

function comeIn(): void {
  connection.join({ name: "Ann", resume: null, operator: null, admission: null, look: null });
  newest().accept();
  newest().say(ServerCode.WELCOME, WELCOME);
}

describe("joining", () => {
  it("greets as soon as the socket is open and is live with the welcome", () => {
    comeIn();
    const hello = {
      name: "Ann",
      version: VERSION,
      resume: null,
      at: null,
      operator: null,
      admission: null,
    };
    expect(newest().received[0]).toEqual([ClientCode.HELLO, hello]);
    expect(phases()).toEqual(["connecting", "live"]);
    expect(messages.map(({ type }) => type)).toEqual(["welcome"]);
  });

  it("sends nothing but the greeting before the welcome", () => {
    connection.join({ name: "Ann", resume: null, operator: null, admission: null, look: null });
    newest().accept();
    expect(connection.send({ type: "chat", text: "too early" })).toBe(false);
    expect(newest().received).toHaveLength(1);
  });

  it("gives up on a server that does not answer, and tries again", () => {
    connection.join({ name: "Ann", resume: null, operator: null, admission: null, look: null });
    newest().accept();
    vi.advanceTimersByTime(12_000);
    expect(phases()).toContain("reconnecting");
    expect(sockets.length).toBeGreaterThan(1);
  });
});

describe("pings", () => {
  it("set the clock by half the round trip", () => {
    comeIn();
    const ping = newest().received.find(([code]) => code === ClientCode.PING);
    vi.advanceTimersByTime(200);
    newest().say(ServerCode.PONG, { nonce: ping?.[1].nonce, server_time: 50 });
    expect(connection.clock.roundTripS).toBeCloseTo(0.2);
    expect(connection.clock.at(performance.now() / 1000)).toBeCloseTo(50.1);
    expect(messages.some(({ type }) => type === "pong")).toBe(false);
  });

  it("that stay unanswered end the connection", () => {
    comeIn();
    vi.advanceTimersByTime(6_500);
    expect(states.at(-1)).toMatchObject({
      phase: "reconnecting",
      ending: { cause: "serverSilent" },
    });
  });

  it("end it sooner once the device says that it has no network", () => {
    comeIn();
    connection.doubt();
    vi.advanceTimersByTime(2_500);
    expect(connection.state.phase).toBe("reconnecting");
  });

  it("keep it, whatever the device says, when they are answered", () => {
    comeIn();
    connection.doubt();
    for (let second = 0; second < 6; second++) {
      vi.advanceTimersByTime(1_000);
      newest().say(ServerCode.PONG, { nonce: 0, server_time: second });
    }
    expect(connection.state.phase).toBe("live");
  });
});

describe("an older server", () => {
  it("is greeted again in the version before, and sent nothing that it does not know", () => {
    connection.join({ name: "Ann", resume: null, operator: null, admission: null, look: null });
    newest().accept();
    newest().end(CloseCode.UNSUPPORTED_VERSION);
    newest().accept();
    expect(sockets.length).toBe(2);
    expect(newest().received[0]?.[1]["version"]).toBe(VERSION - 1);
    newest().say(ServerCode.WELCOME, { ...WELCOME, version: VERSION - 1 });
    expect(connection.send({ type: "look", look: [1, 2, 3, 4, 5, 171] })).toBe(false);
    expect(connection.send({ type: "chat", text: "hi" })).toBe(true);
  });

  it("that speaks none of the versions is left", () => {
    connection.join({ name: "Ann", resume: null, operator: null, admission: null, look: null });
    for (let k = 0; k < 3; k++) newest().end(CloseCode.UNSUPPORTED_VERSION);
    vi.advanceTimersByTime(60_000);
    expect(sockets).toHaveLength(3);
    expect(connection.state.phase).toBe("refused");
  });
});

describe("a later version of the server's messages", () => {
  it("is no fault: unknown codes, fields and names are passed over", () => {
    connection.join({ name: "Ann", resume: null, operator: null, admission: null, look: null });
    newest().accept();
    newest().say(99, { before: "welcome" });
    newest().say(ServerCode.WELCOME, { ...WELCOME, later: { a: [1] } });
    newest().say(100, {});
    newest().say(ServerCode.BYE, { reason: "moved", text: "elsewhere", to: "there" });
    expect(connection.state.phase).toBe("live");
    expect(messages.map(({ type }) => type)).toEqual(["welcome", "bye"]);
  });
});

describe("a lost connection", () => {
  it("comes back with the token of the last welcome", () => {
    comeIn();
    newest().end(1006);
    expect(connection.state).toMatchObject({ phase: "reconnecting", attempt: 0 });
    vi.advanceTimersByTime(400);
    newest().accept();
    expect(newest().received[0]?.[1]).toMatchObject({ name: "Ann", resume: "token-1" });
    newest().say(ServerCode.WELCOME, { ...WELCOME, resumed: true });
    expect(connection.state.phase).toBe("live");
  });

  it("waits longer after each failure", () => {
    comeIn();
    const waits: number[] = [];
    for (let i = 0; i < 6; i++) {
      newest().end(1006);
      const count = sockets.length;
      let waited = 0;
      while (sockets.length === count) {
        vi.advanceTimersByTime(50);
        waited += 50;
      }
      waits.push(waited);
    }
    expect(waits).toEqual([300, 600, 1200, 2400, 3000, 3000]);
  });

  it("is tried at once when somebody says hurry", () => {
    comeIn();
    newest().end(1006);
    connection.hurry();
    expect(sockets).toHaveLength(2);
    vi.advanceTimersByTime(5000);
    expect(sockets).toHaveLength(2);
  });

  it.each([[CloseCode.SERVER_FULL], [CloseCode.REPLACED]])(
    "stays lost after close code %i",
    (code) => {
      comeIn();
      newest().say(ServerCode.ERROR, { error: "server_full", text: "room for 3" });
      newest().end(code);
      vi.advanceTimersByTime(60_000);
      expect(sockets).toHaveLength(1);
      const state = connection.state;
      expect(state.phase === "refused" && state.ending.stated).toEqual({ words: "room for 3" });
    },
  );

  it("follows a frame that cannot be read", () => {
    comeIn();
    newest().deliver("text");
    expect(states.at(-1)).toMatchObject({ phase: "reconnecting" });
    expect(sockets[0]?.closedWith).toBe("no code");
  });
});

describe("leaving", () => {
  it("closes in good order and stays away", () => {
    comeIn();
    connection.leave();
    expect(newest().closedWith).toBe(CloseCode.NORMAL);
    vi.advanceTimersByTime(60_000);
    expect(sockets).toHaveLength(1);
    expect(connection.state.phase).toBe("idle");
  });
});
