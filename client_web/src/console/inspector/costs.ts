/** The costs of paths, part by part, as bars beside each other. */

import { html, nothing, type TemplateResult } from "lit";
import type { Cost } from "../net/types";
import { styled } from "../style/styled";

export const PARTS: readonly (readonly [keyof Cost, string])[] = [
  ["time", "time"],
  ["risk", "risk by people"],
  ["others", "meeting actors"],
  ["turn", "turning"],
  ["wall", "near walls"],
  ["hurry", "hurrying"],
  ["keep_right", "keeping right"],
];

export interface CostColumn {
  title: string;
  cost: Cost;
}

/** The part of the longest bar that a value has, from 0 to 1. */
export function barPart(value: number | null, columns: readonly CostColumn[]): number {
  const values = columns.flatMap(({ cost }) => PARTS.map(([part]) => Math.abs(cost[part] ?? 0)));
  const most = Math.max(...values);
  return value === null || most <= 0 ? 0 : Math.min(1, Math.abs(value) / most);
}

export function secondsOf(value: number | null): string {
  return value === null ? "∞" : value.toFixed(2);
}

export function costBars(
  id: string,
  title: string,
  columns: readonly CostColumn[],
): TemplateResult {
  return html`<section aria-labelledby=${id}>
    <h3 id=${id}>${title}</h3>
    <table class="costs">
      <thead>
        <tr>
          <th scope="col">seconds</th>
          ${columns.map((column) => html`<th scope="col">${column.title}</th>`)}
        </tr>
      </thead>
      <tbody>
        ${PARTS.map(
          ([part, text]) =>
            html`<tr>
              <th scope="row" class="name">${text}</th>
              ${columns.map(
                ({ cost }) =>
                  html`<td>
                    ${secondsOf(cost[part])}
                    ${
                      cost[part]
                        ? html`<span
                            class=${`bar ${part}`}
                            ${styled({ width: `${100 * barPart(cost[part], columns)}%` })}
                          ></span>`
                        : nothing
                    }
                  </td>`,
              )}
            </tr>`,
        )}
        <tr>
          <th scope="row">in all</th>
          ${columns.map(({ cost }) => html`<td><strong>${secondsOf(cost.total)}</strong></td>`)}
        </tr>
      </tbody>
    </table>
  </section>`;
}
