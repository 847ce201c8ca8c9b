/** Words for what an actor does, where it goes, and who holds it. */

import { Outcome, Reason } from "../net/codes";
import type { Place, Plan, PlanBlocker, PlanTour, ScenePlace } from "../net/messages";

/** The name of somebody by the id; null for those whom this page does not know. */
export type NameOf = (id: number) => string | null;

/** A goal lies at a place if it is no further from it than this. */
const AT_PLACE_M = 3;
const SAME_FLOOR_M = 1.5;
/** A path that ends no further from the goal than this leads all the way. */
const AT_GOAL_M = 0.6;

const BEHAVIOURS: Record<string, string> = {
  go_to: "goes to a place",
  wander: "wanders between places",
  patrol: "patrols its round",
  guide: "guides a tour",
  idle: "has nothing to do",
};

/** The behaviour of an actor, and the place that it goes to. */
export function behaviourOf(plan: Plan, places: readonly ScenePlace[]): string {
  const behaviour = BEHAVIOURS[plan.behaviour] ?? plan.behaviour;
  const place = plan.goal && plan.outcome === null ? placeAt(plan.goal, places) : null;
  return place === null ? behaviour : `${behaviour}, now to: ${place}`;
}

/** Why an actor does what it does, or how its trip ended, with the name of who holds it. */
export function reasonOf(plan: Plan, nameOf: NameOf): string {
  const inTheWay = plan.in_the_way && blockerName(plan.in_the_way, nameOf);
  switch (plan.outcome) {
    case Outcome.NEAR:
      return `is as near to its goal as it gets: ${inTheWay ?? "somebody"} is there`;
    case Outcome.BLOCKED:
      return `has given up: ${inTheWay ?? "something"} is in its way`;
    case Outcome.NO_WAY:
      return "has given up: no way leads to its goal";
  }
  const blocker = plan.blocker && blockerName(plan.blocker, nameOf);
  switch (plan.reason) {
    case Reason.MOVING:
      return "moving along its path";
    case Reason.GIVING_WAY:
      return `giving way to ${blocker ?? "somebody"}`;
    case Reason.WAITING:
      return blocker === null ? "waiting" : `waiting for ${blocker}`;
    case Reason.REPLANNING:
      return "looking for another way";
    case Reason.NO_PATH:
      return "finds no way to its goal";
    case Reason.ARRIVED:
      return "has arrived";
    default:
      return "no reason given";
  }
}

/** How far the path reaches, while the actor follows one, and how many people it minds. */
export function outlookOf(plan: Plan): string {
  const people = plan.people.length === 1 ? "1 person near" : `${plan.people.length} people near`;
  if (plan.outcome !== null || plan.reason === Reason.ARRIVED) return people;
  const end = plan.path.at(-1);
  if (!end || plan.path.length < 2) return `no path, ${people}`;
  const [x, y, z, seconds] = end;
  const { goal } = plan;
  const leadsThere =
    goal !== null &&
    Math.hypot(x - goal[0], y - goal[1]) < AT_GOAL_M &&
    Math.abs(z - goal[2]) < SAME_FLOOR_M;
  return `${leadsThere ? "there in" : "path for"} ${seconds.toFixed(0)} s, ${people}`;
}

/** The number of people whom a guide leads, in words, and whether one is among them. */
export function followersOf({ followers }: PlanTour, ownId: number): string {
  const others = followers.filter((id) => id !== ownId).length;
  const people = others === 1 ? "1 person" : `${others} people`;
  if (others < followers.length) {
    return others === 0 ? "You are on this tour." : `You are on this tour, with ${people} more.`;
  }
  return others === 0 ? "Nobody is on this tour yet." : `${people} on this tour.`;
}

/** The name of a stop. */
export function stopOf({ stops }: PlanTour, stop: number): string {
  return stops[stop] || `Stop ${stop + 1}`;
}

function blockerName({ kind, id, door }: PlanBlocker, nameOf: NameOf): string {
  switch (kind) {
    case "person":
    case "actor":
      return (id === null ? null : nameOf(id)) ?? "somebody out of sight";
    case "door":
      return door === null ? "a door" : `the door “${door}”`;
    case "wall":
      return "a wall";
    case "route":
      return "a way that is still being found";
    default:
      return "something";
  }
}

function placeAt([x, y, z]: Place, places: readonly ScenePlace[]): string | null {
  let nearest: string | null = null;
  let nearestM = AT_PLACE_M;
  for (const { name, position, z_m: floorM } of places) {
    const apartM = Math.hypot(x - position[0], y - position[1]);
    if (apartM > nearestM || Math.abs(z - floorM) > SAME_FLOOR_M) continue;
    [nearest, nearestM] = [name, apartM];
  }
  return nearest;
}
