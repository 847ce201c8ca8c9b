/** Below the form of parameters: what the draft comes to, and what can be done with it. */

import { html, type TemplateResult } from "lit";
import { outOfRange, shown } from "../../models/fields";
import type { ParameterWork } from "../../models/parameterwork";
import { scopeName } from "../../models/scopes";
import type { ButtonLook } from "../commanding";
import { type Manner, mannerForm } from "./manner";
import { noteField } from "../fields";

export interface Acts {
  button: (text: string, needs: string, press: () => unknown, look?: ButtonLook) => TemplateResult;
  apply: () => Promise<void>;
  undo: () => Promise<void>;
  redo: () => Promise<void>;
  /** Whether a slider sends while it is dragged. */
  liveDrag: boolean;
  dragLive: (on: boolean) => void;
  how: Manner;
  figures: readonly string[];
  change: (how: Manner) => void;
}

export function foot(work: ParameterWork, acts: Acts): TemplateResult {
  const { draft } = work;
  const count = draft.names.length;
  const wrong = draft.names.find((name) => {
    const field = work.fields.find((one) => one.name === name);
    const edit = draft.edit(name);
    return field && typeof edit === "number" && outOfRange(field, edit) !== null;
  });
  const blocked = count === 0 ? "There is nothing to apply." : null;
  return html`<div class="foot">
    <p class="state" role="status">
      ${
        count === 0
          ? "No draft."
          : html`<b>${count} ${count === 1 ? "edit" : "edits"}</b> for
              ${scopeName(work.scope, work.actors)}; ${priceText(work, wrong !== undefined)}`
      }
      ${work.edited
        .filter((scope) => scope !== work.scope)
        .map(
          (scope) =>
            html` <button
              class="plain"
              @click=${() => {
                work.choose(scope);
              }}
            >
              and a draft for ${scopeName(scope, work.actors)}
            </button>`,
        )}
    </p>
    ${work.faults.map((fault) => html`<p class="fault" role="alert">${fault.text}</p>`)}
    <div class="row">
      ${noteField(work.note, (text) => {
        work.note = text;
      })}
      ${acts.button("Apply", "set_parameters", () => acts.apply(), {
        ...{ main: true, blocked, keys: "Control+Enter" },
      })}
    </div>
    <div class="row">
      ${acts.button(
        "Discard",
        "watch",
        () => {
          draft.discard();
          work.touched();
        },
        { blocked },
      )}
      ${acts.button(draft.canUndo ? "Undo edit" : "Undo", "set_parameters", () => acts.undo(), {
        ...{ keys: "Control+Z", label: draft.canUndo ? "Undo edit" : "Undo my latest change" },
      })}
      ${acts.button(draft.canRedo ? "Redo edit" : "Redo", "set_parameters", () => acts.redo(), {
        ...{ keys: "Control+Shift+Z", label: draft.canRedo ? "Redo edit" : "Redo what I undid" },
      })}
      <label title="Send while a slider is dragged, at most ten times a second">
        <input
          type="checkbox"
          .checked=${acts.liveDrag}
          @change=${() => {
            acts.dragLive(!acts.liveDrag);
          }}
        />
        live drag
      </label>
    </div>
    ${mannerForm(acts.how, acts.figures, acts.change)}
  </div>`;
}

function priceText(work: ParameterWork, wrong: boolean): string {
  const { price, prepareSeconds, isFlying } = work.draft;
  if (isFlying) return "being applied …";
  if (wrong || work.faults.length > 0) return "it cannot be applied.";
  if (price === "tick") return "takes effect at once.";
  if (price === "prepared") {
    if (prepareSeconds === null) return "needs a moment of preparation.";
    return `needs ${shown(Number(prepareSeconds.toPrecision(2)))} s of preparation.`;
  }
  return work.draft.names.some((name) => work.draft.fault(name) !== null)
    ? "it cannot be applied."
    : "being checked …";
}
