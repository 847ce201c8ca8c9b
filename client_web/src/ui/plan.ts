/** The panel of the chosen actor: its behaviour, its goal and the reason for its last step. */

import { Outcome, Reason } from "../net/codes";
import type { Plan } from "../net/messages";
import { byId } from "./dom";

const REASONS: Record<number, string> = {
  [Reason.NONE]: "no reason given",
  [Reason.MOVING]: "moving along its path",
  [Reason.GIVING_WAY]: "giving way to somebody",
  [Reason.WAITING]: "waiting",
  [Reason.REPLANNING]: "looking for another way",
  [Reason.NO_PATH]: "finds no way to its goal",
  [Reason.ARRIVED]: "has arrived",
};

/** Of trips that did not end at the goal; the others are told by the reason. */
const OUTCOMES: Record<number, string> = {
  [Outcome.NEAR]: "is as near to its goal as it gets: somebody is there",
  [Outcome.BLOCKED]: "has given up: somebody stands in its way",
  [Outcome.NO_WAY]: "has given up: no way leads to its goal",
};

const BEHAVIOURS: Record<string, string> = {
  go_to: "goes to a place",
  wander: "wanders between places",
  patrol: "patrols its round",
  guide: "guides a tour",
  idle: "has nothing to do",
};

export function reasonText(reason: number): string {
  return REASONS[reason] ?? "no reason given";
}

export class PlanPanel {
  private readonly title = byId("plan-title", HTMLElement);
  private readonly behaviour = byId("plan-behaviour", HTMLElement);
  private readonly reason = byId("plan-reason", HTMLElement);
  private readonly outlook = byId("plan-outlook", HTMLElement);

  update(name: string | null, plan: Plan | null): void {
    set(this.title, name ?? "No actor chosen");
    if (!plan || name === null) {
      set(this.behaviour, name === null ? "Click an actor, or choose one under People." : "…");
      set(this.reason, "");
      set(this.outlook, "");
      return;
    }
    set(this.behaviour, BEHAVIOURS[plan.behaviour] ?? plan.behaviour);
    set(this.reason, OUTCOMES[plan.outcome ?? 0] ?? reasonText(plan.reason));
    const seconds = plan.path.at(-1)?.[3] ?? 0;
    const path = plan.path.length > 1 ? `Path for ${seconds.toFixed(0)} s` : "No path";
    const people = plan.people.length === 1 ? "1 person" : `${plan.people.length} people`;
    set(this.outlook, `${path}, ${people} near`);
  }
}

/** Write a text only when it changes, so that screen readers do not say the same again. */
function set(target: HTMLElement, text: string): void {
  if (target.textContent !== text) target.textContent = text;
}
