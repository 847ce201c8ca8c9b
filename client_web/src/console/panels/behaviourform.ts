/** The form of a behaviour, made from its schema; places are chosen by name or on the map. */

import { html, nothing, type TemplateResult } from "lit";
import type { AppContext } from "../context";
import { pick } from "./pick";
import type { BehaviourKind, Input } from "../models/behaviours";
import type { Json } from "../models/fields";
import { factText } from "../models/facts";
import { shown } from "../models/fields";
import type { Point } from "../net/types";

export interface BehaviourWish {
  kind: string;
  values: Readonly<Record<string, Json>>;
}

export function behaviourForm(
  app: AppContext,
  kinds: readonly BehaviourKind[],
  wish: BehaviourWish,
  change: (next: BehaviourWish) => void,
): TemplateResult {
  const kind = kinds.find((one) => one.kind === wish.kind);
  const set = (name: string, value: Json | undefined): void => {
    const others = Object.entries(wish.values).filter(([other]) => other !== name);
    change({
      ...wish,
      values: Object.fromEntries(value === undefined ? others : [...others, [name, value]]),
    });
  };
  return html`<div class="row behaviour">
    <label class="field grow">
      Behaviour
      <select
        name="behaviour"
        @change=${(event: Event) => {
          change({ ...wish, kind: (event.currentTarget as HTMLSelectElement).value });
        }}
      >
        ${kinds.map(
          (one) =>
            html`<option value=${one.kind} ?selected=${one.kind === wish.kind}>
              ${one.label}
            </option>`,
        )}
      </select>
    </label>
    ${(kind?.inputs ?? []).map((input) => control(app, input, wish.values[input.name], set))}
    <p class="soft">${kind?.doc ?? ""}</p>
  </div>`;
}

type Set = (name: string, value: Json | undefined) => void;

function control(app: AppContext, input: Input, value: Json | undefined, set: Set): TemplateResult {
  switch (input.kind) {
    case "number":
      return numberControl(input, value, set);
    case "boolean":
      return html`<label title=${input.doc}>
        <input
          type="checkbox"
          .checked=${(value ?? input.usual) === true}
          @change=${(event: Event) => {
            set(input.name, (event.currentTarget as HTMLInputElement).checked);
          }}
        />
        ${input.label}
      </label>`;
    case "choice":
      return html`<label class="field" title=${input.doc}>
        ${input.label}
        <select
          @change=${(event: Event) => {
            set(input.name, (event.currentTarget as HTMLSelectElement).value);
          }}
        >
          ${input.choices.map(
            (one) => html`<option ?selected=${one === (value ?? input.usual)}>${one}</option>`,
          )}
        </select>
      </label>`;
    case "place":
      return placeControl(app, input, value, set);
    case "places":
      return placesControl(app, input, value, set);
    case "text":
      return html`<label class="field" title=${input.doc}>
        ${input.label}
        <input
          .value=${typeof value === "string" ? value : ""}
          ?required=${input.required}
          @change=${(event: Event) => {
            set(input.name, (event.currentTarget as HTMLInputElement).value || undefined);
          }}
        />
      </label>`;
  }
}

function numberControl(input: Input, value: Json | undefined, set: Set): TemplateResult {
  const { field } = input;
  const usual = typeof input.usual === "number" ? shown(input.usual) : "";
  return html`<label class="field" title=${input.doc}>
    ${input.label} ${field?.unit ? html`(${field.unit})` : nothing}
    <input
      class="short number"
      type="number"
      step="any"
      min=${field?.least ?? nothing}
      max=${field?.most ?? nothing}
      placeholder=${usual}
      .value=${typeof value === "number" ? String(value) : ""}
      @change=${(event: Event) => {
        const given = (event.currentTarget as HTMLInputElement).valueAsNumber;
        set(input.name, Number.isNaN(given) ? undefined : given);
      }}
    />
  </label>`;
}

function names(app: AppContext): string[] {
  return Object.keys(app.state.world.value?.places ?? {}).sort();
}

function placeControl(
  app: AppContext,
  input: Input,
  value: Json | undefined,
  set: Set,
): TemplateResult {
  const point = Array.isArray(value) ? pointText(value) : null;
  return html`<label class="field" title=${input.doc}>
      ${input.label}
      <select
        @change=${(event: Event) => {
          const { value: name } = event.currentTarget as HTMLSelectElement;
          if (name !== "*") set(input.name, name || undefined);
        }}
      >
        <option value="">(choose)</option>
        ${point === null ? nothing : html`<option value="*" selected>${point}</option>`}
        ${names(app).map((name) => html`<option ?selected=${name === value}>${name}</option>`)}
      </select>
    </label>
    <button
      type="button"
      @click=${() =>
        void pick(app, `Click where: ${input.label.toLowerCase()}`, "point").then((points) => {
          const [first] = points ?? [];
          if (first) set(input.name, rounded(first));
        })}
    >
      On the map
    </button>`;
}

function placesControl(
  app: AppContext,
  input: Input,
  value: Json | undefined,
  set: Set,
): TemplateResult {
  const stops = Array.isArray(value) ? (value as readonly Json[]) : [];
  const put = (next: readonly Json[]): void => {
    set(input.name, next.length === 0 ? undefined : next.slice(0, input.most));
  };
  const moved = (from: number, to: number): void => {
    const next = [...stops];
    next.splice(to, 0, ...next.splice(from, 1));
    put(next);
  };
  return html`<fieldset class="grow">
    <legend>${input.label}</legend>
    <ol>
      ${stops.map(
        (stop, index) =>
          html`<li>
            ${Array.isArray(stop) ? pointText(stop as readonly Json[]) : factText(stop)}
            <button
              type="button"
              class="plain"
              aria-label="Stop ${index + 1} earlier"
              ?disabled=${index === 0}
              @click=${() => {
                moved(index, index - 1);
              }}
            >
              ↑
            </button>
            <button
              type="button"
              class="plain"
              aria-label="Leave stop ${index + 1} out"
              @click=${() => {
                put(stops.filter((_, other) => other !== index));
              }}
            >
              ✕
            </button>
          </li>`,
      )}
    </ol>
    <div class="row">
      <label>
        <span class="visually-hidden">Add a place to ${input.label}</span>
        <select
          @change=${(event: Event) => {
            const select = event.currentTarget as HTMLSelectElement;
            if (select.value) put([...stops, select.value]);
            select.value = "";
          }}
        >
          <option value="">add a place</option>
          ${names(app).map((name) => html`<option>${name}</option>`)}
        </select>
      </label>
      <button
        type="button"
        @click=${() =>
          void pick(app, `Click the stops: ${input.label.toLowerCase()}`, "line").then((points) => {
            if (points) put([...stops, ...points.map(rounded)]);
          })}
      >
        Draw on the map
      </button>
    </div>
  </fieldset>`;
}

function rounded(point: Point): Json {
  return point.map((value) => Number(value.toFixed(2)));
}

function pointText(point: readonly Json[]): string {
  const [x, y, z] = point.map(Number);
  return `${(x ?? 0).toFixed(1)}, ${(y ?? 0).toFixed(1)}${z ? `, ${z.toFixed(1)} m up` : ""}`;
}
