/** The parts of the inspector: the band of reasons, costs, parameters. */

import { html, nothing, type TemplateResult } from "lit";
import { labelOf, unitIn } from "../models/fields";
import type { WhySpan } from "../net/types";
import { reasonColour, reasonText } from "../state/reasons";
import { styled } from "../style/styled";
import { costBars } from "./costs";
import { compare, sourceText, valueText } from "./compare";
import type { WatchedActor } from "./watching";
import { piecesOf, secondsText, shares, SHOWN_S, spanText, stopsOf } from "./why";

const MOST_STOPS = 12;
export function whyBand(
  spans: readonly WhySpan[],
  tick: number,
  tickS: number,
  dark: boolean,
  hover: (agoS: number | null) => void,
): TemplateResult {
  const told = shares(spans)
    .map(([reason, seconds]) => `${reasonText(reason)} ${secondsText(seconds)}`)
    .join(", ");
  return html`<section aria-labelledby="why">
    <h3 id="why">Why, in the last ${SHOWN_S / 60} minutes</h3>
    <div
      class="band"
      role="img"
      aria-label=${told || "nothing is known yet"}
      @pointermove=${(event: PointerEvent) => {
        const box = (event.currentTarget as HTMLElement).getBoundingClientRect();
        hover(SHOWN_S * (1 - (event.clientX - box.left) / box.width));
      }}
      @pointerleave=${() => {
        hover(null);
      }}
    >
      ${piecesOf(spans, tick, tickS).map(
        ({ from, length, span }) =>
          html`<span
            title=${spanText(span)}
            ${styled({
              left: `${100 * from}%`,
              width: `${100 * length}%`,
              background: reasonColour(span.reason, dark),
            })}
          ></span>`,
      )}
    </div>
    <ol class="stops" tabindex="0" aria-label="What held it, the newest first">
      ${stopsOf(spans, MOST_STOPS).map(
        (span) =>
          html`<li>
            <span class="dot" ${styled({ background: reasonColour(span.reason, dark) })}></span>
            <span class="grow">${spanText(span)}</span>
            <span class="soft">${secondsText(Math.max(0, (tick - span.to_tick) * tickS))} ago</span>
          </li>`,
      )}
    </ol>
  </section>`;
}

/** The cost of the path now, and of the one before. */
export function costTable({ now }: WatchedActor): TemplateResult | typeof nothing {
  if (!now?.cost) return nothing;
  const columns = [{ title: "now", cost: now.cost }];
  const before = now.previous?.cost;
  if (before) columns.push({ title: "before", cost: before });
  return costBars("cost", "Cost of the path", columns);
}

/** Parameters of one actor, or of several beside each other. */
export function parameterTable(actors: readonly WatchedActor[]): TemplateResult | typeof nothing {
  const known = actors.filter(({ details }) => details !== null);
  if (known.length === 0) return nothing;
  const rows = compare(known.map(({ details }) => details?.parameters ?? {}));
  const several = known.length > 1;
  const shown = several ? rows.filter(({ differs }) => differs) : rows;
  return html`<section aria-labelledby="parameters">
    <h3 id="parameters">${several ? "Parameters that differ" : "Parameters"}</h3>
    <table>
      <thead>
        <tr>
          <th scope="col">name</th>
          ${known.map(({ details }) => html`<th scope="col">${several ? details?.name : "value"}</th>`)}
          ${several ? nothing : html`<th scope="col">from</th>`}
        </tr>
      </thead>
      <tbody>
        ${shown.map(
          ({ name, values }) =>
            html`<tr>
              <th scope="row" class="name">
                ${labelOf(name)} <span class="soft">${unitIn(name)}</span>
              </th>
              ${values.map(
                (source) =>
                  html`<td>
                    ${valueText(source?.value)}
                    ${several ? html`<span class="soft">${source ? sourceText(source) : nothing}</span>` : nothing}
                  </td>`,
              )}
              ${
                several
                  ? nothing
                  : html`<td class=${values[0]?.level === "default" ? "soft" : "set"}>
                      ${values[0] ? sourceText(values[0]) : nothing}
                    </td>`
              }
            </tr>`,
        )}
      </tbody>
    </table>
    ${several && shown.length === 0 ? html`<p class="soft">None.</p>` : nothing}
  </section>`;
}
