/** Words for what an actor does, where it goes, and who holds it. */

import type { Blocker, Outlook } from "../language/arguments";
import type { Wording } from "../language/phrase";
import { words } from "../language/words";
import { Outcome, Reason } from "../net/codes";
import type { Place, Plan, PlanBlocker, PlanTour, ScenePlace } from "../net/messages";

/** The name of somebody by the id; null for those whom this page does not know. */
export type NameOf = (id: number) => string | null;

/** A goal lies at a place if it is no further from it than this. */
const AT_PLACE_M = 3;
const SAME_FLOOR_M = 1.5;
/** A path that ends no further from the goal than this leads all the way. */
const AT_GOAL_M = 0.6;

/** The behaviour of an actor, and the place that it goes to. */
export function behaviourOf(plan: Plan, places: readonly ScenePlace[]): Wording {
  const place = plan.goal && plan.outcome === null ? placeAt(plan.goal, places) : null;
  const { behaviours, unknown } = words.plan;
  const { behaviour } = plan;
  return isKnown(behaviour) ? behaviours[behaviour](place) : unknown(behaviour, place);
}

/** Why an actor does what it does, or how its trip ended, with the name of who holds it. */
export function reasonOf(plan: Plan, nameOf: NameOf): Wording {
  const sentences = words.plan;
  const inTheWay = blockerOf(plan.in_the_way, nameOf);
  switch (plan.outcome) {
    case Outcome.NEAR:
      return sentences.asNear(inTheWay ?? { kind: "somebody" });
    case Outcome.BLOCKED:
      return sentences.blocked(inTheWay ?? { kind: "something" });
    case Outcome.NO_WAY:
      return sentences.noWay;
  }
  const blocker = blockerOf(plan.blocker, nameOf);
  switch (plan.reason) {
    case Reason.MOVING:
      return sentences.moving;
    case Reason.GIVING_WAY:
      return sentences.givingWay(blocker ?? { kind: "somebody" });
    case Reason.WAITING:
      return blocker === null ? sentences.waiting : sentences.waitingFor(blocker);
    case Reason.REPLANNING:
      return sentences.replanning;
    case Reason.NO_PATH:
      return sentences.noPath;
    case Reason.ARRIVED:
      return sentences.arrived;
    default:
      return sentences.noReason;
  }
}

/** How far the path reaches, while the actor follows one, and how many people it minds. */
export function outlookOf(plan: Plan): Wording {
  return words.plan.outlook(reachOf(plan), plan.people.length);
}

function reachOf({ outcome, reason, path, goal }: Plan): Outlook {
  if (outcome !== null || reason === Reason.ARRIVED) return { path: "over" };
  const end = path.at(-1);
  if (!end || path.length < 2) return { path: "none" };
  const [x, y, z, seconds] = end;
  const leadsThere =
    goal !== null &&
    Math.hypot(x - goal[0], y - goal[1]) < AT_GOAL_M &&
    Math.abs(z - goal[2]) < SAME_FLOOR_M;
  return { path: leadsThere ? "toGoal" : "part", seconds };
}

/** The number of people whom a guide leads, in words, and whether one is among them. */
export function followersOf({ followers }: PlanTour, ownId: number): Wording {
  const others = followers.filter((id) => id !== ownId).length;
  return others < followers.length ? words.plan.led(others) : words.plan.others(others);
}

/** The name of a stop, as whoever made the scene wrote it. */
export function stopOf({ stops }: PlanTour, stop: number): Wording {
  return stops[stop] || words.plan.stop(stop + 1);
}

function isKnown(behaviour: string): behaviour is keyof typeof words.plan.behaviours {
  return Object.hasOwn(words.plan.behaviours, behaviour);
}

function blockerOf(blocker: PlanBlocker | null, nameOf: NameOf): Blocker | null {
  if (blocker === null) return null;
  const { kind, id, door } = blocker;
  switch (kind) {
    case "person":
    case "actor": {
      const name = id === null ? null : nameOf(id);
      return name === null ? { kind: "unseen" } : { kind: "named", name };
    }
    case "door":
      return door === null ? { kind: "unnamedDoor" } : { kind: "door", name: door };
    case "wall":
    case "route":
      return { kind };
    default:
      return { kind: "something" };
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
