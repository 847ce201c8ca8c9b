/** The world that all share: its pace, its doors, its recording, and marks of moments. */

import { css, html, nothing, type TemplateResult } from "lit";
import type { Recording, World } from "../net/types";
import { CommandingPanel } from "./commanding";

const REFRESH_MS = 2000;
const PACES = [0.1, 0.25, 0.5, 1, 2, 4];

class WorldPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      dl {
        display: grid;
        grid-template-columns: auto 1fr;
        gap: 2px 12px;
        margin: 0 0 10px;
      }
      dd {
        margin: 0;
      }
      li.row {
        padding: 3px 0;
      }
    `,
  ];
  private world: World | null = null;
  private mark = "";

  protected override begin(): void {
    this.world = this.app.state.world.value;
    this.watch(this.app.state.world, (world) => {
      this.world = world;
      this.requestUpdate();
    });
    this.hearAbout(/pace|door|record|revert|actor/, () => void this.load());
    this.every(REFRESH_MS, () => void this.load());
    void this.load();
  }

  protected override render(): TemplateResult {
    const { world } = this;
    if (!world)
      return html`${this.refused()}
        <p class="soft">The world is on its way.</p>`;
    const { paused, factor } = world.pace ?? { paused: false, factor: 1 };
    const running = paused ? null : "Pause the world first.";
    return html`
      ${this.refused()}
      <dl>
        <dt class="soft">Scene</dt>
        <dd>
          ${world.scene}, ${world.people} people, ${world.actors} of ${world.most_actors} actors
        </dd>
        <dt class="soft">Time</dt>
        <dd>
          tick ${world.tick}, ${span(world.tick * world.tick_s)};
          ${paused ? "paused" : `at ${factor}×`}
        </dd>
        <dt class="soft">Planning</dt>
        <dd>${planned(world.planning_interval_ticks ?? 1)}</dd>
      </dl>
      <fieldset>
        <legend>Pace</legend>
        <div class="row">
          ${this.button(paused ? "Go on" : "Pause", "pace", () => this.pace({ pause: !paused }), {
            ...{ main: true, pressed: paused },
          })}
          ${this.button("1 tick", "pace", () => this.pace({ step: 1 }), { blocked: running })}
          ${this.button("10 ticks", "pace", () => this.pace({ step: 10 }), { blocked: running })}
        </div>
        <div class="row paces" role="group" aria-label="Pace of the world's time">
          ${PACES.map((each) =>
            this.button(`${each}×`, "pace", () => this.pace({ factor: each }), {
              pressed: each === factor,
            }),
          )}
        </div>
        <p class="soft">People see a banner while the world is paused or goes at another pace.</p>
      </fieldset>
      <fieldset>
        <legend>Doors</legend>
        <ul class="plain">
          ${Object.entries(world.doors).map(
            ([door, open]) =>
              html`<li class="row">
                <span class="grow">${door}</span>
                <span class="soft">${open ? "open" : "closed"}</span>
                ${this.button(open ? "Close" : "Open", "move_door", () => this.move(door, !open), {
                  label: `${open ? "Close" : "Open"} the door ${door}`,
                })}
              </li>`,
          )}
        </ul>
        ${
          Object.keys(world.doors).length === 0
            ? html`<p class="soft">This scene has no doors.</p>`
            : nothing
        }
      </fieldset>
      ${world.recording === undefined ? nothing : this.recording(world.recording)}
      <form
        class="row"
        @submit=${(event: Event) => {
          event.preventDefault();
          void this.note();
        }}
      >
        <label class="field grow">
          Mark this moment
          <input
            maxlength="200"
            placeholder="What is there to remember?"
            .value=${this.mark}
            @input=${(event: Event) => {
              this.mark = (event.currentTarget as HTMLInputElement).value;
              this.requestUpdate();
            }}
          />
        </label>
        ${this.button("Mark", "mark", () => this.note(), {
          blocked: this.mark.trim() === "" ? "Say in a few words what it is." : null,
        })}
      </form>
    `;
  }

  private recording(recording: Recording | null): TemplateResult {
    const on = recording?.state === "on";
    const none = "The server has no folder for recordings.";
    return html`<fieldset>
      <legend>Recording</legend>
      <div class="row">
        <span class="grow">${recording ? recorded(recording) : none}</span>
        ${this.button(on ? "End" : "Record", "record", () => this.record(!on), {
          label: on ? "End the recording" : "Record the world",
          blocked: recording ? null : none,
        })}
      </div>
    </fieldset>`;
  }

  private async record(on: boolean): Promise<void> {
    await this.carryOut({ op: "record", on });
    await this.load();
  }

  private async pace(what: Record<string, number | boolean>): Promise<void> {
    await this.carryOut({ op: "pace", ...what });
    await this.load();
  }

  private async move(door: string, open: boolean): Promise<void> {
    const done = `The door ${door} ${open ? "opens" : "closes"} once nobody is in its way.`;
    await this.carryOut({ op: "move_door", door, open }, done);
    await this.load();
  }

  private async note(): Promise<void> {
    const text = this.mark.trim();
    if (text === "") return;
    const answer = await this.carryOut({ op: "mark", text }, "This moment is marked.");
    if (answer) this.mark = "";
    this.requestUpdate();
  }

  private async load(): Promise<void> {
    const found = await this.ask<World>("/world");
    if (found) this.world = found;
    this.requestUpdate();
  }
}

function planned(interval: number): string {
  if (interval === 1) return "each actor in every tick";
  return `each actor once in ${interval} ticks`;
}

function recorded({ state, file, bytes, seconds, fault }: Recording): string {
  if (state === "off") return "The world is not recorded.";
  const size = `${(bytes / 1e6).toFixed(1)} MB`;
  return (
    fault ?? `${file}: ${size}, ${Math.floor(seconds / 60)} min ${seconds % 60} s of the world`
  );
}

function span(seconds: number): string {
  const minutes = Math.floor(seconds / 60);
  return `${Math.floor(minutes / 60)} h ${minutes % 60} min of the world`;
}

customElements.define("esp-world", WorldPanel);
