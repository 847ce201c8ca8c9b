/** Actors: who there is, what they do; sent, held, given other behaviours, and removed. */

import { css, html, nothing, type TemplateResult } from "lit";
import { behaviourKinds, type BehaviourKind, missing, specOf } from "../../models/behaviours";
import { type JsonObject, labelOf } from "../../models/fields";
import { groupsOf, shortId } from "../../models/scopes";
import type { Actor, Actors, Command } from "../../net/types";
import { behaviourForm, type BehaviourWish } from "../behaviourform";
import { pick } from "../pick";
import { CommandingPanel } from "../commanding";
import { searchField } from "../fields";
import { newActors, type NewActors, newActorsForm, commandFor } from "./newactors";

const REFRESH_MS = 2000;
const MOST_SHOWN = 300;

type Listed = Actor & { readonly groups?: Readonly<Record<string, string>> };

class ActorsPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      tr[aria-selected="true"] td {
        background: var(--accent-wash);
      }
      td button.plain {
        padding: 0;
        min-height: 0;
        text-align: left;
        color: var(--accent);
      }
    `,
  ];
  private actors: readonly Listed[] = [];
  private kinds: readonly BehaviourKind[] = [];
  private presets: readonly string[] = [];
  private sought = "";
  private wish: BehaviourWish = { kind: "wander", values: {} };
  private wave: NewActors = newActors();

  protected override begin(): void {
    this.watch(this.app.state.chosen);
    this.watch(this.app.state.world);
    this.hearAbout(/actor|behaviour|group|revert/, () => void this.load());
    this.every(REFRESH_MS, () => void this.load());
    void this.load();
    void this.ask<{ behaviours: JsonObject }>("/schema").then((schema) => {
      this.kinds = schema ? behaviourKinds(schema.behaviours) : [];
      this.requestUpdate();
    });
    void this.app.api
      .get<{ presets: { name: string }[] }>("/presets")
      .then(({ presets }) => {
        this.presets = presets.map((one) => one.name);
        this.requestUpdate();
      })
      .catch(() => undefined);
  }

  protected override render(): TemplateResult {
    const chosen = this.chosen();
    const shown = this.actors.filter((actor) => this.fits(actor));
    return html`
      <div class="row">
        ${searchField("Find", this.sought, this.seek, "name, group, behaviour, reason")}
        <button
          @click=${() => {
            this.app.choose(shown.map((actor) => actor.id));
          }}
        >
          Choose all ${shown.length}
        </button>
      </div>
      ${this.refused()} ${this.deeds(chosen)}
      <div class="scroll" tabindex="0" role="region" aria-label="Actors in the world">
        <table>
          <thead>
            <tr>
              ${["Actor", "Does", "Now", "Groups"].map((name) => html`<th scope="col">${name}</th>`)}
            </tr>
          </thead>
          <tbody>
            ${shown.slice(0, MOST_SHOWN).map((actor) => this.row(actor, chosen))}
          </tbody>
        </table>
      </div>
      ${
        shown.length > MOST_SHOWN
          ? html`<p class="soft">and ${shown.length - MOST_SHOWN} more</p>`
          : nothing
      }
      ${newActorsForm(this.app, this.wave, this.kinds, this.presets, (next) => {
        this.wave = next;
        this.requestUpdate();
      })}
      <div class="row">
        ${this.button("Add", "add_actors", () => this.add(), {
          ...{ main: true, label: `Add ${this.wave.count} actors` },
          blocked: this.missingOf(this.wave.behaviour),
        })}
      </div>
    `;
  }

  private readonly seek = (text: string): void => {
    this.sought = text;
    this.requestUpdate();
  };

  private deeds(chosen: readonly Listed[]): TemplateResult {
    const ids = chosen.map((actor) => actor.id);
    const names = chosen.length === 1 ? (chosen[0]?.name ?? "") : `${chosen.length} actors`;
    const blocked = chosen.length === 0 ? "Choose actors first, here or on the map." : null;
    const held = chosen.length > 0 && chosen.every((actor) => actor.held);
    return html`<fieldset>
      <legend>${chosen.length === 0 ? "Nobody is chosen" : names}</legend>
      <div class="row">
        ${this.button("Send on the map", "send_actor", () => this.send(ids), { blocked })}
        ${this.button(held ? "Let go" : "Hold", "hold_actor", () => this.hold(ids, !held), {
          ...{ blocked, pressed: held },
        })}
        ${this.button("Remove", "remove_actors", () => this.takeOut(ids, names), { blocked })}
        <button
          @click=${() => {
            this.app.show("parameters");
          }}
        >
          Tune
        </button>
      </div>
      <details>
        <summary>Another behaviour</summary>
        ${behaviourForm(this.app, this.kinds, this.wish, (next) => {
          this.wish = next;
          this.requestUpdate();
        })}
        ${this.button("Let them do that", "set_behaviour", () => this.behave(ids), {
          blocked: blocked ?? this.missingOf(this.wish),
        })}
      </details>
    </fieldset>`;
  }

  private row(actor: Listed, chosen: readonly Listed[]): TemplateResult {
    return html`<tr aria-selected=${chosen.includes(actor)}>
      <td>
        <button
          class="plain"
          @click=${(event: MouseEvent) => {
            this.choose(actor.id, event.shiftKey || event.ctrlKey || event.metaKey);
          }}
        >
          ${actor.name}
        </button>
        <span class="soft">${shortId(actor.id)}</span>
      </td>
      <td>
        ${labelOf(actor.behaviour)}${actor.held ? html` <span class="chip">held</span>` : nothing}
      </td>
      <td>${labelOf(actor.reason ?? "")}</td>
      <td>${groupsOf(actor).map((group) => html`<span class="chip">${group}</span> `)}</td>
    </tr>`;
  }

  private choose(id: string, more: boolean): void {
    const { chosen } = this.app.state;
    if (!more) this.app.choose(id);
    else if (chosen.value.includes(id)) this.app.choose(chosen.value.filter((one) => one !== id));
    else this.app.choose([...chosen.value, id]);
  }

  private chosen(): Listed[] {
    const ids = new Set(this.app.state.chosen.value);
    return this.actors.filter((actor) => ids.has(actor.id));
  }

  private fits(actor: Listed): boolean {
    const groups = groupsOf(actor).join(" ");
    const text = `${actor.id} ${actor.name} ${groups} ${actor.behaviour} ${actor.reason ?? ""}`;
    return text.toLowerCase().includes(this.sought.trim().toLowerCase());
  }

  private missingOf(wish: BehaviourWish): string | null {
    const kind = this.kinds.find((one) => one.kind === wish.kind);
    return kind ? missing(kind, wish.values) : "The schema is on its way.";
  }

  private specOf(wish: BehaviourWish): JsonObject {
    const kind = this.kinds.find((one) => one.kind === wish.kind);
    return kind ? specOf(kind, wish.values) : { kind: wish.kind };
  }

  private async send(ids: readonly string[]): Promise<void> {
    const [target] = (await pick(this.app, "Click where they are to go", "point")) ?? [];
    if (!target) return;
    await this.all(
      ids.map((actor) => ({ op: "send_actor", actor, target })),
      "They are sent.",
    );
  }

  private async hold(ids: readonly string[], held: boolean): Promise<void> {
    const done = held ? "They stand where they are." : "They go on.";
    await this.all(
      ids.map((actor) => ({ op: "hold_actor", actor, held })),
      done,
    );
  }

  private async takeOut(ids: readonly string[], names: string): Promise<void> {
    const answer = await this.carryOut({ op: "remove_actors", actors: ids }, `${names} removed.`);
    if (answer) this.app.choose(null);
    await this.load();
  }

  private async behave(ids: readonly string[]): Promise<void> {
    const behaviour = this.specOf(this.wish);
    await this.carryOut({ op: "set_behaviour", actors: ids, behaviour }, "They do so from now on.");
    await this.load();
  }

  private async add(): Promise<void> {
    const command = commandFor(this.wave, this.specOf(this.wave.behaviour));
    const answer = await this.carryOut(command, "They have come in.");
    if (answer) await this.load();
  }

  private async all(commands: Command[], done: string): Promise<void> {
    await this.carryOutAll(commands.slice(0, 64), done);
    await this.load();
  }

  private async load(): Promise<void> {
    const found = await this.ask<Actors>("/actors");
    if (found) this.actors = found.actors;
    this.requestUpdate();
  }
}

customElements.define("esp-actors", ActorsPanel);
