/** The list of people and actors in view, and how many the whole world holds. */

import { words } from "../language/words";
import { byName } from "../world/ordering";
import type { Avatar } from "../world/world";
import { byId, element } from "./dom";
import { write } from "./writing";

export class PeopleList {
  private readonly list = byId("people-list", HTMLElement);
  private readonly find = byId("people-find", HTMLInputElement);
  private readonly total = byId("people-total", HTMLElement);
  private readonly count = byId("people-count", HTMLElement);
  private readonly groups = { person: group("people"), actor: group("actors") };
  private shown = "";

  constructor(
    private readonly choose: (id: number) => void,
    private readonly open: (id: number, name: string) => void,
    private readonly isMuted: (name: string) => boolean,
    private readonly openedId: () => number | null,
  ) {
    this.list.append(this.groups.person.details, this.groups.actor.details);
    this.find.addEventListener("input", () => {
      this.refresh();
    });
  }

  /** Draw the list anew, though nobody came or went. */
  refresh(): void {
    this.shown = "";
  }

  census(people: number, actors: number): void {
    write(this.total, () => words.people.inWorld(people, actors));
  }

  /** Costs little when nobody came or went. */
  update(avatars: ReadonlyMap<number, Avatar>, chosenId: number | null): void {
    const away = [...avatars.values()].filter((avatar) => avatar.away).map(({ id }) => id);
    const key = [[...avatars.keys()], away, [chosenId, this.openedId()]].join(";");
    if (key === this.shown) return;
    this.shown = key;
    const focused = document.activeElement?.getAttribute("data-id");
    this.count.textContent = String(avatars.size);
    const wanted = this.find.value.trim().toLocaleLowerCase();
    const found = [...avatars.values()]
      .filter(({ name }) => name.toLocaleLowerCase().includes(wanted))
      .sort(byPlaceInList);
    for (const kind of ["person", "actor"] as const) {
      const { details, count, rows } = this.groups[kind];
      const ofKind = found.filter((avatar) => avatar.kind === kind);
      details.hidden = ofKind.length === 0;
      count.textContent = String(ofKind.length);
      rows.replaceChildren(...ofKind.map((avatar) => this.row(avatar, chosenId)));
    }
    if (focused) this.list.querySelector<HTMLElement>(`[data-id="${focused}"]`)?.focus();
  }

  private row({ id, kind, name, own, away }: Avatar, chosenId: number | null): HTMLElement {
    const muted = !own && this.isMuted(name);
    const row = element("li", { class: own ? "own" : muted ? `${kind} muted` : kind });
    if (kind === "actor") {
      const button = element(
        "button",
        { type: "button", "data-id": String(id), "aria-pressed": String(id === chosenId) },
        called(name),
        remark(() => words.people.showPlan),
      );
      button.addEventListener("click", () => {
        this.choose(id);
      });
      row.append(button);
    } else if (own) {
      row.append(
        called(name),
        remark(() => words.people.you),
      );
    } else {
      const button = element(
        "button",
        { type: "button", "data-id": String(id), "aria-pressed": String(id === this.openedId()) },
        called(name),
        remark(() => stateOf(away, muted)),
      );
      button.addEventListener("click", () => {
        this.open(id, name);
      });
      row.append(button);
    }
    return row;
  }
}

interface Group {
  details: HTMLDetailsElement;
  count: HTMLElement;
  rows: HTMLUListElement;
}

/** A part of the list that one can close, so that it hides no other. */
function group(title: "people" | "actors"): Group {
  const count = element("span", { class: "count" });
  const rows = element("ul");
  const label = element("span");
  write(label, () => words.people[title]);
  const summary = element("summary", {}, label, " ", count);
  return { details: element("details", { open: true }, summary, rows), count, rows };
}

/** The own avatar first, then by name. */
function byPlaceInList(a: Avatar, b: Avatar): number {
  return Number(b.own) - Number(a.own) || byName(a.name, b.name);
}

function called(name: string): HTMLElement {
  return element("span", { dir: "auto" }, name);
}

function remark(source: () => string): HTMLElement {
  const made = element("small");
  write(made, source);
  return made;
}

function stateOf(away: boolean, muted: boolean): string {
  if (away && muted) return words.people.awayAndMuted;
  return away ? words.people.away : muted ? words.people.muted : "";
}
