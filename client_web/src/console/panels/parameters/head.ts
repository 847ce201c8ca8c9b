/** Above the form of parameters: the scope that is edited, and the parameters that are shown. */

import { html, nothing, type TemplateResult } from "lit";
import type { ParameterWork } from "../../models/parameterwork";
import { groupsOf, scopeName, shortId } from "../../models/scopes";
import { searchField } from "../fields";

export interface Shown {
  /** The actors that are chosen on the map. */
  chosen: readonly string[];
  /** The words that a parameter must have to be shown. */
  sought: string;
  /** Whether each parameter is explained. */
  explained: boolean;
  seek: (words: string) => void;
  explain: (on: boolean) => void;
}

export function head(work: ParameterWork, shown: Shown): TemplateResult {
  const groups = new Set(
    work.actors.flatMap((actor) => groupsOf(actor).map((name) => `group:${name}`)),
  );
  for (const scope of Object.keys(work.answer?.scopes ?? {})) {
    if (scope.startsWith("group:")) groups.add(scope);
  }
  if (work.scope.startsWith("group:")) groups.add(work.scope);
  const edited = new Set(work.edited);
  const option = (scope: string): TemplateResult =>
    html`<option value=${scope} ?selected=${scope === work.scope}>
      ${scopeName(scope, work.actors)}${edited.has(scope) ? " •" : ""}
    </option>`;
  const actors = work.actors.map((actor) => `actor:${actor.id}`);
  const chosen = shown.chosen.find((id) => actors.includes(`actor:${id}`));
  return html`<div class="row head">
    <label class="field grow">
      Scope
      <select
        name="scope"
        @change=${(event: Event) => {
          work.choose((event.currentTarget as HTMLSelectElement).value);
        }}
      >
        ${option("world")}
        <optgroup label="Groups">${[...groups].sort().map(option)}</optgroup>
        <optgroup label="Actors">
          ${
            actors.includes(work.scope) || !work.scope.startsWith("actor:")
              ? nothing
              : option(work.scope)
          }
          ${actors.map(option)}
        </optgroup>
      </select>
    </label>
    ${searchField("Find", shown.sought, shown.seek)}
    ${
      chosen !== undefined && work.scope !== `actor:${chosen}`
        ? html`<button
            @click=${() => {
              work.choose(`actor:${chosen}`);
            }}
          >
            Tune ${shortId(chosen)}
          </button>`
        : nothing
    }
    <label>
      <input
        type="checkbox"
        .checked=${shown.explained}
        @change=${() => {
          shown.explain(!shown.explained);
        }}
      />
      explain
    </label>
  </div>`;
}
