import { afterEach, describe, expect, it } from "vitest";
import { Outcome, Reason } from "../../src/net/codes";
import type { Plan } from "../../src/net/messages";
import { plain } from "../../src/language/phrase";
import { speak } from "../../src/language/words";
import { behaviourOf, followersOf, outlookOf, reasonOf, stopOf } from "../../src/ui/planwords";

const PLAN: Plan = {
  type: "plan",
  tick: 1,
  id: 2,
  reason: Reason.MOVING,
  behaviour: "wander",
  goal: [4, 5, 0],
  path: [
    [0, 0, 0, 0],
    [4, 5, 0, 4.2],
  ],
  people: [],
  since_s: 1,
  blocker: null,
  outcome: null,
  in_the_way: null,
};
const MARTA = { kind: "person", id: 7, door: null, away: 0.2 };
const nameOf = (id: number): string | null => (id === 7 ? "Marta" : null);

afterEach(() => speak("en"));

describe("the reason", () => {
  it("names the person for whom an actor waits", () => {
    const plan = { ...PLAN, reason: Reason.GIVING_WAY, blocker: MARTA };
    expect(plain(reasonOf(plan, nameOf))).toBe("giving way to Marta");
    expect(plain(reasonOf({ ...plan, reason: Reason.WAITING }, nameOf))).toBe("waiting for Marta");
  });

  it("says that somebody is out of sight, and names doors", () => {
    const plan = { ...PLAN, reason: Reason.WAITING };
    const stranger = { ...MARTA, id: 8 };
    const door = { kind: "door", id: null, door: "archive", away: 1 };
    expect(plain(reasonOf({ ...plan, blocker: stranger }, nameOf))).toBe(
      "waiting for somebody out of sight",
    );
    expect(plain(reasonOf({ ...plan, blocker: door }, nameOf))).toBe(
      "waiting for the door “archive”",
    );
  });

  it("is how the trip ended, once it has", () => {
    const plan = { ...PLAN, reason: Reason.WAITING, outcome: Outcome.NEAR, in_the_way: MARTA };
    expect(plain(reasonOf(plan, nameOf))).toBe("is as near to its goal as it gets: Marta is there");
    expect(plain(reasonOf({ ...plan, outcome: Outcome.NO_WAY }, nameOf))).toContain("no way leads");
  });
});

describe("the behaviour", () => {
  const places = [
    { name: "Archive", position: [4.5, 5] as [number, number], z_m: 0 },
    { name: "Loft", position: [4, 5] as [number, number], z_m: 3.5 },
  ];

  it("names the place on the same floor that the actor goes to", () => {
    expect(plain(behaviourOf(PLAN, places))).toBe("wanders between places, now to: Archive");
  });

  it("names none where there is none, and none when the trip is over", () => {
    expect(plain(behaviourOf({ ...PLAN, goal: [40, 5, 0] }, places))).toBe(
      "wanders between places",
    );
    expect(plain(behaviourOf({ ...PLAN, outcome: Outcome.ARRIVED }, places))).toBe(
      "wanders between places",
    );
  });
});

describe("the outlook", () => {
  it("tells the path of an actor that walks, and none of one that has arrived", () => {
    expect(plain(outlookOf(PLAN))).toBe("there in 4 secs, 0 people near");
    expect(plain(outlookOf({ ...PLAN, goal: [9, 5, 0] }))).toBe("path for 4 secs, 0 people near");
    expect(plain(outlookOf({ ...PLAN, reason: Reason.ARRIVED }))).toBe("0 people near");
  });
});

describe("the tour", () => {
  const tour = { stops: ["Archive", ""], next: 0, followers: [7, 8] };

  it("has stops with names, or with numbers where there are none", () => {
    expect([stopOf(tour, 0), stopOf(tour, 1)].map(plain)).toEqual(["Archive", "Stop 2"]);
  });

  it("says who is on it", () => {
    expect(plain(followersOf(tour, 7))).toBe("You are on this tour, with 1 person more.");
    expect(plain(followersOf(tour, 1))).toBe("2 people on this tour.");
    expect(plain(followersOf({ ...tour, followers: [7] }, 7))).toBe("You are on this tour.");
    expect(plain(followersOf({ ...tour, followers: [] }, 7))).toBe("Nobody is on this tour yet.");
  });
});

describe("the plan in other languages", () => {
  const door = { kind: "door", id: null, door: "archive", away: 1 };
  const stranger = { ...MARTA, id: 8 };

  it("has the cases of German", async () => {
    await speak("de");
    const waiting = { ...PLAN, reason: Reason.WAITING };
    expect(plain(reasonOf({ ...waiting, blocker: stranger }, nameOf))).toBe(
      "wartet auf jemanden außer Sicht",
    );
    const blocked = { ...PLAN, outcome: Outcome.BLOCKED, in_the_way: stranger };
    expect(plain(reasonOf(blocked, nameOf))).toBe("hat aufgegeben: jemand außer Sicht ist im Weg");
    expect(plain(outlookOf(PLAN)).replace(/\s/gu, " ")).toBe(
      "in 4 Sek. dort, 0 Personen in der Nähe",
    );
  });

  it("has no spaces between the characters of Chinese", async () => {
    await speak("zh-Hant");
    const plan = { ...PLAN, reason: Reason.WAITING, blocker: door };
    expect(plain(reasonOf(plan, nameOf))).toBe("正在等待「archive」這扇門");
    expect(plain(behaviourOf(PLAN, [{ name: "Archive", position: [4, 5], z_m: 0 }]))).toBe(
      "四處閒逛，現在往：Archive",
    );
  });
});
