/** The part of the inspector on how an actor searches, with what is drawn of it on the map. */

import { html, nothing, type TemplateResult } from "lit";
import type { PricedPath, Trace } from "../net/types";
import { costBars, type CostColumn } from "./costs";
import { countNodes, mostRisk, type ColourBy, type TraceView } from "./tree";
import { blockerText } from "./why";

const WORDS: Readonly<Record<string, string>> = {
  found: "The search reached its horizon",
  partial: "The search ended before its horizon",
  no_path: "The search found no path that is better",
};
const COLOURS: readonly (readonly [ColourBy, string])[] = [
  ["order", "order"],
  ["time", "time ahead"],
];

export function searchPart(
  trace: Trace | null,
  view: TraceView,
  ask: () => void,
  show: (view: TraceView | null) => void,
): TemplateResult {
  return html`<section aria-labelledby="search">
    <h3 id="search">How it searches</h3>
    <div class="row">
      <button @click=${ask}>${trace ? "Ask again" : "Show the search and the risk"}</button>
      ${
        trace
          ? html`<button
              @click=${() => {
                show(null);
              }}
            >
              Hide
            </button>`
          : nothing
      }
    </div>
    ${trace ? traceFacts(trace, view, show) : nothing}
  </section>`;
}

/** The paths that were compared, those that are the same but once. */
export function comparedPaths(trace: Trace): CostColumn[] {
  const { previous, perturbed, searched } = trace;
  const columns: CostColumn[] = [{ title: "taken", cost: trace.cost }];
  const add = (title: string, path: PricedPath | null): void => {
    const known = columns.some(({ cost }) => JSON.stringify(cost) === JSON.stringify(path?.cost));
    if (path && !known) columns.push({ title, cost: path.cost });
  };
  add("before", previous);
  add("bent", perturbed);
  add("searched", searched);
  return columns;
}

/** The greatest risk, which has the darkest colour if it is no mere trifle. */
function riskText(most: number): string {
  return most < 0.005 ? "next to none" : `at most ${most.toFixed(2)}`;
}

function traceFacts(
  trace: Trace,
  view: TraceView,
  show: (view: TraceView) => void,
): TemplateResult {
  const { expanded, open } = countNodes(trace);
  const { by } = view;
  const words = WORDS[trace.status] ?? trace.status;
  return html`
    <p>
      Tick ${trace.tick}: ${trace.why.text}.
      ${trace.blocker ? html`It is held by ${blockerText(trace.blocker)}.` : nothing}
    </p>
    <p>
      ${words}, with ${trace.expansions} of ${trace.budget} expansions. Nodes on the map:
      ${expanded} expanded, from blue (${by === "order" ? "first" : "now"}) to orange
      (${by === "order" ? "last" : "furthest ahead"}); ${open} left open.
    </p>
    ${
      trace.exact
        ? nothing
        : html`<p class="warn">
            The ground has changed since: it would decide otherwise now than it has.
          </p>`
    }
    <div class="row" role="group" aria-label="Colour of the search">
      ${COLOURS.map(
        ([by, text]) =>
          html`<button
            aria-pressed=${view.by === by ? "true" : "false"}
            @click=${() => {
              show({ ...view, by });
            }}
          >
            Colour by ${text}
          </button>`,
      )}
    </div>
    ${
      trace.risk.length > 0
        ? html`<label class="slice"
            >Risk in ${(trace.risk[view.slice]?.t_s ?? 0).toFixed(1)} s
            <input
              type="range"
              min="0"
              max=${trace.risk.length - 1}
              .value=${String(view.slice)}
              @input=${(event: Event) => {
                show({ ...view, slice: Number((event.target as HTMLInputElement).value) });
              }}
            /><span class="soft">${riskText(mostRisk(trace))}</span></label
          >`
        : nothing
    }
    ${costBars("compared", "Paths that were compared", comparedPaths(trace))}
  `;
}
