/** Changes that were made, the newest first, each with its values and a way to take it back. */

import { css, html, nothing, type TemplateResult } from "lit";
import { type Facts, factText, subjectName, touched } from "../models/facts";
import { clock } from "../models/times";
import type { LiveMessage } from "../net/live";
import { CommandingPanel } from "./commanding";

export interface ChangeRow {
  number: number;
  at_us: number;
  tick: number | null;
  account: string | null;
  op: string;
  before?: Facts;
  after?: Facts;
  subjects?: readonly string[];
  note?: string | null;
  reverts?: number | null;
  reverted_by?: number | null;
  can_revert?: boolean;
}

const PAGE = 50;
const MOST = 1000;

class ChangesPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      li {
        padding: 6px 0;
        border-bottom: 1px solid var(--line);
      }
      li.reverted .values {
        text-decoration: line-through;
      }
      .values {
        overflow-wrap: anywhere;
      }
    `,
  ];
  private rows: ChangeRow[] = [];
  private whose = "";
  private hasMore = false;

  protected override begin(): void {
    void this.load();
    this.hear("changes", {}, (message: LiveMessage & { change?: ChangeRow }) => {
      if (message.change) void this.load();
    });
    this.watch(this.app.live.phase, (phase) => {
      if (phase === "on") void this.load();
    });
  }

  protected override render(): TemplateResult {
    const accounts = [...new Set(this.rows.map((row) => row.account ?? "the server"))].sort();
    const rows = this.rows.filter(
      (row) => !this.whose || (row.account ?? "the server") === this.whose,
    );
    return html`
      <div class="row">
        ${this.button("Undo", "revert", () => this.revert("latest"), { label: "Undo my latest change" })}
        ${this.button("Redo", "revert", () => this.revert("undone"), { label: "Redo what I undid" })}
        <label>
          by
          <select
            @change=${(event: Event) => {
              this.whose = (event.currentTarget as HTMLSelectElement).value;
              this.requestUpdate();
            }}
          >
            <option value="">everybody</option>
            ${accounts.map((name) => html`<option ?selected=${name === this.whose}>${name}</option>`)}
          </select>
        </label>
      </div>
      ${this.refused()}
      <ol class="plain" aria-label="Changes, the newest first">
        ${rows.map((row) => this.row(row))}
      </ol>
      ${rows.length === 0 ? html`<p class="soft">Nothing has been changed since the start.</p>` : nothing}
      ${this.hasMore ? html`<button @click=${() => void this.older()}>Older ones</button>` : nothing}
    `;
  }

  private row(row: ChangeRow): TemplateResult {
    const values = touched(row.before ?? null, row.after ?? null);
    const blocked = row.reverted_by
      ? `It is taken back by change ${row.reverted_by}.`
      : row.can_revert === false
        ? "Somebody has changed one of these values since."
        : null;
    return html`<li class=${row.reverted_by ? "reverted" : ""}>
      <div class="row">
        <b>#${row.number}</b>
        <span>${clock(row.at_us)}</span>
        <span class="chip">${row.account ?? "the server"}</span>
        <span class="grow">${row.op.replaceAll("_", " ")}</span>
        ${this.button("Undo", "revert", () => this.revert(row.number), {
          ...{ plain: true, blocked, label: `Undo change ${row.number}` },
        })}
      </div>
      <div class="values">
        ${values.slice(0, 6).map(
          (one) =>
            html`<div>
              ${one.field}
              <span class="soft">${factText(one.before)} →</span> ${factText(one.after)}
              <span class="soft">(${subjectName(one.subject)})</span>
            </div>`,
        )}
        ${values.length > 6 ? html`<span class="soft">and ${values.length - 6} more</span>` : nothing}
      </div>
      ${row.note ? html`<div class="soft">“${row.note}”</div>` : nothing}
      ${row.reverts ? html`<div class="soft">takes back change ${row.reverts}</div>` : nothing}
    </li>`;
  }

  private async load(): Promise<void> {
    const limit = Math.max(PAGE, Math.min(this.rows.length, MOST));
    const found = await this.ask<{ changes: ChangeRow[] }>("/changes", { limit });
    if (!found) return;
    this.rows = found.changes;
    this.hasMore = found.changes.length === limit;
    this.requestUpdate();
  }

  private async older(): Promise<void> {
    const after = this.rows.at(-1)?.number;
    const found = await this.ask<{ changes: ChangeRow[] }>("/changes", { after, limit: PAGE });
    if (!found) return;
    this.rows = [...this.rows, ...found.changes];
    this.hasMore = found.changes.length === PAGE;
    this.requestUpdate();
  }

  private async revert(change: number | "latest" | "undone"): Promise<void> {
    const done = change === "undone" ? "It is made anew." : "It is taken back.";
    await this.carryOut({ op: "revert", change }, done);
    await this.load();
  }
}

customElements.define("esp-changes", ChangesPanel);
