/** Puts the parts of the page together. */

import { readAddress } from "./app/address";
import { offerInspection } from "./app/inspection";
import { Session } from "./app/session";
import { MapView } from "./app/mapview";
import type { Picture } from "./app/picture";
import { View } from "./app/view";
import { listenToPointer } from "./input/pointer";
import { speak } from "./language/words";
import { socketAddress } from "./net/address";
import { Seats } from "./net/seats";
import { browserLocks, channelLocks } from "./net/tablocks";
import { drawsDepth } from "./render/hardware";
import { byId } from "./ui/dom";
import { setUpHelp, storedChoice } from "./ui/help";
import { preferredLanguage, setUpLanguageMenus } from "./ui/languagemenu";
import { writePage } from "./ui/writing";

await speak(preferredLanguage());
writePage();
setUpLanguageMenus();

const picture = byId("picture", HTMLCanvasElement);
const calm = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
const isFlat = !drawsDepth();
const view: Picture = isFlat
  ? new MapView(picture)
  : new View(picture, byId("labels", HTMLElement), storedChoice(), calm);
document.body.classList.toggle("flat", isFlat);
byId("join-picture", HTMLElement).hidden = !isFlat;

const locks =
  browserLocks(navigator.locks) ??
  channelLocks(
    new BroadcastChannel("esplanade.seats"),
    crypto.getRandomValues(new Uint32Array(3)).join("-"),
  );
const seats = new Seats(sessionStorage, localStorage, locks, Date.now);
const { rest, zone, ...wish } = readAddress(location.hash);
// Secrets are kept in memory alone: not where others read over a shoulder, nor in the history.
if (wish.operator !== null || wish.admission !== null) {
  history.replaceState(history.state, "", location.pathname + location.search + rest);
}
const session = new Session(view, seats, socketAddress(document.baseURI, zone), calm, wish);

listenToPointer(picture, {
  orbit: (yaw, pitch) => {
    view.camera.orbit(yaw, pitch);
  },
  zoom: (factor) => {
    view.camera.zoom(factor);
  },
  tap: (at) => {
    session.tap(at);
  },
});
setUpHelp(
  (choice) => {
    view.choose(choice);
  },
  (shown) => {
    view.skeletons.show(shown);
  },
);
// A button that was clicked gives the keys back to walking and talking.
document.addEventListener("click", (event) => {
  const button = event.target instanceof Element ? event.target.closest("button") : null;
  if (event.detail > 0 && button && !button.closest("dialog, form")) button.blur();
});
const hurry = (): void => {
  session.connection.hurry();
};
window.addEventListener("online", hurry);
window.addEventListener("offline", () => {
  session.connection.doubt();
});
document.addEventListener("visibilitychange", hurry);
window.addEventListener("pagehide", () => {
  seats.touch();
});
offerInspection(session, view);
await session.start();
