/** The panel of the chosen actor: its behaviour, its goal, its reason, and the tour of a guide. */

import { name as named } from "../language/phrase";
import { words } from "../language/words";
import type { PlanTour } from "../net/messages";
import type { World } from "../world/world";
import { byId, element } from "./dom";
import { behaviourOf, followersOf, outlookOf, reasonOf, stopOf } from "./planwords";
import { write } from "./writing";

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
    write(this.title, () => (name === null ? words.plan.none : [named(name)]));
    this.follow.hidden = name === null;
    this.show(plan?.tour ?? null, world.ownId, followed);
    if (!plan || name === null) {
      write(this.behaviour, () => (name === null ? words.plan.choose : words.plan.awaited));
      write(this.reason, () => "");
      write(this.outlook, () => "");
      return;
    }
    write(this.behaviour, () => behaviourOf(plan, scene.places));
    write(this.reason, () => reasonOf(plan, (id) => avatars.get(id)?.name ?? null));
    write(this.outlook, () => outlookOf(plan));
  }

  private show(tour: PlanTour | null, ownId: number, followed: boolean): void {
    write(this.follow, () => {
      const { follow, followNoMore, joinTour, leaveTour } = words.plan;
      if (followed) return tour ? leaveTour : followNoMore;
      return tour ? joinTour : follow;
    });
    this.follow.setAttribute("aria-pressed", String(followed));
    this.tour.hidden = tour === null;
    if (!tour) return;
    write(this.followers, () => followersOf(tour, ownId));
    const shown = JSON.stringify([tour.stops, tour.next]);
    if (shown === this.shownStops) return;
    this.shownStops = shown;
    const items = tour.stops.map((_, stop) => {
      const current = stop === tour.next && "step";
      const item = element("li", { "aria-current": current, dir: "auto" });
      write(item, () => stopOf(tour, stop));
      return item;
    });
    this.stops.replaceChildren(...items);
    const current = items[tour.next];
    if (current) this.stops.scrollTop = current.offsetTop - this.stops.offsetTop;
  }
}
