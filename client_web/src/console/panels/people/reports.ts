/** The inbox: what people in the world report about others. */

import { css, html, nothing, type TemplateResult } from "lit";
import { clock } from "../../models/times";
import type { Point } from "../../net/types";
import { CommandingPanel } from "../commanding";

interface Report {
  id: number;
  at_us: number;
  reporter: { id: number; name: string } | string | null;
  person: number | null;
  name: string | null;
  line?: number | null;
  said?: string | null;
  text: string;
  place?: Point | null;
  state: "open" | "done";
  settled_by?: string | null;
}

class ReportsPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      li {
        padding: 6px 0;
        border-bottom: 1px solid var(--line);
      }
      li.done {
        color: var(--soft-ink);
      }
      blockquote {
        margin: 2px 0 2px 8px;
        padding-left: 8px;
        border-left: 3px solid var(--line);
        overflow-wrap: anywhere;
      }
    `,
  ];
  private reports: readonly Report[] = [];
  private onlyOpen = true;
  private readonly notes = new Map<number, string>();

  protected override begin(): void {
    this.hear("events", { kinds: ["report"] }, () => void this.load());
    this.hearAbout(/report/, () => void this.load());
    void this.load();
  }

  protected override render(): TemplateResult {
    const shown = this.reports.filter((report) => !this.onlyOpen || report.state === "open");
    return html`
      <label>
        <input
          type="checkbox"
          .checked=${this.onlyOpen}
          @change=${() => {
            this.onlyOpen = !this.onlyOpen;
            this.requestUpdate();
          }}
        />
        only open ones
      </label>
      ${this.refused()}
      <ol class="plain" aria-label="Reports, the newest first">
        ${shown.map((report) => this.row(report))}
      </ol>
      ${shown.length === 0 ? html`<p class="soft">The inbox is empty.</p>` : nothing}
    `;
  }

  private row(report: Report): TemplateResult {
    const { reporter } = report;
    const by = typeof reporter === "object" ? (reporter?.name ?? "somebody") : reporter;
    return html`<li class=${report.state}>
      <div class="row">
        <span class="soft">${clock(report.at_us)}</span>
        <span class="grow"><b>${by}</b> about <b>${report.name ?? "nobody by name"}</b></span>
        ${
          report.state === "done"
            ? html`<span class="chip"
                >done${report.settled_by ? `, ${report.settled_by}` : ""}</span
              >`
            : nothing
        }
      </div>
      <div>${report.text}</div>
      ${report.said ? html`<blockquote>${report.said}</blockquote>` : nothing}
      <div class="row">
        <button
          @click=${() => {
            if (report.place) {
              const [x, y, z] = report.place;
              this.app.state.lookAt.value = [x, y, z];
            }
            if (report.person !== null) this.app.choose(`person:${report.person}`);
          }}
        >
          Show
        </button>
        ${report.state === "open" ? this.settling(report) : nothing}
        ${
          report.line && report.state === "open"
            ? this.button("Take the line away", "hide_line", () =>
                this.carryOut({ op: "hide_line", line: report.line }, "The line is taken away."),
              )
            : nothing
        }
      </div>
    </li>`;
  }

  private settling(report: Report): TemplateResult {
    return html`<label class="grow">
        <span class="visually-hidden">What was done about report ${report.id}</span>
        <input
          class="grow"
          maxlength="500"
          placeholder="What was done about it?"
          .value=${this.notes.get(report.id) ?? ""}
          @input=${(event: Event) => {
            this.notes.set(report.id, (event.currentTarget as HTMLInputElement).value);
          }}
        />
      </label>
      ${this.button("Done", "settle_report", () => this.settle(report.id), {
        label: `Done with report ${report.id}`,
      })}`;
  }

  private async settle(report: number): Promise<void> {
    const note = this.notes.get(report)?.trim();
    const command = { op: "settle_report", report };
    const answer = await this.carryOut(note ? { ...command, note } : command, "It is noted.");
    if (answer) this.notes.delete(report);
    await this.load();
  }

  private async load(): Promise<void> {
    const found = await this.ask<{ reports: Report[] }>("/reports");
    if (found) this.reports = found.reports;
    this.requestUpdate();
  }
}

customElements.define("esp-reports", ReportsPanel);
