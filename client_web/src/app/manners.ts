/** Tells the server of the person's gestures, and whether they are at the page at all. */

import { listenToGestureKeys } from "../input/gesturekeys";
import { isSpoken } from "../net/codec";
import { GESTURE_NAMES } from "../net/codes";
import type { ClientMessage, Welcome } from "../net/messages";
import { GestureMenu } from "../ui/gestures";
import type { World } from "../world/world";
import type { Picture } from "./picture";
import { Presence } from "./presence";

export class Manners {
  private readonly menu: GestureMenu;
  private readonly presence: Presence;

  /** `calm` is for those who want little motion; surroundings are told on request, by a key. */
  constructor(
    private readonly send: (message: ClientMessage) => boolean,
    private readonly calm: boolean,
    tellSurroundings: () => void,
  ) {
    this.menu = new GestureMenu(GESTURE_NAMES, (gesture) => {
      send({ type: "gesture", gesture });
    });
    listenToGestureKeys(
      window,
      (gesture) => {
        if (GESTURE_NAMES.has(gesture)) send({ type: "gesture", gesture });
      },
      () => {
        this.menu.flip();
      },
      tellSurroundings,
    );
    this.presence = new Presence(document, (away) => {
      send({ type: "presence", away });
    });
  }

  /** The connection is live: whoever comes in counts as there. */
  begin({ version }: Welcome): void {
    this.menu.offer(isSpoken("gesture", version));
    if (this.presence.away) this.send({ type: "presence", away: true });
  }

  /** Somebody in view makes a gesture; of those that are not known yet nothing is to be seen. */
  show(id: number, gesture: number, world: World, view: Picture): void {
    const [name, avatar] = [GESTURE_NAMES.get(gesture), world.avatars.get(id)];
    if (name === undefined || !avatar) return;
    world.gesture(id, name, this.calm);
    view.say(avatar, this.menu.tell(avatar.name, avatar.own, name));
  }
}
