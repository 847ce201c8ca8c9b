/** The controls above the map, and the legend in its corner. */

import { html, nothing, type TemplateResult } from "lit";
import { shown } from "../models/fields";
import { reasonColour, REASONS, reasonText } from "../state/reasons";
import { styled } from "../style/styled";
import type { Mode } from "./gestures";
import { CHOICES, HEAT_UNITS, type MapOptions, SWITCHES } from "./options";

export interface Toolbar {
  mode: Mode;
  options: MapOptions;
  storeys: readonly { z_m: number; name: string }[];
  only: number | null;
  following: boolean;
  mayFollow: boolean;
  setMode: (mode: Mode) => void;
  set: (change: Partial<MapOptions>) => void;
  show: (storey: number | null) => void;
  follow: (on: boolean) => void;
  zoom: (factor: number) => void;
  fit: () => void;
}

const MODES: readonly (readonly [Mode, string, string])[] = [
  ["pan", "Move", "Drag moves the map, a click chooses"],
  ["box", "Box", "Drag a box around those to choose; Shift does the same"],
  ["lasso", "Lasso", "Draw a line around those to choose; Alt does the same"],
];
const ZOOM = 1.4;

export function toolbar(bar: Toolbar): TemplateResult {
  return html`
    <span class="group" role="group" aria-label="What dragging does">
      ${MODES.map(
        ([mode, text, title]) =>
          html`<button
            aria-pressed=${bar.mode === mode ? "true" : "false"}
            title=${title}
            @click=${() => {
              bar.setMode(mode);
            }}
          >
            ${text}
          </button>`,
      )}
    </span>
    <span class="group">
      <button
        aria-label="Zoom in"
        @click=${() => {
          bar.zoom(ZOOM);
        }}
      >
        +
      </button>
      <button
        aria-label="Zoom out"
        @click=${() => {
          bar.zoom(1 / ZOOM);
        }}
      >
        −
      </button>
      <button @click=${bar.fit}>All</button>
    </span>
    <button
      aria-pressed=${bar.following ? "true" : "false"}
      ?disabled=${!bar.mayFollow}
      @click=${() => {
        bar.follow(!bar.following);
      }}
    >
      Follow
    </button>
    ${
      bar.storeys.length > 1
        ? html`<label
            >Floor
            <select
              @change=${(event: Event) => {
                const { value } = event.target as HTMLSelectElement;
                bar.show(value === "" ? null : Number(value));
              }}
            >
              <option value="" ?selected=${bar.only === null}>all</option>
              ${bar.storeys.map(
                ({ name }, index) =>
                  html`<option value=${index} ?selected=${bar.only === index}>${name}</option>`,
              )}
            </select></label
          >`
        : nothing
    }
    <details>
      <summary>Layers</summary>
      <div>
        ${select(bar, "tags", "Tags")} ${select(bar, "trailS", "Trails")}
        ${select(bar, "heat", "Heat map")}
        ${bar.options.heat === "none" ? nothing : select(bar, "heatS", "Heat of the last")}
        ${(Object.keys(SWITCHES) as (keyof typeof SWITCHES)[]).map(
          (name) =>
            html`<label
              ><input
                type="checkbox"
                .checked=${bar.options[name]}
                @change=${(event: Event) => {
                  bar.set({ [name]: (event.target as HTMLInputElement).checked });
                }}
              />${SWITCHES[name]}</label
            >`,
        )}
      </div>
    </details>
  `;
}

function select(bar: Toolbar, name: keyof typeof CHOICES, label: string): TemplateResult {
  const choices: readonly (readonly [string | number, string])[] = CHOICES[name];
  return html`<label
    >${label}
    <select
      @change=${(event: Event) => {
        const index = (event.target as HTMLSelectElement).selectedIndex;
        bar.set({ [name]: choices[index]?.[0] });
      }}
    >
      ${choices.map(
        ([value, text]) => html`<option ?selected=${bar.options[name] === value}>${text}</option>`,
      )}
    </select></label
  >`;
}

/** The meanings of the colours. */
export function legend(
  options: MapOptions,
  heatMost: number | null,
  dark: boolean,
): TemplateResult {
  return html`<div class="legend row">
    <span><span class="dot person"></span>person</span>
    ${REASONS.slice(1).map(
      (reason) =>
        html`<span
          ><span class="dot" ${styled({ background: reasonColour(reason, dark) })}></span
          >${reasonText(reason)}</span
        >`,
    )}
    ${
      options.heat === "none" || heatMost === null
        ? nothing
        : html`<span class="row"
            >${options.heat} 0
            <canvas class="scale" width="60" height="10" aria-hidden="true"></canvas
            >${shown(Number(heatMost.toPrecision(2)))} ${HEAT_UNITS[options.heat]}</span
          >`
    }
  </div>`;
}
