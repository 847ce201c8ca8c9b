/** People who are in the world: told something, muted, led out, sent out, banned. */

import { css, html, nothing, type TemplateResult } from "lit";
import { clock, span } from "../../models/times";
import { CommandingPanel } from "../commanding";
import { searchField } from "../fields";
import { pick } from "../pick";

interface Person {
  id: number;
  name: string;
  since_us?: number;
  address_hash?: string;
  delay_ms?: number | null;
  queue_bytes?: number | null;
  muted_s: number;
  /** Whether somebody is being led to the way out. */
  walked_out?: boolean;
  x?: number;
  y?: number;
  z?: number;
}

type Audience = "all" | "storey" | "ring" | "actor";

const REFRESH_MS = 2000;
const UNTIL: readonly (readonly [string, number | null])[] = [
  ["an hour", 3600],
  ["a day", 86_400],
  ["a week", 604_800],
  ["for ever", null],
];

class PeoplePanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      tr[aria-selected="true"] td {
        background: var(--accent-wash);
      }
      td {
        white-space: nowrap;
      }
      textarea {
        width: 100%;
      }
    `,
  ];
  private people: readonly Person[] = [];
  private sought = "";
  private text = "";
  private muteS = 600;
  private bannedS: number | null = 86_400;
  private said = "";
  private audience: Audience = "all";

  protected override begin(): void {
    this.watch(this.app.state.chosen);
    this.watch(this.app.state.world);
    this.hearAbout(/mute|kick|ban|walk_out|people/, () => void this.load());
    this.every(REFRESH_MS, () => void this.load());
    void this.load();
  }

  protected override render(): TemplateResult {
    const word = this.sought.trim().toLowerCase();
    const shown = this.people.filter((one) => `${one.name} ${one.id}`.toLowerCase().includes(word));
    const chosen = this.people.find((one) => `person:${one.id}` === this.app.state.chosen.value[0]);
    return html`
      ${searchField("Name", this.sought, (text) => {
        this.sought = text;
        this.requestUpdate();
      })}
      ${this.refused()} ${this.deeds(chosen)}
      <div class="scroll" tabindex="0" role="region" aria-label="People in the world">
        <table>
          <thead>
            <tr>
              ${["Person", "Here since", "Address", "Delay", "Waits", "Muted"].map(
                (name) => html`<th scope="col">${name}</th>`,
              )}
            </tr>
          </thead>
          <tbody>
            ${shown.map((one) => this.row(one, one === chosen))}
          </tbody>
        </table>
      </div>
      ${shown.length === 0 ? html`<p class="soft">Nobody is here.</p>` : nothing}
      ${this.announcer()}
    `;
  }

  private row(one: Person, chosen: boolean): TemplateResult {
    const delay =
      one.delay_ms === undefined || one.delay_ms === null ? "—" : `${Math.round(one.delay_ms)} ms`;
    const queue = one.queue_bytes ? `${(one.queue_bytes / 1000).toFixed(1)} kB` : "—";
    return html`<tr aria-selected=${chosen}>
      <td>
        <button
          class="plain"
          @click=${() => {
            this.app.choose(`person:${one.id}`);
          }}
        >
          ${one.name}
        </button>
        ${one.walked_out ? html`<span class="chip">led out</span>` : nothing}
      </td>
      <td>${one.since_us === undefined ? "—" : clock(one.since_us)}</td>
      <td><code>${one.address_hash ?? "—"}</code></td>
      <td class="number">${delay}</td>
      <td class="number">${queue}</td>
      <td>${one.muted_s > 0 ? span(one.muted_s) : ""}</td>
    </tr>`;
  }

  private deeds(person: Person | undefined): TemplateResult {
    const blocked = person ? null : "Choose a person first, here or on the map.";
    const id = person?.id ?? 0;
    const name = person?.name ?? "Nobody is chosen";
    const text = this.text.trim();
    const said = text === "" ? {} : { text };
    const give = (command: Record<string, unknown> & { op: string }, done: string): unknown =>
      this.carryOut({ ...command, person: id, ...said }, done).then(() => this.load());
    return html`<fieldset>
      <legend>${name}</legend>
      <label class="field">
        What the person is told (empty: the usual words, politely)
        <input
          maxlength="200"
          .value=${this.text}
          @input=${(event: Event) => {
            this.text = (event.currentTarget as HTMLInputElement).value;
            this.requestUpdate();
          }}
        />
      </label>
      <div class="row deeds">
        ${this.button("Warn", "warn", () => give({ op: "warn" }, `${name} is told.`), {
          blocked: blocked ?? (text === "" ? "Say what it is about." : null),
        })}
        ${this.button("Mute", "mute", () => give({ op: "mute", seconds: this.muteS }, `${name} is muted.`), { blocked })}
        <label>
          for
          <select
            aria-label="How long the mute lasts"
            @change=${(event: Event) => {
              this.muteS = Number((event.currentTarget as HTMLSelectElement).value);
            }}
          >
            ${[60, 600, 3600, 86_400].map(
              (each) =>
                html`<option value=${each} ?selected=${each === this.muteS}>${span(each)}</option>`,
            )}
          </select>
        </label>
        ${
          person && person.muted_s > 0
            ? this.button("Let speak", "mute", () =>
                this.carryOut({ op: "mute", person: id, seconds: 0 }, `${name} may speak again.`),
              )
            : nothing
        }
        ${this.button("Walk out", "walk_out", () => give({ op: "walk_out" }, `${name} is led out.`), { blocked })}
        ${this.button("Kick", "kick", () => give({ op: "kick" }, `${name} is sent out.`), { blocked })}
        ${this.button("Ban", "ban", () => give({ op: "ban", until_s: this.until() }, `${name} is banned.`), { blocked })}
        <label>
          for
          <select
            aria-label="How long the ban lasts"
            @change=${(event: Event) => {
              const { value } = event.currentTarget as HTMLSelectElement;
              this.bannedS = value === "" ? null : Number(value);
            }}
          >
            ${UNTIL.map(
              ([label, seconds]) =>
                html`<option value=${seconds ?? ""} ?selected=${seconds === this.bannedS}>
                  ${label}
                </option>`,
            )}
          </select>
        </label>
      </div>
    </fieldset>`;
  }

  private announcer(): TemplateResult {
    const audiences: readonly (readonly [Audience, string])[] = [
      ["all", "everybody"],
      ["storey", "a floor, clicked on the map"],
      ["ring", "an area, drawn on the map"],
      ["actor", "who is near the chosen actor"],
    ];
    return html`<fieldset>
      <legend>Announce</legend>
      <textarea
        rows="2"
        maxlength="500"
        aria-label="What is announced"
        .value=${this.said}
        @input=${(event: Event) => {
          this.said = (event.currentTarget as HTMLTextAreaElement).value;
          this.requestUpdate();
        }}
      ></textarea>
      <div class="row">
        <label class="grow">
          to
          <select
            @change=${(event: Event) => {
              this.audience = (event.currentTarget as HTMLSelectElement).value as Audience;
            }}
          >
            ${audiences.map(
              ([value, label]) =>
                html`<option value=${value} ?selected=${value === this.audience}>${label}</option>`,
            )}
          </select>
        </label>
        ${this.button("Announce", "announce", () => this.announce(), {
          ...{
            main: true,
            blocked: this.said.trim() === "" ? "Say what is to be announced." : null,
          },
        })}
      </div>
    </fieldset>`;
  }

  private until(): number | null {
    return this.bannedS === null ? null : Math.round(Date.now() / 1000 + this.bannedS);
  }

  private async announce(): Promise<void> {
    const to = await this.audienceFields();
    if (!to) return;
    const answer = await this.carryOut(
      { op: "announce", text: this.said.trim(), ...to },
      "It is announced.",
    );
    if (answer) this.said = "";
    this.requestUpdate();
  }

  private async audienceFields(): Promise<Record<string, unknown> | null> {
    switch (this.audience) {
      case "all":
        return {};
      case "storey": {
        const [point] = (await pick(this.app, "Click anywhere on the floor", "point")) ?? [];
        return point ? { storey_m: point[2] } : null;
      }
      case "ring": {
        const ring = await pick(this.app, "Click the corners of the area", "ring");
        return ring && ring.length > 2 ? { polygon: ring.map(([x, y]) => [x, y]) } : null;
      }
      case "actor": {
        const actor = this.app.state.chosen.value.find((id) => !id.startsWith("person:"));
        if (actor === undefined) this.app.toast("Choose an actor first.");
        return actor === undefined ? null : { near_actor: actor, radius_m: 10 };
      }
    }
  }

  private async load(): Promise<void> {
    const found = await this.ask<{ people: Person[] }>("/people");
    if (found) this.people = found.people;
    this.requestUpdate();
  }
}

customElements.define("esp-people", PeoplePanel);
