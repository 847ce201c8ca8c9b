/** Events of the world, by kind and by who; a click looks at the place on the map. */

import { css, html, nothing, type TemplateResult } from "lit";
import { chosenBy, EventList, type WorldEvent } from "../models/eventlist";
import { labelOf } from "../models/fields";
import { clock } from "../models/times";
import type { LiveMessage } from "../net/live";
import { CommandingPanel } from "./commanding";
import { searchField } from "./fields";

class EventsPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      .kinds {
        gap: 4px;
        margin: 6px 0;
      }
      .kinds button {
        padding: 0 8px;
        min-height: 24px;
        font-size: 0.9em;
      }
      li {
        display: grid;
        grid-template-columns: auto 1fr auto;
        gap: 8px;
        align-items: baseline;
        padding: 2px 0;
        border-bottom: 1px solid var(--line);
      }
      li > span {
        overflow-wrap: anywhere;
        min-width: 0;
      }
      time {
        font-variant-numeric: tabular-nums;
      }
    `,
  ];
  private readonly events = new EventList();
  private kinds = new Set<string>();
  private who = "";
  private isHeld = false;
  private held: WorldEvent[] = [];

  protected override begin(): void {
    void this.load();
    this.hear("events", {}, (message: LiveMessage & { events: readonly WorldEvent[] }) => {
      this.events.add(message.events);
      if (!this.isHeld) this.requestUpdate();
    });
    this.watch(this.app.live.phase, (phase) => {
      if (phase === "on") void this.load();
    });
  }

  protected override render(): TemplateResult {
    const shown = this.isHeld ? this.held : this.events.shown(this.kinds, this.who);
    return html`
      <div class="row">
        ${searchField("Who, or a word", this.who, (text) => {
          this.who = text;
          this.release();
        })}
        <button
          aria-pressed=${this.isHeld}
          @click=${() => {
            this.held = shown;
            this.isHeld = !this.isHeld;
            this.requestUpdate();
          }}
        >
          Hold still
        </button>
      </div>
      <div class="row kinds" role="group" aria-label="Kinds of events; none pressed means all">
        ${this.events.kinds.map(
          (kind) =>
            html`<button
              aria-pressed=${this.kinds.has(kind)}
              @click=${() => {
                if (!this.kinds.delete(kind)) this.kinds.add(kind);
                this.release();
              }}
            >
              ${labelOf(kind)}
            </button>`,
        )}
      </div>
      ${this.refused()}
      <ol class="plain" aria-label="Events, the newest first">
        ${shown.map((event) => this.row(event))}
      </ol>
      ${shown.length === 0 ? html`<p class="soft">Nothing of that kind has happened.</p>` : nothing}
    `;
  }

  private row(event: WorldEvent): TemplateResult {
    return html`<li>
      <time datetime=${new Date(event.at_us / 1000).toISOString()}>${clock(event.at_us)}</time>
      <span><span class="chip">${labelOf(event.kind)}</span> ${event.text}</span>
      ${
        event.place || chosenBy(event.who)
          ? html`<button
              class="plain"
              aria-label="Show on the map: ${event.text}"
              @click=${() => {
                this.look(event);
              }}
            >
              Show
            </button>`
          : nothing
      }
    </li>`;
  }

  private look(event: WorldEvent): void {
    const { state } = this.app;
    if (event.place) state.lookAt.value = [event.place[0], event.place[1], event.place[2]];
    state.hovered.value = event.at_us;
    const chosen = chosenBy(event.who);
    if (chosen !== null) this.app.choose(chosen);
  }

  private release(): void {
    this.isHeld = false;
    this.requestUpdate();
    void this.load();
  }

  private async load(): Promise<void> {
    const kind = this.kinds.size === 1 ? [...this.kinds][0] : undefined;
    const found = await this.ask<{ events: WorldEvent[] }>("/events", { kind, limit: 200 });
    if (found) this.events.add(found.events);
    this.requestUpdate();
  }
}

customElements.define("esp-events", EventsPanel);
