import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { type Channel, channelLocks, type TryLock } from "../../src/net/tablocks";

let channels: Channel[];

/** A page's end of a channel: what it says is heard by all others. */
function page(name: string): { lock: TryLock; kill: () => void } {
  const channel: Channel = {
    onmessage: null,
    postMessage: (data) => {
      for (const other of channels) {
        if (other !== channel) other.onmessage?.({ data } as MessageEvent);
      }
    },
  };
  channels.push(channel);
  const kill = (): void => {
    channels = channels.filter((each) => each !== channel);
  };
  return { lock: channelLocks(channel, name, 100), kill };
}

async function answer(asked: Promise<boolean>): Promise<boolean> {
  await vi.advanceTimersByTimeAsync(100);
  return asked;
}

beforeEach(() => {
  vi.useFakeTimers();
  channels = [];
});

afterEach(() => {
  vi.useRealTimers();
});

describe("channelLocks", () => {
  it("gives a lock to one living page", async () => {
    const [first, second] = [page("a"), page("b")];
    expect(await answer(first.lock("seat"))).toBe(true);
    expect(await answer(second.lock("seat"))).toBe(false);
    expect(await answer(second.lock("other seat"))).toBe(true);
  });

  it("gives the lock of a page that is gone to another", async () => {
    const [first, second] = [page("a"), page("b")];
    expect(await answer(first.lock("seat"))).toBe(true);
    first.kill();
    expect(await answer(second.lock("seat"))).toBe(true);
  });

  it.each([
    ["a", "b"],
    ["b", "a"],
  ])("gives it to one of two that ask at once (%s, %s)", async (one, other) => {
    const [first, second] = [page(one), page(other)];
    const asked = [first.lock("seat"), second.lock("seat")];
    await vi.advanceTimersByTimeAsync(100);
    expect((await Promise.all(asked)).sort()).toEqual([false, true]);
  });

  it("has a new lock at once, whoever asks in the same moment", async () => {
    const [first, second] = [page("b"), page("a")];
    const taken = first.lock("seat", true);
    expect(await answer(second.lock("seat"))).toBe(false);
    expect(await taken).toBe(true);
  });

  it("passes over what other scripts say", async () => {
    const { lock } = page("a");
    for (const channel of channels) channel.onmessage?.({ data: "mine" } as MessageEvent);
    expect(await answer(lock("seat"))).toBe(true);
  });
});
