/** Figures of the world over time: chosen ones, each with a line for every change. */

import { html, nothing, type TemplateResult } from "lit";
import { summary } from "../../models/facts";
import { labelOf, shown } from "../../models/fields";
import { shortId } from "../../models/scopes";
import { type SeriesAnswer, SeriesWindow, STEPS } from "../../models/series";
import { clock } from "../../models/times";
import type { LiveMessage } from "../../net/live";
import type { ChangeRow } from "../changes";
import { CommandingPanel } from "../commanding";
import { Charts } from "./charts";
import { seriesStyle } from "./seriesstyle";

interface SeriesName {
  name: string;
  unit: string;
  text: string;
}

interface Figures extends LiveMessage {
  at_us: number;
  values: Record<string, number | null>;
}

interface ActorNews extends LiveMessage {
  speed: number;
  cost?: { total?: number | null } | null;
}

const KEPT = "esplanade-console-series";
const USUAL = ["people", "contacts", "waiting_s", "tick_p99_ms"];
const MOST = 12;

class SeriesPanel extends CommandingPanel {
  static override styles = [...CommandingPanel.styles, ...seriesStyle];
  private names: readonly SeriesName[] = [];
  private chosen: string[] = USUAL;
  private step = 0;
  /** Up to where the window has been asked for. */
  private loadedUs = 0;
  private window = new SeriesWindow(STEPS[0].stepS, STEPS[0].spanS);
  private readonly charts = new Charts(this, {
    data: (name) => this.window.data([name]),
    marks: () => this.window.marks,
    hover: (us) => {
      this.app.state.hovered.value = us;
    },
  });
  private readonly pinned = new Map<string, () => void>();

  protected override begin(): void {
    const { live, state } = this.app;
    void this.prepare();
    this.hear("series", {}, (message: Figures) => {
      // The server tells the value of a longer step once that step is over.
      if (this.window.stepS === 1) {
        this.window.append(message.at_us, message.values);
        this.draw();
      } else if (this.window.endUs(message.at_us) > this.loadedUs) void this.load(message.at_us);
    });
    this.hear("changes", {}, (message: LiveMessage & { change?: ChangeRow }) => {
      const { change } = message;
      if (!change) return;
      const text = `${change.op.replaceAll("_", " ")}: ${summary(change.before ?? null, change.after ?? null)}`;
      this.window.mark({ atUs: change.at_us, text, account: change.account });
    });
    this.watch(live.phase, (phase) => {
      if (phase === "on") void this.load();
    });
    this.watch(state.chosen);
    this.watch(state.hovered, (us) => {
      this.charts.point(us);
      this.requestUpdate();
    });
    const scheme = matchMedia("(prefers-color-scheme: dark)");
    const anew = (): void => {
      this.charts.clear();
      this.requestUpdate();
    };
    scheme.addEventListener("change", anew);
    const sizes = new ResizeObserver(() => {
      this.charts.resize();
    });
    sizes.observe(this);
    this.atEnd(() => {
      scheme.removeEventListener("change", anew);
      sizes.disconnect();
      for (const stop of this.pinned.values()) stop();
      this.pinned.clear();
      this.charts.clear();
    });
  }

  protected override render(): TemplateResult {
    const actor = this.app.state.chosen.value.find((id) => !id.startsWith("person:"));
    return html`
      <div class="row">
        <div class="row" role="group" aria-label="How long">
          ${STEPS.map(
            (step, index) =>
              html`<button
                aria-pressed=${index === this.step}
                title="In steps of ${step.step}"
                @click=${() => {
                  this.step = index;
                  void this.load();
                }}
              >
                ${step.label}
              </button>`,
          )}
        </div>
        ${
          actor !== undefined && !this.pinned.has(actor)
            ? html`<button
                @click=${() => {
                  this.pin(actor);
                }}
              >
                Pin ${shortId(actor)}
              </button>`
            : nothing
        }
        <span class="told grow" role="status">${this.told()}</span>
      </div>
      <details>
        <summary>Choose series (${this.chosen.length})</summary>
        <div class="choice">${this.names.map((one) => this.choice(one))}</div>
      </details>
      ${this.refused()}
      <div class="charts">
        ${this.chosen.map((name) => {
          const known = this.names.find((one) => one.name === name);
          return html`<figure data-series=${name} aria-label="Chart of ${known?.text ?? name}">
            <figcaption>
              <b title=${known?.text ?? name}>${labelOf(name)}</b>
              <span>${this.value(name)} ${unitOf(known)}</span>
            </figcaption>
            <div class="plot"></div>
          </figure>`;
        })}
      </div>
    `;
  }

