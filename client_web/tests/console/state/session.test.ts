import { describe, expect, it } from "vitest";
import { Api } from "../../../src/console/net/api";
import { Session } from "../../../src/console/state/session";
import { State } from "../../../src/console/state/state";

const ME = { account: "olga", role: "tuner", rights: ["watch"], via: "session" };

function made(answers: [number, unknown][], token: string | null = null) {
  const asked: string[] = [];
  const fetch = (url: unknown): Promise<Response> => {
    asked.push(String(url).replace("http://here", ""));
    const [status, body] = answers.shift() ?? [500, null];
    const text = status === 204 ? null : JSON.stringify(body);
    return Promise.resolve(new Response(text, { status }));
  };
  const state = new State();
  const api = new Api("http://here", fetch);
  return { session: new Session(api, state, token), state, api, asked };
}

const unauthorized = (first: boolean): [number, unknown] => [
  401,
  { faults: [{ code: "unauthorized", text: "log in", arguments: { first } }] },
];

describe("Session", () => {
  it("goes on with a session that there is", async () => {
    const { session, state } = made([[200, ME]]);
    await session.begin();
    expect(session.standing.value).toBe("in");
    expect(state.may("watch")).toBe(true);
    expect(state.may("accounts")).toBe(false);
  });

  it("says that a world has no account yet", async () => {
    const { session } = made([unauthorized(true)]);
    await session.begin();
    expect(session.standing.value).toBe("out");
    expect(session.untouched.value).toBe(true);
  });

  it("makes the first account with the token of the link", async () => {
    const { session, asked } = made([[200, ME]], "once");
    await session.begin();
    expect(session.standing.value).toBe("first");
    await session.makeFirst("olga", "correct horse battery");
    expect(session.standing.value).toBe("in");
    expect(asked).toEqual(["/first"]);
  });

  it("keeps what is on the page when a session ends, and sends again what waited", async () => {
    const answers: [number, unknown][] = [[200, ME], unauthorized(false)];
    const { session, state, api } = made(answers);
    await session.begin();
    state.draft.value = { scope: "world", values: { risk_weight: 3 } };
    const waiting = api.get<{ tick: number }>("/world");
    await expect.poll(() => session.standing.value).toBe("away");
    expect(state.draft.value.values).toEqual({ risk_weight: 3 });
    answers.push([200, ME], [200, { tick: 9 }]);
    await session.logIn("olga", "correct horse battery");
    await expect(waiting).resolves.toEqual({ tick: 9 });
    expect(session.standing.value).toBe("in");
  });

  it("sends nothing of one account again for another", async () => {
    const answers: [number, unknown][] = [[200, ME], unauthorized(false)];
    const { session, api } = made(answers);
    await session.begin();
    const waiting = api.command({ op: "mark" });
    await expect.poll(() => session.standing.value).toBe("away");
    answers.push([200, { ...ME, account: "paul" }]);
    await session.logIn("paul", "correct horse battery");
    await expect(waiting).rejects.toMatchObject({ status: 401 });
  });

  it("leaves nothing of an account that logs out", async () => {
    const { session, state } = made([[200, ME], unauthorized(false)]);
    await session.begin();
    state.chosen.value = ["main/actor-1"];
    await session.logOut();
    expect(session.standing.value).toBe("out");
    expect(state.me.value).toBeNull();
    expect(state.chosen.value).toEqual([]);
  });
});
