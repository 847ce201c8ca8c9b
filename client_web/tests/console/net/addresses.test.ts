import { describe, expect, it } from "vitest";
import { addressesOf, pageOfZone } from "../../../src/console/net/addresses";

const HOST = "https://world.example";

describe("addresses", () => {
  it("are below whatever the page is below", () => {
    const { api, live } = addressesOf(new URL(`${HOST}/esplanade/zones/hall/console/#x`));
    expect(api).toBe(`${HOST}/esplanade/api/v1/zones/hall`);
    expect(live).toBe("wss://world.example/esplanade/api/v1/zones/hall/live");
    expect(addressesOf(new URL(`${HOST}/console/`)).api).toBe(`${HOST}/api/v1`);
  });

  it.each([
    ["/console/", "/zones/yard/console/"],
    ["/zones/hall/console/#map", "/zones/yard/console/"],
    ["/esplanade/zones/hall/console/", "/esplanade/zones/yard/console/"],
    ["/esplanade/console/console.html", "/esplanade/zones/yard/console/"],
  ])("of another zone leave out the zone of now: %s", (now, other) => {
    expect(pageOfZone(new URL(HOST + now), "yard")).toBe(HOST + other);
  });
});
