/** A panel on the connection itself: who is logged in, and what comes in. */

import { html, type TemplateResult } from "lit";
import type { LiveMessage } from "../net/live";
import { Panel } from "./panel";

interface Figures extends LiveMessage {
  tick: number;
}

class ConnectionPanel extends Panel {
  private tick: number | null = null;

  protected override begin(): void {
    this.watch(this.app.state.me);
    this.watch(this.app.live.phase);
    this.hear("series", {}, (message: Figures) => {
      this.tick = message.tick;
      this.requestUpdate();
    });
  }

  protected override render(): TemplateResult {
    const me = this.app.state.me.value;
    const phase = { off: "off", connecting: "connecting", on: "connected" };
    return html`
      <dl>
        <dt>Account</dt>
        <dd>${me ? `${me.account}, ${me.role}` : "nobody"}</dd>
        <dt>Live data</dt>
        <dd>${phase[this.app.live.phase.value]}</dd>
        <dt>Tick</dt>
        <dd>${this.tick ?? "not told yet"}</dd>
      </dl>
      <button @click=${() => void this.attempt(this.app.api.get("/world"))}>Ask the server</button>
    `;
  }
}

customElements.define("esp-connection", ConnectionPanel);
