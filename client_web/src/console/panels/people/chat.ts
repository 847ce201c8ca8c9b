/** The last lines of chat, each of which may be taken away, and the rules of chat. */

import { css, html, nothing, type TemplateResult } from "lit";
import { clock } from "../../models/times";
import { CommandingPanel } from "../commanding";
import { pick } from "../pick";

interface Line {
  line: number;
  at_us: number;
  id: number;
  name: string;
  text: string;
  hidden: boolean;
  seen_by: number;
}

interface Rules {
  slow_mode_s: number;
  words: readonly string[];
  action: "mask" | "refuse";
  quiet_zones: readonly { name: string }[];
}

const REFRESH_MS = 3000;

class ChatPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      li {
        display: grid;
        grid-template-columns: auto 1fr auto;
        gap: 8px;
        padding: 3px 0;
        border-bottom: 1px solid var(--line);
      }
      li.hidden .said {
        text-decoration: line-through;
        color: var(--soft-ink);
      }
      .said {
        overflow-wrap: anywhere;
      }
    `,
  ];
  private lines: readonly Line[] = [];
  private keeps = true;
  private rules: Rules | null = null;
  private words: string | null = null;

  protected override begin(): void {
    this.hear("events", { kinds: ["chat"] }, () => void this.load());
    this.hearAbout(/line|slow|word|quiet|people|chat/, () => void this.load());
    this.every(REFRESH_MS, () => void this.load());
    void this.load();
  }

  protected override render(): TemplateResult {
    return html`
      ${this.refused()}
      ${
        this.keeps
          ? nothing
          : html`<p class="soft">This server keeps no chat: it would with --keep-chat.</p>`
      }
      <ol class="plain" aria-label="Lines of chat, the newest first">
        ${this.lines.map((line) => this.row(line))}
      </ol>
      ${this.rules ? this.ruleForm(this.rules) : nothing}
    `;
  }

  private row(line: Line): TemplateResult {
    return html`<li class=${line.hidden ? "hidden" : ""}>
      <span class="soft">${clock(line.at_us)}</span>
      <span class="said">
        <button
          class="plain"
          @click=${() => {
            this.app.choose(`person:${line.id}`);
          }}
        >
          ${line.name}
        </button>
        ${line.text} <span class="soft">seen by ${line.seen_by}</span>
      </span>
      ${
        line.hidden
          ? html`<span class="chip">taken away</span>`
          : this.button(
              "Take away",
              "hide_line",
              () => this.carryOut({ op: "hide_line", line: line.line }).then(() => this.load()),
              { label: `Take away the line of ${line.name}: ${line.text}` },
            )
      }
    </li>`;
  }

  private ruleForm(rules: Rules): TemplateResult {
    const words = this.words ?? rules.words.join(" ");
    return html`<fieldset>
      <legend>Rules of chat</legend>
      <div class="row">
        <label>
          One line in
          <select
            @change=${(event: Event) => {
              const seconds = Number((event.currentTarget as HTMLSelectElement).value);
              void this.carryOut({ op: "slow_mode", seconds }, "The rule holds from now on.");
            }}
            ?disabled=${this.whyNot("slow_mode") !== null}
          >
            ${[...new Set([0, 2, 5, 15, 60, rules.slow_mode_s])].map(
              (each) =>
                html`<option value=${each} ?selected=${each === rules.slow_mode_s}>
                  ${each === 0 ? "no time (off)" : `${each} s`}
                </option>`,
            )}
          </select>
        </label>
      </div>
      <div class="row">
        <label class="field grow">
          Words that are not said here
          <input
            .value=${words}
            @input=${(event: Event) => {
              this.words = (event.currentTarget as HTMLInputElement).value;
              this.requestUpdate();
            }}
          />
        </label>
        ${this.button("Mask them", "word_filter", () => this.filter("mask"))}
        ${this.button("Refuse such lines", "word_filter", () => this.filter("refuse"))}
      </div>
      <div class="row">
        <span>Quiet zones:</span>
        ${rules.quiet_zones.map(
          ({ name }) =>
            html`<span class="chip">${name}</span> ${this.button(
                "✕",
                "quiet_zone",
                () =>
                  this.carryOut({ op: "quiet_zone", name, remove: true }, `${name} is gone.`).then(
                    () => this.load(),
                  ),
                { plain: true, label: `Take the quiet zone ${name} away` },
              )}`,
        )}
        ${this.button("Draw one on the map", "quiet_zone", () => this.quiet())}
      </div>
    </fieldset>`;
  }

  private async filter(action: "mask" | "refuse"): Promise<void> {
    const words = (this.words ?? this.rules?.words.join(" ") ?? "").split(/[\s,]+/).filter(Boolean);
    const answer = await this.carryOut(
      { op: "word_filter", words, action },
      "The words are noted.",
    );
    if (answer) this.words = null;
    await this.load();
  }

  private async quiet(): Promise<void> {
    const ring = await pick(this.app, "Click the corners of the quiet zone", "ring");
    const [first] = ring ?? [];
    if (!ring || ring.length < 3 || !first) return;
    const name = `zone ${(this.rules?.quiet_zones.length ?? 0) + 1}`;
    const polygon = ring.map(([x, y]) => [x, y]);
    await this.carryOut(
      { op: "quiet_zone", name, polygon, storey_m: first[2] },
      `${name} is quiet.`,
    );
    await this.load();
  }

  private async load(): Promise<void> {
    const found = await this.ask<{ lines: Line[]; keeps_chat?: boolean }>("/chat");
    if (!found) return;
    this.lines = found.lines;
    this.keeps = found.keeps_chat ?? true;
    this.rules = (await this.ask<Rules>("/moderation")) ?? this.rules;
    this.requestUpdate();
  }
}

customElements.define("esp-chat", ChatPanel);
