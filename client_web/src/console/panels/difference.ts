/** Values in columns beside each other: the usual ones, presets, scopes, and moments of the past. */

import { css, html, nothing, type TemplateResult } from "lit";
import { comparing } from "../models/comparing";
import { shown } from "../models/fields";
import { scopeName } from "../models/scopes";
import { CommandingPanel } from "./commanding";

interface Difference {
  columns: readonly string[];
  rows: readonly { name: string; values: readonly (number | null)[] }[];
}

const MOST_COLUMNS = 4;

class DifferencePanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      td.other {
        font-weight: 600;
        background: var(--accent-wash);
      }
      select,
      input {
        max-width: 14em;
      }
    `,
  ];
  private found: Difference | null = null;
  private options: readonly string[] = ["default", "world"];
  private onlyDifferent = true;

  protected override begin(): void {
    this.watch(comparing, () => void this.load());
    this.hearAbout(/parameter|preset|group|revert|actor/, () => void this.load());
    void this.load();
  }

  protected override render(): TemplateResult {
    const columns = comparing.value;
    const rows = (this.found?.rows ?? []).filter(
      (row) => !this.onlyDifferent || new Set(row.values).size > 1,
    );
    return html`
      <div class="row">
        ${columns.map((column, index) => this.chooser(column, index))}
        ${
          columns.length < MOST_COLUMNS
            ? html`<button
                @click=${() => {
                  comparing.value = [...columns, "world"];
                }}
              >
                Add a column
              </button>`
            : nothing
        }
        <label>
          <input
            type="checkbox"
            .checked=${this.onlyDifferent}
            @change=${() => {
              this.onlyDifferent = !this.onlyDifferent;
              this.requestUpdate();
            }}
          />
          only what differs
        </label>
      </div>
      ${this.refused()}
      <div class="scroll" tabindex="0" role="region" aria-label="Parameters in columns">
        <table>
          <thead>
            <tr>
              <th scope="col">Parameter</th>
              ${(this.found?.columns ?? []).map(
                (column) => html`<th scope="col" class="number">${columnName(column)}</th>`,
              )}
            </tr>
          </thead>
          <tbody>
            ${rows.map(
              (row) =>
                html`<tr>
                  <th scope="row">${row.name}</th>
                  ${row.values.map(
                    (value) =>
                      html`<td class="number ${value === row.values[0] ? "" : "other"}">
                        ${value === null ? "—" : shown(value)}
                      </td>`,
                  )}
                </tr>`,
            )}
          </tbody>
        </table>
      </div>
      ${rows.length === 0 ? html`<p class="soft">They are all the same.</p>` : nothing}
    `;
  }

  private chooser(column: string, index: number): TemplateResult {
    const set = (value: string): void => {
      const next = [...comparing.value];
      if (value === "") next.splice(index, 1);
      else next[index] = value;
      comparing.value = next;
    };
    return html`<label class="field">
      Column ${index + 1}
      <input
        list="columns"
        .value=${column}
        @change=${(event: Event) => {
          set((event.currentTarget as HTMLInputElement).value.trim());
        }}
      />
      ${
        index === 0
          ? html`<datalist id="columns">
              ${this.options.map((one) => html`<option value=${one}>${columnName(one)}</option>`)}
            </datalist>`
          : nothing
      }
    </label>`;
  }

  private async load(): Promise<void> {
    const columns = comparing.value.join(",");
    const found = await this.ask<Difference>("/diff", { columns });
    if (found) this.found = found;
    const [parameters, presets] = await Promise.all([
      this.app.api.get<{ scopes: Record<string, unknown> }>("/parameters").catch(() => null),
      this.app.api.get<{ presets: { name: string }[] }>("/presets").catch(() => null),
    ]);
    const chosen = this.app.state.chosen.value.filter((id) => !id.startsWith("person:"));
    this.options = [
      ...new Set([
        ...["default", "world"],
        ...(presets?.presets ?? []).map((one) => `preset:${one.name}`),
        ...Object.keys(parameters?.scopes ?? {}),
        ...chosen.map((id) => `actor:${id}`),
      ]),
    ];
    this.requestUpdate();
  }
}

function columnName(column: string): string {
  if (column.startsWith("preset:")) return `preset ${column.slice("preset:".length)}`;
  if (column.startsWith("change:")) return `after change ${column.slice("change:".length)}`;
  return scopeName(column);
}

customElements.define("esp-difference", DifferencePanel);