  protected override updated(): void {
    this.charts.update(this.chosen);
  }

  private choice(one: SeriesName): TemplateResult {
    return html`<label title=${one.text}>
      <input
        type="checkbox"
        .checked=${this.chosen.includes(one.name)}
        ?disabled=${this.chosen.length >= MOST && !this.chosen.includes(one.name)}
        @change=${() => {
          this.chosen = this.chosen.includes(one.name)
            ? this.chosen.filter((name) => name !== one.name)
            : [...this.chosen, one.name];
          localStorage.setItem(KEPT, JSON.stringify(this.chosen));
          // The figures of what is newly chosen are not there yet.
          void this.load();
        }}
      />
      ${labelOf(one.name)} <span class="soft">${unitOf(one)}</span>
    </label>`;
  }

  /** The moment under the pointer, and whose changes were made about then. */
  private told(): TemplateResult | string {
    const us = this.app.state.hovered.value;
    const many = this.window.marks.length;
    if (us === null) return `${many} ${many === 1 ? "change" : "changes"} in this window`;
    const marks = this.window.near(us / 1e6, 4 * this.charts.secondsPerPixel);
    return html`<b>${clock(us)}</b> ${marks.map(
        (mark) => html`<span class="chip">${mark.account ?? "server"}</span> ${mark.text} `,
      )}`;
  }

  private value(name: string): string {
    const us = this.app.state.hovered.value;
    const [times = [], values = []] = this.window.data([name]);
    let index = values.length - 1;
    if (us !== null) index = times.findLastIndex((at) => at !== null && at <= us / 1e6);
    const value = values[index];
    return value === null || value === undefined ? "—" : shown(Number(value.toPrecision(4)));
  }

  private async prepare(): Promise<void> {
    const found = await this.ask<{ series: SeriesName[] }>("/series/names");
    if (!found) return;
    this.names = found.series;
    const known = new Set(found.series.map((one) => one.name));
    const kept = keptNames().filter((name) => known.has(name));
    this.chosen = kept.length > 0 ? kept : USUAL.filter((name) => known.has(name));
    if (this.chosen.length === 0) this.chosen = found.series.slice(0, 4).map((one) => one.name);
    await this.load();
  }

  private async load(nowUs = Math.round(Date.now() * 1000)): Promise<void> {
    const { stepS, spanS } = STEPS[this.step] ?? STEPS[0];
    const window = new SeriesWindow(stepS, spanS);
    const names = this.chosen.filter((name) => !name.includes(" ")).join(",");
    this.loadedUs = window.endUs(nowUs);
    const query = {
      ...{ names, step_s: stepS, from_us: nowUs - spanS * 1e6 },
      to_us: stepS === 1 ? undefined : this.loadedUs - 1,
    };
    const found = await this.ask<SeriesAnswer>("/series", query);
    // Another window may have been chosen meanwhile.
    if (!found || (STEPS[this.step] ?? STEPS[0]).stepS !== stepS) return;
    window.load(found, this.window);
    this.window = window;
    this.requestUpdate();
    this.draw();
  }

  /** Show the speed and the cost of an actor beside the figures of all, from now on. */
  private pin(actor: string): void {
    const speed = `speed of ${shortId(actor)}`;
    const cost = `cost of ${shortId(actor)}`;
    const stop = this.app.live.subscribe(`actor:${actor}`, { hz: 1 }, (message: ActorNews) => {
      this.window.append(Date.now() * 1000, {
        [speed]: message.speed,
        [cost]: message.cost?.total ?? null,
      });
    });
    this.pinned.set(actor, stop);
    this.names = [
      ...this.names,
      { name: speed, unit: "m/s", text: speed },
      { name: cost, unit: "s", text: `cost of the path of ${shortId(actor)}` },
    ];
    this.chosen = [...this.chosen, speed].slice(-MOST);
    this.requestUpdate();
  }

  private draw(): void {
    if (document.hidden) return;
    this.charts.draw();
    this.requestUpdate();
  }
}

/** The unit as people read it; of a mere number there is none. */
function unitOf(one: SeriesName | undefined): string {
  if (one === undefined || one.unit === "1") return "";
  return one.unit.replace(/^1\//, "per ");
}

function keptNames(): string[] {
  try {
    const kept: unknown = JSON.parse(localStorage.getItem(KEPT) ?? "[]");
    return Array.isArray(kept) ? kept.filter((one) => typeof one === "string") : [];
  } catch {
    return [];
  }
}

customElements.define("esp-series", SeriesPanel);
