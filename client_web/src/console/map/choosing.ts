/** The choice of actors and people by a click on the map, or by a region drawn on it. */

import type { AppContext } from "../context";
import type { Painter } from "./painter";
import { isWithin, nearest, type Pixel } from "./picking";
import type { MapView } from "./views";

const CLICK_PX = 14;

export class Choosing {
  constructor(
    private readonly app: () => AppContext,
    private readonly view: MapView,
    private readonly painter: () => Painter | null,
  ) {}

  /** Choose who is there, beside those who are chosen if it `adds`; or give a place asked for. */
  click(at: Pixel, adds: boolean): void {
    const app = this.app();
    const world = this.view.toWorld(...at);
    const picking = app.state.picking.value;
    if (picking) {
      const floor = world ? (this.painter()?.map?.storeys[world.storey]?.z_m ?? 0) : 0;
      if (world) picking.take([world.x, world.y, floor]);
      return;
    }
    const key = this.keyAt(at);
    const { chosen } = app.state;
    if (key === null) {
      if (!adds) app.choose(null);
    } else if (!adds) {
      app.choose(key);
    } else {
      const without = chosen.value.filter((other) => other !== key);
      app.choose(without.length < chosen.value.length ? without : [...chosen.value, key]);
    }
  }

  /** Choose everybody in a region. */
  within(ring: readonly Pixel[], adds: boolean): void {
    const app = this.app();
    const drawn = this.painter()?.drawn ?? [];
    const found = drawn
      .filter(({ px, py }) => isWithin([px, py], ring))
      .map(({ avatar }) => avatar.key);
    const before = adds ? app.state.chosen.value : [];
    app.choose([...new Set([...before, ...found])]);
  }

  /** The one who is drawn nearest to a point of the canvas; null if nobody is that near. */
  keyAt(at: Pixel, withinPx = CLICK_PX): string | null {
    const drawn = this.painter()?.drawn ?? [];
    const index = nearest(
      drawn.map(({ px, py }) => [px, py]),
      at,
      withinPx,
    );
    return index === null ? null : (drawn[index]?.avatar.key ?? null);
  }

  /** The name of whoever is under the pointer, if anybody is. */
  nameAt(at: Pixel | null): string {
    const key = at && this.keyAt(at);
    return key ? (this.app().avatars.get(key)?.name ?? "") : "";
  }
}
