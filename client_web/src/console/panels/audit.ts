/** The audit: who did what, when, from where and why; filtered, paged, and taken away as a file. */

import { css, html, nothing, type TemplateResult } from "lit";
import { type Row, toCsv, toJsonLines } from "../models/export";
import { factText } from "../models/facts";
import { keepFile } from "../models/files";
import { typedMoment, utc } from "../models/times";
import { CommandingPanel } from "./commanding";

interface AuditRow {
  id: number | string;
  writer: string;
  seq: number;
  at_us: number;
  tick: number | null;
  command: string;
  account: string | null;
  role: string | null;
  address: string | null;
  target: string | null;
  outcome: string | null;
  refers_to: number | string | null;
  body: unknown;
  person: string | null;
  note: string | null;
  detail: unknown;
  hash: string;
}

interface AuditPage {
  rows: AuditRow[];
  next: string | null;
}

const COLUMNS = [
  ...["id", "writer", "seq", "at_us", "tick", "command", "account", "role", "address", "target"],
  ...["outcome", "refers_to", "body", "person", "note", "detail", "hash"],
];
const PAGE = 100;
/** A file of more rows is made on the command line, which does not hold them in memory. */
const MOST_EXPORTED = 20_000;

class AuditPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      td {
        font-size: 0.93em;
      }
      td.wide {
        min-width: 14em;
        overflow-wrap: anywhere;
      }
      td.when {
        white-space: nowrap;
      }
      tr.fails td {
        color: var(--fault);
      }
    `,
  ];
  private rows: AuditRow[] = [];
  private next: string | null = null;
  private filter: Record<string, string> = {};
  private since = "";
  private until = "";
  private open = new Set<AuditRow["id"]>();

  protected override begin(): void {
    void this.load();
  }

  protected override render(): TemplateResult {
    const why = this.whyNot("audit");
    if (why !== null) return html`<p>${why}</p>`;
    const text = (name: string, label: string): TemplateResult =>
      html`<label class="field grow">
        ${label}
        <input
          name=${name}
          .value=${this.filter[name] ?? ""}
          @change=${(event: Event) => {
            this.filter[name] = (event.currentTarget as HTMLInputElement).value.trim();
          }}
        />
      </label>`;
    const moment = (label: string, value: string, take: (text: string) => void): TemplateResult =>
      html`<label class="field">
        ${label}
        <input
          type="datetime-local"
          .value=${value}
          @change=${(event: Event) => {
            take((event.currentTarget as HTMLInputElement).value);
          }}
        />
      </label>`;
    return html`
      <form
        class="row"
        @submit=${(event: Event) => {
          event.preventDefault();
          void this.load();
        }}
      >
        ${text("account", "Account")} ${text("command", "Command")} ${text("target", "About")}
        ${moment("Since (UTC)", this.since, (value) => (this.since = value))}
        ${moment("Until (UTC)", this.until, (value) => (this.until = value))}
        <button type="submit">Filter</button>
      </form>
      <div class="row">
        <button @click=${() => void this.export("csv")}>Take away as CSV</button>
        <button @click=${() => void this.export("jsonl")}>as JSON lines</button>
        <button @click=${() => void this.verify()}>Verify the chains</button>
      </div>
      ${this.refused()}
      <div class="scroll" tabindex="0" role="region" aria-label="Rows of the audit">
        <table>
          <thead>
            <tr>
              ${["When (UTC)", "Who", "Command", "About", "Outcome", "Why", "Details"].map(
                (name) => html`<th scope="col">${name}</th>`,
              )}
            </tr>
          </thead>
          <tbody>
            ${this.rows.map((row) => this.row(row))}
          </tbody>
        </table>
      </div>
      ${this.rows.length === 0 ? html`<p class="soft">There is no such row.</p>` : nothing}
      ${
        this.next === null
          ? nothing
          : html`<button @click=${() => void this.older()}>Older rows</button>`
      }
    `;
  }

  private row(row: AuditRow): TemplateResult {
    const isOpen = this.open.has(row.id);
    return html`<tr
        class=${/refused|failed|wrong/.test(`${row.outcome} ${row.command}`) ? "fails" : ""}
      >
        <td class="when">${utc(row.at_us)}</td>
        <td>${row.account ?? "—"} <span class="soft">${row.role ?? ""}</span></td>
        <td>${row.command}</td>
        <td>${row.target ?? ""} ${row.person ?? ""}</td>
        <td>${row.outcome ?? ""}</td>
        <td>${row.note ?? ""}</td>
        <td>
          <button
            class="plain"
            aria-expanded=${isOpen}
            aria-label="${isOpen ? "less" : "more"} about row ${row.id}"
            @click=${() => {
              if (!this.open.delete(row.id)) this.open.add(row.id);
              this.requestUpdate();
            }}
          >
            ${isOpen ? "less" : "more"}
          </button>
        </td>
      </tr>
      ${
        isOpen
          ? html`<tr>
              <td class="wide" colspan="7">
                <dl>
                  <dt class="soft">
                    Row ${row.id}, ${row.writer} ${row.seq}, tick ${row.tick ?? "—"}
                  </dt>
                  <dd>${factText(row.body)} ${factText(row.detail)}</dd>
                  <dd class="soft">from ${row.address ?? "—"}; hash ${row.hash}</dd>
                </dl>
              </td>
            </tr>`
          : nothing
      }`;
  }

  private query(): Record<string, string | number | undefined> {
    const { account, command, target } = this.filter;
    return {
      account: account === "" ? undefined : account,
      command: command === "" ? undefined : command,
      target: target === "" ? undefined : target,
      since_us: typedMoment(`${this.since}Z`) ?? undefined,
      until_us: typedMoment(`${this.until}Z`) ?? undefined,
    };
  }

  private async load(): Promise<void> {
    if (this.whyNot("audit") !== null) return;
    const page = await this.ask<AuditPage>("/audit", { ...this.query(), limit: PAGE });
    if (!page) return;
    this.rows = page.rows;
    this.next = page.next;
    this.requestUpdate();
  }

  private async older(): Promise<void> {
    const query = { ...this.query(), after: this.next, limit: PAGE };
    const page = await this.ask<AuditPage>("/audit", query);
    if (!page) return;
    this.rows = [...this.rows, ...page.rows];
    this.next = page.next;
    this.requestUpdate();
  }

  private async export(kind: "csv" | "jsonl"): Promise<void> {
    const rows: AuditRow[] = [];
    let after: string | null | undefined;
    do {
      const query = { ...this.query(), after, limit: 500 };
      const page = await this.attempt(this.app.api.get<AuditPage>("/audit", query));
      if (!page) return;
      rows.push(...page.rows);
      after = page.next;
    } while (after !== null && rows.length < MOST_EXPORTED);
    if (after !== null) {
      this.app.toast(`These are the newest ${rows.length}; esplanade op audit gives all.`);
    }
    const plain = rows as unknown as Row[];
    if (kind === "csv") keepFile("audit.csv", toCsv(plain, COLUMNS), "text/csv");
    else keepFile("audit.jsonl", toJsonLines(plain), "application/jsonl");
  }

  private async verify(): Promise<void> {
    interface Verified {
      faults: { text: string }[];
      rows?: number;
      chains?: { writer: string; hash: string | null }[];
    }
    const found = await this.attempt(this.app.api.get<Verified>("/audit/verify"));
    if (!found) return;
    const [first] = found.faults;
    if (first) this.app.toast(first.text, "fault");
    else {
      const ends = (found.chains ?? []).map((one) => `${one.writer} ${one.hash ?? ""}`).join("; ");
      this.app.toast(`The audit is as it was written. ${ends}`, "done");
    }
  }
}

customElements.define("esp-audit", AuditPanel);
