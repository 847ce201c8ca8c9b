/** The form of actors that are to come in: one, or a wave of many. */

import { html, nothing, type TemplateResult } from "lit";
import type { AppContext } from "../../context";
import type { BehaviourKind } from "../../models/behaviours";
import type { JsonObject } from "../../models/fields";
import type { Command, Point } from "../../net/types";
import { behaviourForm, type BehaviourWish } from "../behaviourform";
import { pick } from "../pick";

/** One command adds no more actors than this. */
export const MOST_NEW = 200;

export interface NewActors {
  readonly count: number;
  readonly name: string;
  readonly tags: string;
  readonly preset: string;
  readonly near: Point | null;
  readonly behaviour: BehaviourWish;
}

export function newActors(): NewActors {
  const behaviour = { kind: "wander", values: {} };
  return { count: 1, name: "", tags: "", preset: "", near: null, behaviour };
}

/** Whether it is one actor, without the values of a preset, which waves alone are given. */
function isSingle({ count, preset }: NewActors): boolean {
  return count === 1 && preset === "";
}

/** The command for a form: a single actor has a name and a place of its own, a wave has not. */
export function commandFor(form: NewActors, behaviour: JsonObject): Command {
  const tags = form.tags.split(/[\s,]+/).filter(Boolean);
  const near = form.near ?? undefined;
  if (isSingle(form)) {
    const actor: Record<string, unknown> = { behaviour, tags };
    if (form.name.trim() !== "") actor["name"] = form.name.trim();
    if (near) actor["place"] = near;
    return { op: "add_actors", actors: [actor] };
  }
  const command: Command = { op: "add_actors", count: form.count, behaviour, tags };
  if (form.preset !== "") command["preset"] = form.preset;
  if (near) command["near"] = near;
  return command;
}

export function newActorsForm(
  app: AppContext,
  form: NewActors,
  kinds: readonly BehaviourKind[],
  presets: readonly string[],
  change: (next: NewActors) => void,
): TemplateResult {
  const text = (name: "name" | "tags", label: string, hint: string): TemplateResult =>
    html`<label class="field grow">
      ${label}
      <input
        name=${name}
        placeholder=${hint}
        maxlength="128"
        .value=${form[name]}
        @input=${(event: Event) => {
          change({ ...form, [name]: (event.currentTarget as HTMLInputElement).value });
        }}
      />
    </label>`;
  return html`<fieldset>
    <legend>Let actors come in</legend>
    <div class="row">
      <label class="field">
        How many
        <input
          class="short number"
          type="number"
          name="count"
          min="1"
          max=${MOST_NEW}
          .value=${String(form.count)}
          @change=${(event: Event) => {
            const count = Math.round(Number((event.currentTarget as HTMLInputElement).value));
            change({ ...form, count: Math.min(MOST_NEW, Math.max(1, count || 1)) });
          }}
        />
      </label>
      ${isSingle(form) ? text("name", "Name", "as others see it") : nothing}
      ${text("tags", "Groups", "tags, between blanks")}
      <label class="field">
        Preset
        <select
          @change=${(event: Event) => {
            change({ ...form, preset: (event.currentTarget as HTMLSelectElement).value });
          }}
        >
          <option value="">(usual)</option>
          ${presets.map((name) => html`<option ?selected=${name === form.preset}>${name}</option>`)}
        </select>
      </label>
      <button
        @click=${() =>
          void pick(app, "Click where they are to come in", "point").then((points) => {
            change({ ...form, near: points?.[0] ?? null });
          })}
      >
        ${form.near ? "Place: chosen" : "Place: a free one"}
      </button>
    </div>
    ${behaviourForm(app, kinds, form.behaviour, (behaviour) => {
      change({ ...form, behaviour });
    })}
  </fieldset>`;
}
