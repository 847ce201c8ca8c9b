import { describe, expect, it } from "vitest";
import { Live, MOST_SUBSCRIPTIONS } from "../../../src/console/net/live";

/** A socket whose other end the test holds. */
class Line extends EventTarget {
  binaryType = "blob";
  readyState = 0;
  readonly sent: unknown[] = [];

  send(text: string): void {
    this.sent.push(JSON.parse(text));
  }

  close(): void {
    this.readyState = 3;
  }

  open(): void {
    this.readyState = 1;
    this.dispatchEvent(new Event("open"));
  }

  say(data: unknown): void {
    this.dispatchEvent(Object.assign(new Event("message"), { data }));
  }

  cut(code: number): void {
    this.readyState = 3;
    this.dispatchEvent(Object.assign(new Event("close"), { code }));
  }
}

function made(): { live: Live; lines: Line[]; wait: () => Promise<void>; waits: number[] } {
  const lines: Line[] = [];
  const waits: number[] = [];
  let call: (() => void) | null = null;
  const live = new Live("ws://here", {
    open: () => {
      const line = new Line();
      lines.push(line);
      return line as unknown as WebSocket;
    },
    random: () => 1,
    after: (ms, later) => {
      waits.push(ms);
      call = later;
      return () => (call = null);
    },
    now: () => 0,
  });
  const wait = async (): Promise<void> => {
    call?.();
    await Promise.resolve();
    await Promise.resolve();
  };
  return { live, lines, wait, waits };
}

describe("Live", () => {
  it("subscribes once for all who listen, and ends when the last one goes", () => {
    const { live, lines } = made();
    const heard: string[] = [];
    const stopA = live.subscribe("series", {}, () => heard.push("a"));
    live.start();
    lines[0]?.open();
    const stopB = live.subscribe("series", {}, () => heard.push("b"));
    lines[0]?.say('{"channel":"series"}');
    stopA();
    lines[0]?.say('{"channel":"series"}');
    stopB();
    expect(heard).toEqual(["a", "b", "b"]);
    expect(lines[0]?.sent).toEqual([{ subscribe: "series" }, { unsubscribe: "series" }]);
  });

  it("asks for more when another listener wants more", () => {
    const { live, lines } = made();
    live.start();
    lines[0]?.open();
    live.subscribe("actor:main/actor-1", { hz: 2 }, () => undefined);
    live.subscribe("actor:main/actor-1", { hz: 5 }, () => undefined);
    live.subscribe("actor:main/actor-1", { hz: 1 }, () => undefined);
    expect(lines[0]?.sent).toEqual([
      { subscribe: "actor:main/actor-1", hz: 2 },
      { subscribe: "actor:main/actor-1", hz: 5 },
    ]);
  });

  it("comes back with the same subscriptions, waiting longer each time", async () => {
    const { live, lines, wait, waits } = made();
    live.subscribe("map", { hz: 10 }, () => undefined);
    live.start();
    lines[0]?.open();
    lines[0]?.cut(1006);
    expect(live.phase.value).toBe("connecting");
    await wait();
    lines[1]?.cut(1006);
    await wait();
    lines[2]?.open();
    expect(live.phase.value).toBe("on");
    expect(lines[2]?.sent).toEqual([{ subscribe: "map", hz: 10 }]);
    expect(waits[1]).toBeGreaterThan(waits[0] ?? 0);
  });

  it("does not connect again while nobody is logged in", async () => {
    const { live, lines, wait } = made();
    live.start();
    live.mayConnect = () => Promise.resolve(false);
    lines[0]?.cut(4001);
    await wait();
    expect(lines).toHaveLength(1);
    live.mayConnect = () => Promise.resolve(true);
    await wait();
    expect(lines).toHaveLength(2);
  });

  it("hands frames and refusals to those who want them", () => {
    const { live, lines } = made();
    const frames: number[] = [];
    const refused: string[] = [];
    const messages: unknown[] = [];
    live.frames((frame) => frames.push(frame.byteLength));
    live.subscribe("map", {}, (message) => messages.push(message));
    live.refused = (faults) => refused.push(...faults.map(({ code }) => code));
    live.start();
    lines[0]?.open();
    lines[0]?.say(new ArrayBuffer(12));
    lines[0]?.say('{"channel":"map","faults":[{"code":"invalid","text":"no"}]}');
    expect({ frames, refused, messages }).toEqual({
      frames: [12],
      refused: ["invalid"],
      messages: [],
    });
  });

  it("refuses more channels than the server takes", () => {
    const { live } = made();
    for (let index = 0; index < MOST_SUBSCRIPTIONS; index++) {
      live.subscribe(`actor:${index}`, {}, () => undefined);
    }
    expect(() => live.subscribe("map", {}, () => undefined)).toThrow("16 channels");
  });
});
