/** The list of people and actors in view, and how many the whole world holds. */

import type { Avatar } from "../world/world";
import { byId, element } from "./dom";

export class PeopleList {
  private readonly list = byId("people-list", HTMLElement);
  private readonly total = byId("people-total", HTMLElement);
  private readonly count = byId("people-count", HTMLElement);
  private shown = "";

  constructor(private readonly choose: (id: number) => void) {}

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
    const text = own ? "you" : kind;
    const row = element("li", { class: own ? "own" : kind });
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
    } else {
      row.append(element("span", {}, name), element("small", {}, text));
    }
    return row;
  }
}

function byPlaceInList(a: Avatar, b: Avatar): number {
  const group = ({ own, kind }: Avatar): number => (own ? 0 : kind === "person" ? 1 : 2);
  return group(a) - group(b) || a.name.localeCompare(b.name, undefined, { numeric: true });
}

function plural(count: number, one: string, many: string): string {
  return `${count} ${count === 1 ? one : many}`;
}
