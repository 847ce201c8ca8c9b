/** Carries out what this person wants of others: find, follow, greet, mute, report. */

import type { Wording } from "../language/phrase";
import { words } from "../language/words";
import { Gesture } from "../net/codes";
import type { ClientMessage, EntityInfo } from "../net/messages";
import type { Place } from "../render/picking";
import { byId } from "../ui/dom";
import { PeopleList } from "../ui/people";
import { PersonPanel, type SaidLine } from "../ui/person";
import { whereIs } from "../ui/whereabouts";
import { write } from "../ui/writing";
import type { Avatar, World } from "../world/world";
import { Following } from "./following";
import { Mutes } from "./mutes";

export interface Company {
  send(message: ClientMessage): boolean;
  turnTo(id: number): void;
  /** Look into an actor. */
  choose(id: number): void;
  walkTo(place: Place): void;
  stand(): void;
  linesOf(id: number): SaidLine[];
  nameOf(id: number): string;
  /** Share a link to somebody. */
  share(name: string): void;
  /** Ask whether to follow somebody. */
  invite(name: string, accept: () => void): void;
}

export class Others {
  private readonly mutes = new Mutes(localStorage);
  private readonly card: PersonPanel;
  private readonly list: PeopleList;
  private readonly following: Following;
  private readonly bar = byId("following", HTMLElement);
  private readonly whom = byId("following-whom", HTMLElement);

  /** `linked` is the name of somebody whom a link wants to be followed. */
  constructor(
    private readonly company: Company,
    private linked: string | null,
  ) {
    this.following = new Following(
      (place) => {
        company.walkTo(place);
      },
      () => {
        company.stand();
      },
      (id) => {
        this.bar.hidden = id === null;
        if (id === null) return;
        const name = company.nameOf(id);
        write(this.whom, () => words.following.whom(name));
      },
    );
    byId("following-end", HTMLButtonElement).addEventListener("click", () => {
      this.follow(null);
    });
    this.card = new PersonPanel({
      find: (id) => {
        company.turnTo(id);
      },
      follow: (id) => {
        this.follow(id);
      },
      wave: (id) => {
        company.turnTo(id);
        company.send({ type: "gesture", gesture: Gesture.WAVE });
      },
      share: (name) => {
        company.share(name);
      },
      mute: (id, name, muted) => {
        this.mutes.set(name, muted);
        this.list.refresh();
        company.send({ type: "mute", id, muted });
      },
      report: (id, line, text) => company.send({ type: "report", id, line, text }),
      linesOf: (id) => company.linesOf(id),
      isMuted: (name) => this.mutes.has(name),
    });
    this.list = new PeopleList(
      (id) => {
        company.turnTo(id);
        company.choose(id);
      },
      (id, name) => {
        company.turnTo(id);
        this.card.open(id, name);
      },
      (name) => this.mutes.has(name),
      () => this.card.id,
    );
  }

  /** The one whose card is open, to be marked in the picture. */
  get openedId(): number | null {
    return this.card.id;
  }

  /** The one whom the person follows. */
  get followedId(): number | null {
    return this.following.id;
  }

  isMuted(name: string): boolean {
    return this.mutes.has(name);
  }

  /** Open the card of a person, or look into an actor, that was clicked. */
  open({ id, name, kind, own }: Avatar): void {
    if (kind === "actor") this.company.choose(id);
    else if (!own) this.card.open(id, name);
  }

  /** Walk after somebody, or stand where one is. */
  follow(id: number | null): void {
    if (id === null) this.company.stand();
    if (id === null) this.following.stop();
    else this.following.start(id);
  }

  /** The person walks on their own, or there is no way: follow nobody any more. */
  stopFollowing(): void {
    this.following.stop();
  }

  entered(entities: readonly EntityInfo[]): void {
    for (const { id, kind, name } of entities) {
      if (kind === "person" && this.mutes.has(name)) {
        this.company.send({ type: "mute", id, muted: true });
      }
      if (name === this.linked) {
        this.linked = null;
        this.company.invite(name, () => {
          this.follow(id);
        });
      }
    }
  }

  left(ids: readonly number[]): void {
    if (this.card.id !== null && ids.includes(this.card.id)) this.card.close();
  }

  /** The place is another one from now on. */
  begin(): void {
    this.following.stop();
    this.card.close();
  }

  census(people: number, actors: number): void {
    this.list.census(people, actors);
  }

  /** The server has taken a report, or says why not. */
  tell(wording: () => Wording): void {
    this.card.tell(wording);
  }

  frame(world: World, nowMs: number): void {
    this.following.frame(world, nowMs);
  }

  /** Draw list and card anew. */
  update(world: World, chosenId: number | null, cameraYaw: number): void {
    this.list.update(world.avatars, chosenId);
    const { id } = this.card;
    const other = id === null ? undefined : world.avatars.get(id);
    const here = world.own?.pose;
    if (!other || !here) return;
    this.card.show(() => whereIs(other, here, cameraYaw), this.following.id === id);
  }
}
