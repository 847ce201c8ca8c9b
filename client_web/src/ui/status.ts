/** The state of the connection: a chip at the top, and a banner while it is being restored. */

import type { ConnectionState } from "../net/connection";
import { words } from "../language/words";
import { byId } from "./dom";
import { endingOf } from "./sentences";
import { write } from "./writing";

export class StatusChip {
  private readonly chip = byId("status", HTMLElement);
  private readonly text = byId("status-text", HTMLElement);
  private readonly delay = byId("status-delay", HTMLElement);
  private readonly banner = byId("banner", HTMLElement);

  show(state: ConnectionState): void {
    this.chip.dataset.phase = state.phase;
    write(this.text, () => words.status[state.phase]);
    this.banner.hidden = state.phase !== "reconnecting";
    if (state.phase === "reconnecting") {
      write(this.banner, () => words.status.comingBack(endingOf(state.ending)));
    }
    if (state.phase !== "live") this.roundTrip(null);
  }

  roundTrip(seconds: number | null): void {
    write(this.delay, () => (seconds === null ? "" : words.status.roundTrip(1000 * seconds)));
  }
}
