/** Commands that are carried out later: at a time, after a span, or when a figure says so. */

import { css, html, nothing, type TemplateResult } from "lit";
import { factText } from "../models/facts";
import { type OccasionForm, occasionForm, whenOf, whenText, type When } from "../models/occasions";
import { commandsOf } from "../models/parameterwork";
import { scopeName } from "../models/scopes";
import type { Command } from "../net/types";
import { CommandingPanel } from "./commanding";
import { noteField } from "./fields";

interface Schedule {
  id: string;
  commands: readonly (Command | Readonly<Record<string, unknown>>)[];
  when: When;
  state: string;
  by: string | null;
  due_tick?: number | null;
  fired?: unknown;
  again_after_s?: number | null;
}

/** A change that is taken back by itself when a figure is beyond its limit for too long. */
interface Guard {
  id: string;
  changes: readonly number[];
  condition: When;
  state: string;
  by: string | null;
}

const OVER = /done|cancel|fired|failed|over|refused/;

class SchedulesPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      li {
        padding: 6px 0;
        border-bottom: 1px solid var(--line);
      }
      textarea {
        width: 100%;
        font-family: ui-monospace, monospace;
        font-size: 0.93em;
      }
    `,
  ];
  private schedules: readonly Schedule[] = [];
  private guards: readonly Guard[] = [];
  private figures: readonly string[] = [];
  private form: OccasionForm = occasionForm();
  private what = "";
  private why = "";

  protected override begin(): void {
    this.watch(this.app.state.draft);
    this.hearAbout(/schedule/, () => void this.load());
    void this.load();
  }

  protected override render(): TemplateResult {
    return html`
      ${this.refused()}
      <ul class="plain" aria-label="Schedules">
        ${this.schedules.map((one) => this.row(one))}
      </ul>
      ${this.schedules.length === 0 ? html`<p class="soft">Nothing is scheduled.</p>` : nothing}
      <ul class="plain" aria-label="Guards">
        ${this.guards.map(
          (one) =>
            html`<li>
              <div class="row">
                <b>${one.id}</b>
                <span class="grow">${whenText({ figure: one.condition })}</span>
                <span class="chip">${one.state.replaceAll("_", " ")}</span>
              </div>
              <div class="soft">
                takes back change ${one.changes.join(", ")} of ${one.by ?? "the server"}
              </div>
            </li>`,
        )}
      </ul>
      ${this.maker()}
    `;
  }

  private row(one: Schedule): TemplateResult {
    const over = OVER.test(one.state);
    return html`<li>
      <div class="row">
        <b>${one.id}</b>
        <span class="grow">${whenText(one.when)}</span>
        <span class="chip">${one.state}</span>
        ${
          over
            ? nothing
            : this.button("Cancel", "cancel_schedule", () => this.cancel(one.id), {
                label: `Cancel schedule ${one.id}`,
              })
        }
      </div>
      <div class="soft">
        ${one.by ?? ""}: ${one.commands.map((command) => commandText(command)).join("; ")}
        ${one.again_after_s ? `, taken back after ${one.again_after_s} s` : ""}
      </div>
    </li>`;
  }

  private maker(): TemplateResult {
    const draft = this.app.state.draft.value;
    const { form } = this;
    const set = (change: Partial<OccasionForm>): void => {
      this.form = { ...this.form, ...change };
      this.requestUpdate();
    };
    const input = (
      name: "afterS" | "tick" | "limit" | "forS" | "againS",
      label: string,
    ): TemplateResult =>
      html`<label class="field">
        ${label}
        <input
          class="short number"
          type="number"
          step="any"
          .value=${form[name]}
          @input=${(event: Event) => {
            set({ [name]: (event.currentTarget as HTMLInputElement).value });
          }}
        />
      </label>`;
    const when = whenOf(form);
    const commands = this.commands();
    const blocked =
      typeof when === "string" ? when : typeof commands === "string" ? commands : null;
    return html`<fieldset>
      <legend>Schedule</legend>
      <div class="row">
        <label class="field">
          When
          <select
            @change=${(event: Event) => {
              set({
                kind: (event.currentTarget as HTMLSelectElement).value as OccasionForm["kind"],
              });
            }}
          >
            <option value="after" ?selected=${form.kind === "after"}>after a span</option>
            <option value="time" ?selected=${form.kind === "time"}>at a time</option>
            <option value="figure" ?selected=${form.kind === "figure"}>
              when a figure says so
            </option>
            <option value="tick" ?selected=${form.kind === "tick"}>at a tick</option>
          </select>
        </label>
        ${form.kind === "after" ? input("afterS", "Seconds") : nothing}
        ${form.kind === "tick" ? input("tick", "Tick") : nothing}
        ${
          form.kind === "time"
            ? html`<label class="field">
                Time
                <input
                  type="datetime-local"
                  .value=${form.time}
                  @change=${(event: Event) => {
                    set({ time: (event.currentTarget as HTMLInputElement).value });
                  }}
                />
              </label>`
            : nothing
        }
        ${
          form.kind === "figure"
            ? html`<label class="field grow">
                  Figure
                  <select
                    @change=${(event: Event) => {
                      set({ figure: (event.currentTarget as HTMLSelectElement).value });
                    }}
                  >
                    <option value="">(choose)</option>
                    ${this.figures.map((name) => html`<option ?selected=${name === form.figure}>${name}</option>`)}
                  </select>
                </label>
                <label class="field">
                  Side
                  <select
                    @change=${(event: Event) => {
                      set({ side: (event.currentTarget as HTMLSelectElement).value as "above" });
                    }}
                  >
                    <option ?selected=${form.side === "above"}>above</option>
                    <option ?selected=${form.side === "below"}>below</option>
                  </select>
                </label>
                ${input("limit", "Limit")} ${input("forS", "For seconds")}`
            : nothing
        }
        ${input("againS", "Take back after s")}
      </div>
      <p>
        ${
          this.what.trim() !== ""
            ? "The commands below are scheduled."
            : draft
              ? `The draft for ${scopeName(draft.scope)} is scheduled: ${factText(draft.values)}.`
              : "Make a draft of parameters, or write commands below."
        }
      </p>
      <details>
        <summary>Commands as JSON</summary>
        <textarea
          rows="4"
          aria-label="Commands to schedule, as JSON"
          spellcheck="false"
          placeholder=${'{"op": "apply_preset", "scope": "world", "preset": "brisk"}'}
          .value=${this.what}
          @input=${(event: Event) => {
            this.what = (event.currentTarget as HTMLTextAreaElement).value;
            this.requestUpdate();
          }}
        ></textarea>
      </details>
      <div class="row">
        ${noteField(this.why, (text) => {
          this.why = text;
        })}
        ${this.button("Schedule", "schedule", () => this.schedule(), { main: true, blocked })}
      </div>
    </fieldset>`;
  }

  /** The commands that the form means; a text says what is wrong with them. */
  private commands(): readonly Command[] | string {
    if (this.what.trim() !== "") {
      try {
        const found: unknown = JSON.parse(this.what);
        return Array.isArray(found) ? (found as Command[]) : [found as Command];
      } catch (error) {
        return `The JSON cannot be read: ${error instanceof Error ? error.message : ""}`;
      }
    }
    const draft = this.app.state.draft.value;
    if (!draft) return "There is nothing to schedule.";
    const entries = Object.entries(draft.values);
    const values = entries.filter((one): one is [string, number] => typeof one[1] === "number");
    const cleared = entries.filter(([, value]) => value === null).map(([name]) => name);
    return commandsOf(draft.scope, { values: Object.fromEntries(values), cleared }, {}, {});
  }

  private async schedule(): Promise<void> {
    const when = whenOf(this.form);
    const commands = this.commands();
    if (typeof when === "string" || typeof commands === "string") return;
    const command: Command = { op: "schedule", commands, when };
    const again = Number(this.form.againS);
    if (again > 0) command["again_after_s"] = again;
    if (this.why.trim() !== "") command.note = this.why.trim();
    if (await this.carryOut(command, "It is scheduled.")) {
      this.what = "";
      this.why = "";
    }
    await this.load();
  }

  private async cancel(id: string): Promise<void> {
    await this.carryOut({ op: "cancel_schedule", id }, `${id} does nothing any more.`);
    await this.load();
  }

  private async load(): Promise<void> {
    interface Found {
      schedules: Schedule[];
      guards?: Guard[];
      figures?: { name: string }[];
    }
    const found = await this.ask<Found>("/schedules");
    if (!found) return;
    this.schedules = found.schedules;
    this.guards = found.guards ?? [];
    this.figures = (found.figures ?? []).map((one) => one.name);
    this.requestUpdate();
  }
}

function commandText(command: Readonly<Record<string, unknown>>): string {
  const { op, ...rest } = command;
  return `${String(op).replaceAll("_", " ")} ${factText(rest)}`;
}

customElements.define("esp-schedules", SchedulesPanel);
