import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { Debounced, Stream } from "../../src/console/models/pacing";

beforeEach(() => {
  vi.useFakeTimers();
});
afterEach(() => {
  vi.useRealTimers();
});

describe("a pause in typing", () => {
  it("calls once after the last wish", () => {
    const work = vi.fn();
    const debounced = new Debounced(work, 250);
    for (let key = 0; key < 5; key += 1) {
      debounced.want();
      vi.advanceTimersByTime(100);
    }
    expect(work).not.toHaveBeenCalled();
    vi.advanceTimersByTime(250);
    expect(work).toHaveBeenCalledTimes(1);
  });
});

describe("a stream of a slider", () => {
  it("sends at most ten a second, and the last value at the end", async () => {
    const sent: number[] = [];
    const stream = new Stream<number>(
      (value) => {
        sent.push(value);
        return Promise.resolve();
      },
      100,
      () => Date.now(),
    );
    for (let value = 0; value < 100; value += 1) {
      stream.want(value);
      await vi.advanceTimersByTimeAsync(10);
    }
    await vi.advanceTimersByTimeAsync(200);
    expect(sent.length).toBeLessThanOrEqual(11);
    expect(sent.at(-1)).toBe(99);
  });

  it("waits for the answer before it sends the next one", async () => {
    const answers: (() => void)[] = [];
    const sent: number[] = [];
    const stream = new Stream<number>(
      (value) => {
        sent.push(value);
        return new Promise((resolve) => answers.push(resolve));
      },
      10,
      () => Date.now(),
    );
    stream.want(1);
    await vi.advanceTimersByTimeAsync(20);
    stream.want(2);
    stream.want(3);
    await vi.advanceTimersByTimeAsync(500);
    expect(sent).toEqual([1]);
    answers[0]?.();
    await vi.advanceTimersByTimeAsync(50);
    expect(sent).toEqual([1, 3]);
  });
});
