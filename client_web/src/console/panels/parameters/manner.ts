/** How a change comes about: slowly over some seconds, and with a guard that takes it back. */

import { html, nothing, type TemplateResult } from "lit";

export interface Manner {
  overS: string;
  figure: string;
  side: "above" | "below";
  limit: string;
  forS: string;
  /** The fields of a command that say so. */
  command: { over_s?: number; guard?: Record<string, string | number> };
}

export function manner(): Manner {
  return { overS: "", figure: "", side: "above", limit: "", forS: "10", command: {} };
}

/** The meaning of the typed texts; a text that is no number yet means nothing. */
export function withCommand(given: Manner): Manner {
  const over = Number(given.overS);
  const limit = Number(given.limit);
  const span = Number(given.forS);
  const command: Manner["command"] = {};
  if (given.overS.trim() !== "" && over > 0) command.over_s = over;
  if (given.figure !== "" && given.limit.trim() !== "" && Number.isFinite(limit) && span >= 0) {
    command.guard = { figure: given.figure, [given.side]: limit, for_s: span };
  }
  return { ...given, command };
}

export function mannerForm(
  now: Manner,
  figures: readonly string[],
  change: (next: Manner) => void,
): TemplateResult {
  const take =
    (name: "overS" | "figure" | "side" | "limit" | "forS") =>
    (event: Event): void => {
      const { value } = event.currentTarget as HTMLInputElement | HTMLSelectElement;
      change(withCommand({ ...now, [name]: value }));
    };
  const number = (name: "overS" | "limit" | "forS", label: string): TemplateResult =>
    html`<input
      class="short number"
      type="number"
      min="0"
      step="any"
      aria-label=${label}
      .value=${now[name]}
      @input=${take(name)}
    />`;
  const { over_s, guard } = now.command;
  const said = [over_s === undefined ? "" : `over ${over_s} s`, guard ? "guarded" : ""];
  return html`<details>
    <summary>
      Slowly, or with a guard
      ${said.some(Boolean) ? html`(${said.filter(Boolean).join(", ")})` : nothing}
    </summary>
    <p class="row">
      <label>Change linearly over ${number("overS", "Seconds of the ramp")} s</label>
    </p>
    <p class="row">
      <label>
        Take it back if
        <select aria-label="Figure that guards the change" @change=${take("figure")}>
          <option value="">(no guard)</option>
          ${figures.map((name) => html`<option ?selected=${name === now.figure}>${name}</option>`)}
        </select>
      </label>
      <select aria-label="Above or below" @change=${take("side")}>
        <option ?selected=${now.side === "above"}>above</option>
        <option ?selected=${now.side === "below"}>below</option>
      </select>
      ${number("limit", "Limit of the figure")} for ${number("forS", "Seconds beyond the limit")} s
    </p>
  </details>`;
}
