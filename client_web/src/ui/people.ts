/** The list of people and actors in view, and how many the whole world holds. */

import { byName } from "../world/ordering";
import type { Avatar } from "../world/world";
import { byId, element } from "./dom";

export class PeopleList {
  private readonly list = byId("people-list", HTMLElement);
  private readonly total = byId("people-total", HTMLElement);
  private readonly count = byId("people-count", HTMLElement);
  private shown = "";

  constructor(
    private readonly choose: (id: number) => void,
    private readonly open: (id: number, name: string) => void,
    private readonly isMuted: (name: string) => boolean,
  ) {}

  /** Draw the list anew, though nobody came or went. */
  refresh(): void {
    this.shown = "";
  }

  census(people: number, actors: number): void {
    this.total.textContent = `${plural(people, "person", "people")} and ${plural(actors, "actor", "actors")} in the world`;
  }

  /** Costs little when nobody came or went. */
  update(avatars: ReadonlyMap<number, Avatar>, chosenId: number | null): void {
    const key = `${[...avatars.keys()].join()}:${chosenId ?? ""}`;
    if (key === this.shown) return;
    this.shown = key;
    const focused = document.activeElement?.getAttribute("data-id");
    this.count.textContent = String(avatars.size);
    const sorted = [...avatars.values()].sort(byPlaceInList);
    this.list.replaceChildren(...sorted.map((avatar) => this.row(avatar, chosenId)));
    if (focused) this.list.querySelector<HTMLElement>(`[data-id="${focused}"]`)?.focus();
  }

  private row({ id, kind, name, own }: Avatar, chosenId: number | null): HTMLElement {
    const muted = !own && this.isMuted(name);
    const row = element("li", { class: own ? "own" : muted ? `${kind} muted` : kind });
    if (kind === "actor") {
      const button = element(
        "button",
        { type: "button", "data-id": String(id), "aria-pressed": String(id === chosenId) },
        element("span", {}, name),
        element("small", {}, "show plan"),
      );
      button.addEventListener("click", () => {
        this.choose(id);
      });
      row.append(button);
    } else if (own) {
      row.append(element("span", {}, name), element("small", {}, "you"));
    } else {
      const button = element("input", {
        type: "button",
        "data-id": String(id),
        value: muted ? "muted" : "mute, report",
        "aria-label": `${name}: mute or report`,
      });
      button.addEventListener("click", () => {
        this.open(id, name);
      });
      row.append(element("span", {}, name), button);
    }
    return row;
  }
}

function byPlaceInList(a: Avatar, b: Avatar): number {
  const group = ({ own, kind }: Avatar): number => (own ? 0 : kind === "person" ? 1 : 2);
  return group(a) - group(b) || byName(a.name, b.name);
}

function plural(count: number, one: string, many: string): string {
  return `${count} ${count === 1 ? one : many}`;
}
