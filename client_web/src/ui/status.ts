/** The state of the connection: a chip at the top, and a banner while it is being restored. */

import type { ConnectionState } from "../net/connection";
import { byId } from "./dom";

const TEXTS: Record<ConnectionState["phase"], string> = {
  idle: "Not connected",
  connecting: "Connecting…",
  live: "Connected",
  reconnecting: "Reconnecting…",
  refused: "Outside",
};

export class StatusChip {
  private readonly chip = byId("status", HTMLElement);
  private readonly text = byId("status-text", HTMLElement);
  private readonly delay = byId("status-delay", HTMLElement);
  private readonly banner = byId("banner", HTMLElement);

  show(state: ConnectionState): void {
    this.chip.dataset.phase = state.phase;
    this.text.textContent = TEXTS[state.phase];
    this.banner.hidden = state.phase !== "reconnecting";
    if (state.phase === "reconnecting") {
      this.banner.textContent = `${state.text} Coming back by itself…`;
    }
    if (state.phase !== "live") this.delay.textContent = "";
  }

  roundTrip(seconds: number | null): void {
    this.delay.textContent = seconds === null ? "" : `${Math.round(seconds * 1000)} ms`;
  }
}
