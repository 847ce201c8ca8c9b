/** The panel of the chosen actor: its behaviour, its goal and the reason for its last step. */

import type { Plan, SceneData } from "../net/messages";
import type { Avatar } from "../world/world";
import { byId } from "./dom";
import { behaviourOf, outlookOf, reasonOf } from "./planwords";

export class PlanPanel {
  private readonly title = byId("plan-title", HTMLElement);
  private readonly behaviour = byId("plan-behaviour", HTMLElement);
  private readonly reason = byId("plan-reason", HTMLElement);
  private readonly outlook = byId("plan-outlook", HTMLElement);

  update(
    name: string | null,
    plan: Plan | null,
    avatars: ReadonlyMap<number, Avatar>,
    scene: SceneData,
  ): void {
    set(this.title, name ?? "No actor chosen");
    if (!plan || name === null) {
      set(this.behaviour, name === null ? "Click an actor, or choose one under People." : "…");
      set(this.reason, "");
      set(this.outlook, "");
      return;
    }
    set(this.behaviour, behaviourOf(plan, scene.places));
    set(
      this.reason,
      reasonOf(plan, (id) => avatars.get(id)?.name ?? null),
    );
    set(this.outlook, outlookOf(plan));
  }
}

/** Write a text only when it changes, so that screen readers do not say the same again. */
function set(target: HTMLElement, text: string): void {
  if (target.textContent !== text) target.textContent = text;
}
