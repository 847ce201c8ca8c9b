/** Where somebody is, in words, and all that is around: "Maple, 3 m, to the left, comes nearer". */

import type { Side, Whereabouts } from "../language/arguments";
import type { Wording } from "../language/phrase";
import { words } from "../language/words";
import { STOREYS_APART_M } from "../world/heights";
import type { Avatar, World } from "../world/world";

/** The nearest are told of, up to this number, and places up to this distance. */
const MOST = 6;
const PLACE_M = 12;
/** Slower than this nobody comes nearer or goes away, metres a second. */
const SLOW_MPS = 0.25;

/** The eight directions, the first straight ahead, and then to the left. */
const SIDES: readonly Side[] = [
  "ahead",
  "aheadLeft",
  "left",
  "behindLeft",
  "behind",
  "behindRight",
  "right",
  "aheadRight",
];

type Spot = Record<"x" | "y" | "z", number>;

/** A direction on the ground, seen by somebody who looks along `yaw`; radians. */
export function sideOf(direction: number, yaw: number): Side {
  const eighth = Math.round((direction - yaw) / (Math.PI / 4));
  return SIDES[((eighth % 8) + 8) % 8] ?? "ahead";
}

/** Where somebody is, in words. */
export function whereIs(other: Pick<Avatar, "pose" | "away">, here: Spot, yaw: number): Wording {
  return words.card.where({ ...whereabouts(other, here, yaw), approach: null });
}

function whereabouts(
  { pose, away }: Pick<Avatar, "pose" | "away">,
  here: Spot,
  yaw: number,
): Whereabouts {
  const [dx, dy, dz] = [pose.x - here.x, pose.y - here.y, pose.z - here.z];
  return {
    distanceM: Math.round(Math.hypot(dx, dy)),
    side: sideOf(Math.atan2(dy, dx), yaw),
    floor: Math.abs(dz) <= STOREYS_APART_M ? "same" : dz > 0 ? "above" : "below",
    away,
    approach: approach(pose, here),
  };
}

/** Sentences about the people and places around the own avatar, the nearest first. */
export function surroundings({ own, avatars, scene }: World, yaw: number): Wording {
  if (!own) return "";
  const here = own.pose;
  const { around } = words;
  const apartM = ({ x, y }: { x: number; y: number }): number => Math.hypot(x - here.x, y - here.y);
  const onFloor = (z: number): boolean => Math.abs(z - here.z) <= STOREYS_APART_M;
  const place = scene.places
    .filter(({ z_m }) => onFloor(z_m))
    .map(({ name, position: [x, y] }) => ({ name, x, y, apart: apartM({ x, y }) }))
    .filter(({ apart }) => apart <= PLACE_M)
    .sort((a, b) => a.apart - b.apart)[0];
  const others = [...avatars.values()].filter(({ own: isOwn, pose }) => !isOwn && onFloor(pose.z));
  const nearest = others.sort((a, b) => apartM(a.pose) - apartM(b.pose)).slice(0, MOST);
  const sentences: Wording[] = nearest.map((other) =>
    around.somebody(other.name, whereabouts(other, here, yaw)),
  );
  if (place) {
    const side = sideOf(Math.atan2(place.y - here.y, place.x - here.x), yaw);
    sentences.unshift(around.place(place.name, { distanceM: Math.round(place.apart), side }));
  }
  const more = others.length - nearest.length;
  if (more > 0) sentences.push(around.more(more));
  if (others.length === 0) sentences.push(around.nobody);
  return around.together(sentences);
}

/** Whether somebody comes nearer by their own walking, or goes away. */
function approach(
  { x, y, heading, speed }: Avatar["pose"],
  here: { x: number; y: number },
): Whereabouts["approach"] {
  const towards = Math.atan2(here.y - y, here.x - x);
  const nearerMps = speed * Math.cos(heading - towards);
  if (Math.abs(nearerMps) < SLOW_MPS) return null;
  return nearerMps > 0 ? "nearer" : "further";
}
