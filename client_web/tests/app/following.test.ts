import { beforeEach, describe, expect, it } from "vitest";
import { Following } from "../../src/app/following";
import type { World } from "../../src/world/world";

interface Spot {
  x: number;
  y: number;
  z: number;
}

let walks: Spot[];
let stands: number;
let following: Following;

beforeEach(() => {
  walks = [];
  stands = 0;
  following = new Following(
    (place) => walks.push(place),
    () => stands++,
    () => undefined,
  );
});

function world(own: Spot, other: Spot | null): World {
  const avatars = new Map(other ? [[2, { pose: other }]] : []);
  return { own: { pose: own }, avatars } as unknown as World;
}

const at = (x: number, y = 0, z = 0): Spot => ({ x, y, z });

describe("following", () => {
  it("walks to whoever is far, and stands near by", () => {
    following.start(2);
    following.frame(world(at(0), at(5)), 0);
    expect(walks).toEqual([at(5)]);
    following.frame(world(at(4), at(5)), 100);
    expect(stands).toBe(1);
    following.frame(world(at(4), at(6)), 2000);
    expect(walks).toHaveLength(1);
    following.frame(world(at(4), at(6.5)), 2100);
    expect(walks.at(-1)).toEqual(at(6.5));
  });

  it("asks for a new way now and then, once the other one has gone on", () => {
    following.start(2);
    for (let ms = 0; ms < 3000; ms += 50) following.frame(world(at(0), at(5 + ms / 1000)), ms);
    expect(walks.length).toBeGreaterThan(2);
    expect(walks.length).toBeLessThan(6);
  });

  it("goes to another floor though it is straight above", () => {
    following.start(2);
    following.frame(world(at(0), at(0, 0, 3.5)), 0);
    expect(walks).toEqual([at(0, 0, 3.5)]);
  });

  it("ends when the other one is out of view", () => {
    following.start(2);
    following.frame(world(at(0), null), 0);
    expect(following.id).toBe(null);
  });
});
