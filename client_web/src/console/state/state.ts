/** The state that the parts of the page share. */

import type { Me, World, Zones } from "../net/types";
import type { Overlay } from "./overlays";
import type { Picking } from "./picking";
import { Signal } from "./signal";

/** Values of a form that nobody has sent yet. */
export interface Draft {
  scope: string;
  values: Readonly<Record<string, unknown>>;
}

export class State {
  readonly me = new Signal<Me | null>(null);
  readonly world = new Signal<World | null>(null);
  readonly zones = new Signal<Zones | null>(null);
  /** Ids of actors (`main/actor-1`), or of people (`person:12`); the first one is inspected. */
  readonly chosen = new Signal<readonly string[]>([]);
  /** A moment under the pointer in one panel, which the others show too; microseconds since 1970. */
  readonly hovered = new Signal<number | null>(null);
  /** The moment that all panels look at; null is now. */
  readonly moment = new Signal<number | null>(null);
  readonly draft = new Signal<Draft | null>(null);
  /** A place that the map shall show. */
  readonly lookAt = new Signal<readonly [number, number, number] | null>(null);
  /** The drawing that a panel wants on the map; clicks there are its places meanwhile. */
  readonly picking = new Signal<Picking | null>(null);
  readonly revision = new Signal(0);
  /** Drawn on the map, by the name of who drew it. */
  readonly overlays = new Signal<ReadonlyMap<string, Overlay>>(new Map());
  /** Whether the map goes where the first chosen one goes. */
  readonly following = new Signal(false);

  /** Draw something on the map, or take it away again with null. */
  overlay(name: string, overlay: Overlay | null): void {
    const next = new Map(this.overlays.value);
    if (overlay) next.set(name, overlay);
    else if (!next.delete(name)) return;
    this.overlays.value = next;
  }

  may(right: string): boolean {
    return this.me.value?.rights.some((held) => held === right) ?? false;
  }
}
