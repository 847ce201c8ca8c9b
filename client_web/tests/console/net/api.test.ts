import { describe, expect, it } from "vitest";
import { addressesOf } from "../../../src/console/net/addresses";
import { Api, RefusedError } from "../../../src/console/net/api";
import { merged } from "../../../src/console/net/merging";

interface Call {
  url: string;
  init: RequestInit;
}

function apiWith(answers: Response[]): { api: Api; calls: Call[] } {
  const calls: Call[] = [];
  const fetch = (url: unknown, init: RequestInit = {}): Promise<Response> => {
    calls.push({ url: String(url), init });
    const answer = answers.shift();
    return answer ? Promise.resolve(answer) : Promise.reject(new TypeError("no network"));
  };
  return { api: new Api("http://here/api/v1", fetch), calls };
}

const refusal = (status: number, code: string): Response =>
  Response.json({ faults: [{ code, text: `${code}!`, path: ["values", "a"] }] }, { status });

describe("Api", () => {
  it("sends the header that pages of others cannot, with changes only", async () => {
    const { api, calls } = apiWith([Response.json({}), Response.json({ op: "mark" })]);
    await api.get("/series", { names: "a,b", from_us: null, step_s: 10 });
    await api.command({ op: "mark", text: "now" });
    expect(calls[0]?.url).toBe("http://here/api/v1/series?names=a%2Cb&step_s=10");
    expect(new Headers(calls[0]?.init.headers).has("X-Esplanade")).toBe(false);
    expect(new Headers(calls[1]?.init.headers).get("X-Esplanade")).toBe("1");
    expect(calls[1]?.init.body).toBe('{"op":"mark","text":"now"}');
  });

  it("tells faults with their code, text and path", async () => {
    const { api } = apiWith([refusal(422, "out_of_range")]);
    const error: unknown = await api.get("/x").catch((caught: unknown) => caught);
    expect(error).toBeInstanceOf(RefusedError);
    expect(error).toMatchObject({ status: 422, code: "out_of_range", message: "out_of_range!" });
  });

  it("tells of an answer that is no JSON, and of none", async () => {
    const { api } = apiWith([new Response("<h1>Bad gateway</h1>", { status: 502 })]);
    await expect(api.get("/x")).rejects.toMatchObject({ status: 502, code: "refused" });
    await expect(api.get("/x")).rejects.toMatchObject({ status: 0, code: "no_answer" });
  });

  it("asks again once the same account is back", async () => {
    const { api, calls } = apiWith([refusal(401, "unauthorized"), Response.json({ tick: 3 })]);
    api.comeBack = () => Promise.resolve(true);
    await expect(api.get("/world")).resolves.toEqual({ tick: 3 });
    expect(calls).toHaveLength(2);
  });

  it("sends nothing again in the name of another account", async () => {
    const { api, calls } = apiWith([refusal(401, "unauthorized"), Response.json({})]);
    await expect(api.command({ op: "mark" })).rejects.toMatchObject({ status: 401 });
    expect(calls).toHaveLength(1);
  });
});

describe("addressesOf", () => {
  it.each([
    ["http://a:8081/console", "http://a:8081/api/v1", "ws://a:8081/api/v1/live"],
    ["http://a:8081/console/", "http://a:8081/api/v1", "ws://a:8081/api/v1/live"],
    ["https://b/op/console/#x", "https://b/op/api/v1", "wss://b/op/api/v1/live"],
    ["http://c:5173/console.html", "http://c:5173/api/v1", "ws://c:5173/api/v1/live"],
  ])("of %s", (page, api, live) => {
    expect(addressesOf(new URL(page))).toEqual({ api, live });
  });
});

describe("merged", () => {
  it("gives every listener what it asks for", () => {
    expect(
      merged([
        { hz: 2, ways: true },
        { hz: 5, ways: false, goals: true },
      ]),
    ).toEqual({
      hz: 5,
      ways: true,
      goals: true,
    });
  });

  it("joins lists, unless somebody wants all", () => {
    expect(merged([{ kinds: ["join"] }, { kinds: ["leave", "join"] }])).toEqual({
      kinds: ["join", "leave"],
    });
    expect(merged([{ kinds: ["join"] }, {}])).toEqual({});
  });
});
