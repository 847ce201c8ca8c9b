/** One parameter of the form: slider, number, where its value comes from, and what is beside it. */

import { css, html, nothing, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import type { Beside, Edit, FieldFault } from "../../models/draft";
import type { NumberField } from "../../models/fields";
import { SLIDER_STEPS, shown, stepOf, toSlider } from "../../models/fields";

export interface RowState {
  field: NumberField;
  value: number;
  /** The text in the box while somebody types in it. */
  typed: string | null;
  edit: Edit | undefined;
  /** Where the value comes from, as people read it. */
  from: string;
  /** Whether the scope has a value of its own. */
  own: boolean;
  beside: Beside | null;
  fault: FieldFault | null;
  shadows: number;
  explained: boolean;
  /** Why nothing can be changed, for those who may not. */
  locked: string | null;
}

export interface RowEvents {
  slide: (place: number) => void;
  slid: () => void;
  type: (text: string) => void;
  typedOut: () => void;
  step: (by: number) => void;
  reset: () => void;
  drop: () => void;
  takeTheirs: () => void;
  keepMine: () => void;
  clearShadows: () => void;
}

export function row(state: RowState, events: RowEvents): TemplateResult {
  const { field, value, edit, fault } = state;
  const differs = value !== field.usual;
  const id = `field-${field.name}`;
  const reading = `${shown(value)} ${field.unit === "1" ? "" : field.unit}`.trim();
  const described = [`${id}-about`, fault ? `${id}-fault` : "", state.beside ? `${id}-beside` : ""];
  return html`<div class="field-row ${edit === undefined ? "" : "edited"}" data-field=${field.name}>
    <label for=${id}>
      <span class="dot" ?data-on=${differs} title=${differs ? "differs from the usual value" : ""}>
        ${differs ? html`<span class="visually-hidden">differs from the usual value: </span>` : nothing}
      </span>
      ${field.label}
    </label>
    <span class="value">
      <input
        id=${id}
        class="short number"
        inputmode="decimal"
        autocomplete="off"
        ?readonly=${state.locked !== null}
        aria-invalid=${fault ? "true" : nothing}
        aria-describedby=${described.filter(Boolean).join(" ")}
        .value=${live(state.typed ?? shown(value))}
        @input=${(event: InputEvent) => {
          events.type((event.currentTarget as HTMLInputElement).value);
        }}
        @blur=${events.typedOut}
        @keydown=${(event: KeyboardEvent) => {
          if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
          event.preventDefault();
          const far = event.shiftKey ? 10 : 1;
          events.step((event.key === "ArrowUp" ? far : -far) * stepOf(field));
        }}
      />
      <span class="unit soft">${field.unit === "1" ? "" : field.unit}</span>
      <button
        class="plain"
        title="Back to what wider scopes say"
        aria-label="Take the value of ${field.label} out of this scope"
        aria-disabled=${
          state.locked !== null || (!state.own && edit === undefined) ? "true" : nothing
        }
        @click=${() => {
          if (state.locked === null && (state.own || edit !== undefined)) events.reset();
        }}
      >
        ↺
      </button>
    </span>
    <input
      type="range"
      min="0"
      max=${SLIDER_STEPS}
      step="1"
      tabindex="0"
      ?disabled=${state.locked !== null}
      aria-label="${field.label}, slider"
      aria-valuetext=${reading}
      .value=${live(String(toSlider(field, value)))}
      @input=${(event: InputEvent) => {
        events.slide(Number((event.currentTarget as HTMLInputElement).value));
      }}
      @change=${events.slid}
    />
    <span class="about soft" id="${id}-about">
      ${shown(field.least)} … ${shown(field.most)}, usual ${shown(field.usual)}
      <span class="chip ${state.from === "usual" ? "" : "set"}">
        ${edit === undefined ? state.from : edit === null ? "to be cleared" : "draft"}
      </span>
      ${field.prepared ? html`<span class="chip" title="Takes effect once it is prepared">body</span>` : nothing}
      <span class="doc ${state.explained ? "" : "on-focus"}">${field.doc}</span>
    </span>
    ${
      state.shadows > 0
        ? html`<span class="beside">
            ${state.shadows === 1 ? "One narrower scope has" : `${state.shadows} narrower scopes have`}
            a value of its own.
            <button class="plain" ?disabled=${state.locked !== null} @click=${events.clearShadows}>
              Clear ${state.shadows === 1 ? "it" : "them"}
            </button>
          </span>`
        : nothing
    }
    ${fault ? html`<span class="fault" id="${id}-fault">${fault.text}</span>` : nothing}
    ${
      state.beside
        ? html`<span class="beside warn" id="${id}-beside" role="status">
            ${state.beside.by ?? "Somebody else"} has set ${shown(state.beside.value)} meanwhile;
            yours is ${shown(value)}.
            <button @click=${events.takeTheirs}>Take ${shown(state.beside.value)}</button>
            <button @click=${events.keepMine}>Keep mine</button>
          </span>`
        : nothing
    }
  </div>`;
}

export const rowStyle = css`
  .field-row {
    display: grid;
    grid-template-columns: minmax(0, 1fr) auto;
    gap: 1px 8px;
    position: relative;
    padding: 4px 2px 4px 6px;
    border-left: 3px solid transparent;
    border-radius: 4px;
    align-content: start;
  }
  .field-row.edited {
    border-left-color: var(--accent);
    background: var(--accent-wash);
  }
  .field-row > label {
    align-self: center;
    font-weight: 600;
    hyphens: auto;
    line-height: 1.2;
  }
  .field-row .value {
    display: flex;
    align-items: center;
    gap: 4px;
  }
  .field-row .value input {
    width: 4.6em;
    padding: 2px 5px;
  }
  .field-row .value button {
    padding: 2px 4px;
  }
  .field-row .value button[aria-disabled="true"] {
    visibility: hidden;
  }
  .field-row .unit {
    min-width: 2.2em;
    font-size: 0.86em;
  }
  .field-row > input[type="range"],
  .field-row > .about,
  .field-row > .beside,
  .field-row > .fault {
    grid-column: 1 / -1;
    width: 100%;
    min-width: 0;
    margin: 0;
  }
  .field-row .about {
    font-size: 0.88em;
  }
  .field-row .doc {
    display: block;
  }
  .field-row:not(:focus-within) .on-focus {
    position: absolute;
    width: 1px;
    height: 1px;
    overflow: hidden;
    clip-path: inset(50%);
  }
  .chip.set {
    border-color: var(--accent);
  }
  .dot {
    display: inline-block;
    width: 7px;
    height: 7px;
    margin-right: 3px;
    border-radius: 50%;
    vertical-align: 1px;
  }
  .dot[data-on] {
    background: var(--accent);
  }
  [aria-invalid="true"] {
    border-color: var(--fault) !important;
  }
`;
