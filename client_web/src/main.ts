/** Puts the parts of the page together. */

import { offerInspection } from "./app/inspection";
import { Session } from "./app/session";
import { View } from "./app/view";
import { listenToPointer } from "./input/pointer";
import { browserLocks, Seats } from "./net/seats";
import { byId } from "./ui/dom";
import { setUpHelp, storedChoice } from "./ui/help";

const picture = byId("picture", HTMLCanvasElement);
const calm = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
const view = new View(picture, byId("labels", HTMLElement), storedChoice(), calm);

const seats = new Seats(sessionStorage, localStorage, browserLocks(navigator.locks), Date.now);
const socketUrl = new URL("ws", document.baseURI);
socketUrl.protocol = socketUrl.protocol === "https:" ? "wss:" : "ws:";
// The key stands behind the #, so that it is in no request and no server's log.
const operator = new URLSearchParams(location.hash.slice(1)).get("operator");
const session = new Session(view, seats, socketUrl.href, operator);

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
document.addEventListener("visibilitychange", hurry);
window.addEventListener("pagehide", () => {
  seats.touch();
});
offerInspection(session, view);
await session.start();
