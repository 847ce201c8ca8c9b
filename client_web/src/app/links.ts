/** Links: the first view and the offer to go where one leads, and links to share. */

import type { SceneData } from "../net/messages";
import type { Place } from "../render/picking";
import { words } from "../language/words";
import { byId } from "../ui/dom";
import { Invitation } from "../ui/invitation";
import { ShareBar } from "../ui/share";
import type { World } from "../world/world";
import { type AddressWish, linkToPerson, linkToPlace } from "./address";
import type { Picture } from "./picture";

/** The name of a zone that has copies: there a link has to say which of them is meant. */
function copyOf({ zone, copy }: SceneData): string | null {
  return copy === undefined ? null : (zone ?? null);
}

export class Links {
  private readonly invitation = new Invitation();
  private readonly bar = new ShareBar();
  /** Whether the camera was turned for this world; a connection that comes back turns nothing. */
  private hasLooked = false;
  /** A place that a link names; null once the view was turned to it. */
  private at: Place | null;
  /** The direction of the first view that a link names; null once the view was turned. */
  private lookYaw: number | null;

  constructor(
    private readonly view: Picture,
    wish: Pick<AddressWish, "at" | "lookYaw">,
    private readonly walkTo: (place: Place) => void,
  ) {
    this.at = wish.at;
    this.lookYaw = wish.lookYaw;
  }

  /** The button shares the place where the own avatar is, and what is seen from there. */
  offer(world: () => World | null): void {
    byId("share", HTMLButtonElement).addEventListener("click", () => {
      const here = world();
      const place = here?.own?.pose;
      if (!here || !place) return;
      const { yaw } = this.view.camera;
      void this.bar.show(linkToPlace(location.href, place, yaw, copyOf(here.scene)));
    });
  }

  sharePerson(name: string, world: World | null): void {
    const zone = world && copyOf(world.scene);
    void this.bar.show(linkToPerson(location.href, name, zone));
  }

  /** Ask whether to follow somebody who is here. */
  inviteTo(name: string, follow: () => void): void {
    this.invitation.open(
      () => words.links.toPerson(name),
      () => words.links.follow,
      follow,
    );
  }

  /** The world is a new one: the next frame turns the camera. */
  begin(): void {
    this.hasLooked = false;
  }

  /** The person has left: nothing is asked any more. */
  end(): void {
    this.invitation.close();
  }

  /** Turn the camera once the own avatar is there, and ask whether to walk to a place. */
  look(world: World): void {
    const { own } = world;
    if (this.hasLooked || !own) return;
    this.hasLooked = true;
    const { at, lookYaw, view } = this;
    if (at) {
      view.camera.yaw = Math.atan2(at.y - own.pose.y, at.x - own.pose.x);
      this.invitation.open(
        () => words.links.toPlace,
        () => words.links.walk,
        () => {
          this.walkTo(at);
        },
      );
    } else if (lookYaw === null) view.lookAround(world);
    if (lookYaw !== null) view.camera.yaw = lookYaw;
    this.at = this.lookYaw = null;
  }
}
