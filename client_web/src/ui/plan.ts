/** The panel of the chosen actor: its behaviour, its goal, its reason, and the tour of a guide. */

import type { PlanTour } from "../net/messages";
import type { World } from "../world/world";
import { byId, element } from "./dom";
import { behaviourOf, followersOf, outlookOf, reasonOf, stopOf } from "./planwords";

export class PlanPanel {
  private readonly title = byId("plan-title", HTMLElement);
  private readonly behaviour = byId("plan-behaviour", HTMLElement);
  private readonly reason = byId("plan-reason", HTMLElement);
  private readonly outlook = byId("plan-outlook", HTMLElement);
  private readonly tour = byId("plan-tour", HTMLElement);
  private readonly stops = byId("plan-stops", HTMLOListElement);
  private readonly followers = byId("plan-followers", HTMLElement);
  private readonly follow = byId("plan-follow", HTMLButtonElement);
  private shownStops = "";

  /** `follow` is called with whether the chosen actor is to be followed. */
  constructor(follow: (wanted: boolean) => void) {
    this.follow.addEventListener("click", () => {
      follow(this.follow.getAttribute("aria-pressed") !== "true");
    });
  }

  /** Show the actor of that name, which the person follows or does not. */
  update(name: string | null, world: World, followed: boolean): void {
    const { plan, avatars, scene } = world;
    set(this.title, name ?? "No actor chosen");
    this.follow.hidden = name === null;
    this.show(plan?.tour ?? null, world.ownId, followed);
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

  private show(tour: PlanTour | null, ownId: number, followed: boolean): void {
    const [join, leave] = tour ? ["Join the tour", "Leave the tour"] : ["Follow", "Follow no more"];
    set(this.follow, followed ? leave : join);
    this.follow.setAttribute("aria-pressed", String(followed));
    this.tour.hidden = tour === null;
    if (!tour) return;
    set(this.followers, followersOf(tour, ownId));
    const shown = JSON.stringify([tour.stops, tour.next]);
    if (shown === this.shownStops) return;
    this.shownStops = shown;
    const items = tour.stops.map((_, stop) => {
      const current = stop === tour.next && "step";
      return element("li", { "aria-current": current }, stopOf(tour, stop));
    });
    this.stops.replaceChildren(...items);
    const current = items[tour.next];
    if (current) this.stops.scrollTop = current.offsetTop - this.stops.offsetTop;
  }
}

/** Write a text only when it changes, so that screen readers do not say the same again. */
function set(target: HTMLElement, text: string): void {
  if (target.textContent !== text) target.textContent = text;
}
