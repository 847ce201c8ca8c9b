/** Where somebody is, in words, and all that is around: "Maple, 3 m, to the left, comes nearer". */

import { STOREYS_APART_M } from "../world/heights";
import type { Avatar, World } from "../world/world";

/** The nearest are told of, up to this number, and places up to this distance. */
const MOST = 6;
const PLACE_M = 12;
/** Slower than this nobody comes nearer or goes away, metres a second. */
const SLOW_MPS = 0.25;

/** Names of the eight directions, the first straight ahead, and then to the left. */
const SIDES = [
  "ahead",
  "ahead to the left",
  "to the left",
  "behind to the left",
  "behind",
  "behind to the right",
  "to the right",
  "ahead to the right",
] as const;

/** The name of a direction on the ground, seen by somebody who looks along `yaw`; radians. */
export function sideOf(direction: number, yaw: number): string {
  const eighth = Math.round((direction - yaw) / (Math.PI / 4));
  return SIDES[((eighth % 8) + 8) % 8] ?? "ahead";
}

export function whereabouts(
  { pose, away }: Pick<Avatar, "pose" | "away">,
  here: { x: number; y: number; z: number },
  yaw: number,
): string {
  const [dx, dy, dz] = [pose.x - here.x, pose.y - here.y, pose.z - here.z];
  const parts = [`${Math.round(Math.hypot(dx, dy))} m`, sideOf(Math.atan2(dy, dx), yaw)];
  if (Math.abs(dz) > STOREYS_APART_M) parts.push(dz > 0 ? "further up" : "further down");
  if (away) parts.push("away from the screen");
  return parts.join(", ");
}

/** Sentences about the people and places around the own avatar, the nearest first. */
export function surroundings({ own, avatars, scene }: World, yaw: number): string {
  if (!own) return "";
  const here = own.pose;
  const apartM = ({ x, y }: { x: number; y: number }): number => Math.hypot(x - here.x, y - here.y);
  const onFloor = (z: number): boolean => Math.abs(z - here.z) <= STOREYS_APART_M;
  const place = scene.places
    .filter(({ z_m }) => onFloor(z_m))
    .map(({ name, position: [x, y] }) => ({ name, x, y, apart: apartM({ x, y }) }))
    .filter(({ apart }) => apart <= PLACE_M)
    .sort((a, b) => a.apart - b.apart)[0];
  const others = [...avatars.values()].filter(({ own: isOwn, pose }) => !isOwn && onFloor(pose.z));
  const nearest = others.sort((a, b) => apartM(a.pose) - apartM(b.pose)).slice(0, MOST);
  const sentences = nearest.map((other) => {
    const how = approach(other.pose, here);
    return `${other.name}, ${whereabouts(other, here, yaw)}${how === "" ? "" : `, ${how}`}.`;
  });
  if (place) {
    const side = sideOf(Math.atan2(place.y - here.y, place.x - here.x), yaw);
    sentences.unshift(`The place ${place.name} is ${Math.round(place.apart)} m ${side}.`);
  }
  const more = others.length - nearest.length;
  if (more > 0) sentences.push(`${more} more further away.`);
  return others.length > 0 ? sentences.join(" ") : [...sentences, "Nobody is near."].join(" ");
}

/** Whether somebody comes nearer by their own walking, or goes away. */
function approach(
  { x, y, heading, speed }: Avatar["pose"],
  here: { x: number; y: number },
): string {
  const towards = Math.atan2(here.y - y, here.x - x);
  const nearerMps = speed * Math.cos(heading - towards);
  if (Math.abs(nearerMps) < SLOW_MPS) return "";
  return nearerMps > 0 ? "comes nearer" : "goes away";
}
