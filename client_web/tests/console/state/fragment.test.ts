import { describe, expect, it } from "vitest";
import { firstToken, readFragment, writeFragment } from "../../../src/console/state/fragment";

describe("fragment", () => {
  it("comes back as it was written", () => {
    const shared = {
      chosen: ["main/actor-3", "person:12"],
      panel: "map",
      layout: '{"version":1}',
      draft: { scope: "group:hurried", values: { risk_weight: 12, name: "a & b = c#" } },
      moment: 1_790_000_000_000_000,
    };
    const text = writeFragment(shared);
    expect(text.startsWith("sel=main/actor-3,person:12&panel=map")).toBe(true);
    expect(readFragment(`#${text}`)).toEqual(shared);
  });

  it("takes what is no fragment of ours as none", () => {
    const nothing = { chosen: [], panel: null, layout: null, draft: null, moment: null };
    for (const hash of [
      "",
      "#",
      "#draft={",
      "#draft=[1]",
      "#t=soon",
      `#sel=${"a,".repeat(20_000)}`,
    ]) {
      expect(readFragment(hash)).toEqual(nothing);
    }
  });

  it("never holds the token of a one-time link", () => {
    expect(firstToken("#first=secret")).toBe("secret");
    expect(writeFragment(readFragment("#first=secret&sel=main/actor-1"))).toBe("sel=main/actor-1");
  });
});
