import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { ParameterWork } from "../../src/console/models/parameterwork";
import { Api } from "../../src/console/net/api";
import type { Command } from "../../src/console/net/types";

function textOf(init: RequestInit | undefined): string {
  return typeof init?.body === "string" ? init.body : "";
}

/** A server of two parameters, which answers when it is told to. */
class FakeServer {
  revision = 1;
  world: Record<string, number> = {};
  sent: Command[][] = [];
  held: (() => void)[] = [];
  isHolding = false;
  refuse: object | null = null;

  readonly fetch: typeof globalThis.fetch = async (address, init) => {
    const path = new URL(address instanceof Request ? address.url : address).pathname;
    if (path.endsWith("/commands")) {
      const commands = JSON.parse(textOf(init)) as Command[];
      this.sent.push(commands);
      if (this.isHolding) await new Promise<void>((go) => this.held.push(go));
      if (this.refuse) return Response.json(this.refuse, { status: 409 });
      return Response.json(commands.map((command) => this.carryOut(command)));
    }
    if (path.endsWith("/parameters")) {
      const defaults = { risk_weight: 9.5, radius_m: 0.25 };
      return Response.json({ revision: this.revision, defaults, scopes: { world: this.world } });
    }
    if (path.endsWith("/actors")) return Response.json({ actors: [] });
    const property = { type: "number", minimum: 0, maximum: 200, default: 1 };
    const properties = { risk_weight: property, radius_m: property };
    return Response.json({ parameters: { properties } });
  };

  private carryOut(command: Command): object {
    if (!command.dry_run) {
      this.revision += 1;
      Object.assign(this.world, command["values"]);
    }
    const isBody = JSON.stringify(command).includes("radius_m");
    const price = isBody ? { price: "prepared", prepare_s: 0.3 } : { price: "tick" };
    return { op: command.op, command: 1, tick: 5, revision: this.revision, faults: [], ...price };
  }
}

let server: FakeServer;
let work: ParameterWork;

beforeEach(async () => {
  vi.useFakeTimers();
  server = new FakeServer();
  work = new ParameterWork(new Api("http://server/api/v1", server.fetch));
  await work.load();
});
afterEach(() => {
  work.stop();
  vi.useRealTimers();
});

describe("the form of parameters", () => {
  it("has its draft checked once after typing, and tells the price", async () => {
    for (const value of [1, 13, 134]) {
      work.edit("risk_weight", value, true);
      await vi.advanceTimersByTimeAsync(50);
    }
    expect(server.sent).toEqual([]);
    await vi.advanceTimersByTimeAsync(300);
    expect(server.sent).toHaveLength(1);
    expect(server.sent[0]?.[0]).toMatchObject({ dry_run: true, values: { risk_weight: 134 } });
    expect(work.draft.price).toBe("tick");
    work.edit("radius_m", 0.3);
    await vi.advanceTimersByTimeAsync(300);
    expect(work.draft.price).toBe("prepared");
    expect(work.draft.prepareSeconds).toBe(0.3);
    expect(server.world).toEqual({});
  });

  it("applies with the revision that is known, and sends afterwards what was typed meanwhile", async () => {
    work.edit("risk_weight", 12);
    work.note = " queue at the door ";
    server.isHolding = true;
    const applied = work.apply();
    await vi.advanceTimersByTimeAsync(1);
    expect(server.sent.at(-1)?.[0]).toMatchObject({ if_revision: 1, note: "queue at the door" });
    work.edit("risk_weight", 14);
    server.isHolding = false;
    server.held.shift()?.();
    await applied;
    const values = server.sent.filter(([one]) => !one?.dry_run).map(([one]) => one?.["values"]);
    expect(values).toEqual([{ risk_weight: 12 }, { risk_weight: 14 }]);
    expect(work.draft.isEmpty).toBe(true);
    expect(server.world).toEqual({ risk_weight: 14 });
  });

  it("keeps everything that was typed when it is refused", async () => {
    work.edit("risk_weight", 12);
    const differences = [{ field: "risk_weight", yours: 12, now: 30 }];
    const fault = { code: "conflict", text: "changed: risk_weight", arguments: { differences } };
    server.refuse = { faults: [fault] };
    await expect(work.apply()).rejects.toThrow("changed");
    expect(work.draft.value("risk_weight")).toBe(12);
    expect(work.draft.beside("risk_weight")?.value).toBe(30);
  });

  it("streams a drag, and ends with its last value and an empty draft", async () => {
    for (let value = 1; value <= 30; value += 1) {
      work.edit("risk_weight", value, true);
      work.drag();
      await vi.advanceTimersByTimeAsync(20);
    }
    await vi.advanceTimersByTimeAsync(300);
    expect(server.sent.length).toBeLessThan(10);
    expect(server.sent.every(([one]) => one?.["stream"] === true)).toBe(true);
    expect(server.world).toEqual({ risk_weight: 30 });
    expect(work.draft.isEmpty).toBe(true);
  });
});
