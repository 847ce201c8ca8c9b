/** Keys of the map: they move it, zoom it, and choose on it. */

import type { MapView } from "./views";

const PAN_PX = 60;
const ZOOM = 1.3;

export interface KeyActs {
  /** Show all of the map. */
  fit: () => void;
  /** Choose whoever is nearest to the middle, or give the middle as a place that is asked for. */
  choose: () => void;
  chooseAll: () => void;
  /** The map was moved by hand. */
  moved: () => void;
}

export function pressed(event: KeyboardEvent, view: MapView, acts: KeyActs): void {
  const pan = (dx: number, dy: number) => (): void => {
    acts.moved();
    view.panPx(dx * PAN_PX, dy * PAN_PX);
  };
  const keys: Record<string, () => void> = {
    ArrowLeft: pan(1, 0),
    ArrowRight: pan(-1, 0),
    ArrowUp: pan(0, 1),
    ArrowDown: pan(0, -1),
    "+": () => {
      view.zoom(ZOOM);
    },
    "-": () => {
      view.zoom(1 / ZOOM);
    },
    "0": acts.fit,
    Enter: acts.choose,
    a: () => {
      if (event.ctrlKey) acts.chooseAll();
    },
  };
  const act = keys[event.key];
  if (!act || event.altKey || (event.ctrlKey && event.key !== "a")) return;
  event.preventDefault();
  event.stopPropagation();
  act();
}
