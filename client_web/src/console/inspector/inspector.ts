/** The panel on whom is chosen: what an actor does and why, or several beside each other. */

import { html, nothing, type TemplateResult } from "lit";
import { labelOf, unitIn } from "../models/fields";
import { Panel } from "../panels/panel";
import { reasonText } from "../state/reasons";
import { controls } from "../style/controls";
import { valueText } from "./compare";
import { inspectorStyle } from "./inspectorstyle";
import { costTable, parameterTable, whyBand } from "./parts";
import { searchPart } from "./searchpart";
import { traceOverlay, type TraceView } from "./tree";
import { WatchedActor } from "./watching";
import { blockerText, momentOf, outcomeText, secondsText } from "./why";

const OVERLAY = "inspector";
const TRACE = "trace";
const AGAIN_MS = 500;
const USUAL_TICK_S = 0.05;
/** The number of actors that are watched at once, the first that are chosen. */
const MOST = 2;

class InspectorPanel extends Panel {
  static override styles = [controls, inspectorStyle];

  private watched: WatchedActor[] = [];
  private view: TraceView = { slice: 0, by: "order" };

  protected override begin(): void {
    const { state, scheme } = this.app;
    this.watch(state.chosen, () => {
      this.look();
    });
    this.watch(state.following);
    this.watch(scheme);
    this.every(AGAIN_MS, () => {
      // People are told of by the map alone.
      if (this.watched.length === 0) this.requestUpdate();
    });
    this.atEnd(() => {
      this.forget();
    });
    this.look();
  }

  protected override render(): TemplateResult {
    const { chosen } = this.app.state;
    if (chosen.value.length === 0) {
      return html`<p class="soft">
        Choose somebody on the map or in the list. With Ctrl you choose more, to compare them.
      </p>`;
    }
    const [first] = this.watched;
    const more = chosen.value.length - Math.max(1, this.watched.length);
    return html`
      ${this.watched.length > 0 ? this.watched.map((actor) => this.state(actor)) : this.person()}
      ${more > 0 ? html`<p class="soft">${more} more chosen.</p>` : nothing}
      ${first ? this.about(first) : nothing}
    `;
  }

  private about(first: WatchedActor): TemplateResult {
    const tickS = this.app.state.world.value?.tick_s ?? USUAL_TICK_S;
    const tick = first.now?.tick ?? this.app.avatars.tick.value;
    return html`
      ${
        this.watched.length > 1
          ? nothing
          : whyBand(first.why.spans, tick, tickS, this.app.scheme.value.dark, (agoS) => {
              this.app.state.hovered.value =
                agoS === null ? null : momentOf(first.why.moments, tick - agoS / tickS);
            })
      }
      ${costTable(first)} ${parameterTable(this.watched)}
      ${
        this.watched.length > 1
          ? nothing
          : searchPart(
              first.trace,
              this.view,
              () => void this.askTrace(first),
              (view) => {
                this.showTrace(first, view);
              },
            )
      }
    `;
  }

  private state({ id, details, now }: WatchedActor): TemplateResult {
    const avatar = this.app.avatars.get(id);
    const reason = now?.reason ?? details?.reason ?? "none";
    const blocker = now ? now.blocker : (details?.blocker ?? null);
    const { following } = this.app.state;
    const ended = now
      ? outcomeText(now.outcome, now.in_the_way)
      : outcomeText(details?.outcome, details?.in_the_way);
    const sinceS = now?.since_s ?? details?.since_s;
    const at = now ? ([now.x, now.y, now.z] as const) : details?.position;
    return html`
      <div class="row">
        <h2>${avatar?.name ?? details?.name ?? id}</h2>
        <button
          aria-pressed=${following.value ? "true" : "false"}
          @click=${() => {
            following.value = !following.value;
          }}
        >
          Follow
        </button>
      </div>
      <dl>
        <dt>Id</dt>
        <dd>${id}</dd>
        <dt>Does</dt>
        <dd>
          <strong>${reasonText(reason)}</strong>${
            sinceS === undefined ? nothing : html` for ${secondsText(sinceS)}`
          }${blocker ? html`: ${blockerText(blocker)}` : nothing}
          ${details?.held ? html` <span class="warn">held by an operator</span>` : nothing}
        </dd>
        ${
          ended === null
            ? nothing
            : html`<dt>Trip</dt>
                <dd>${ended}</dd>`
        }
        <dt>Place</dt>
        <dd>${at ? at.map((value) => value.toFixed(1)).join(", ") : "not in the world"}</dd>
        <dt>Speed</dt>
        <dd>${(now?.speed ?? details?.speed_mps ?? 0).toFixed(2)} m/s</dd>
        <dt>Groups</dt>
        <dd>${details?.tags.join(", ") || "none"}</dd>
        ${Object.entries(now?.behaviour ?? details?.behaviour ?? {}).map(
          ([name, value]) =>
            html`<dt>${name === "kind" ? "Behaviour" : labelOf(name)}</dt>
              <dd>${valueText(value)} ${value === null ? nothing : unitIn(name)}</dd>`,
        )}
      </dl>
    `;
  }

  private person(): TemplateResult {
    const [key = ""] = this.app.state.chosen.value;
    const avatar = this.app.avatars.get(key);
    if (!avatar) return html`<p class="soft">${key} is not in the world.</p>`;
    const { to, name, speed, kind } = avatar;
    return html`<h2>${name}</h2>
      <dl>
        <dt>Kind</dt>
        <dd>${kind}</dd>
        <dt>Place</dt>
        <dd>${[to.x, to.y, to.z].map((value) => value.toFixed(1)).join(", ")}</dd>
        <dt>Speed</dt>
        <dd>${speed.toFixed(2)} m/s</dd>
      </dl>`;
  }

  /** Watch the actors that are chosen, and no others. */
  private look(): void {
    const wanted = this.app.state.chosen.value.filter((id) => !id.startsWith("person:"));
    const ids = wanted.slice(0, MOST);
    const before = this.watched;
    this.watched = ids.map(
      (id) =>
        before.find((actor) => actor.id === id) ??
        new WatchedActor(id, this.app, () => {
          this.drawPaths();
          this.requestUpdate();
        }),
    );
    for (const actor of before) if (!this.watched.includes(actor)) actor.end();
    if (before[0] !== this.watched[0]) this.app.state.overlay(TRACE, null);
    this.drawPaths();
    this.requestUpdate();
  }

  private forget(): void {
    for (const actor of this.watched) actor.end();
    this.watched = [];
    this.app.state.overlay(OVERLAY, null);
    this.app.state.overlay(TRACE, null);
  }

  private drawPaths(): void {
    const { scheme, state } = this.app;
    const lines = this.watched.flatMap(({ now }) => [
      ...(now?.previous
        ? [line(now.previous.path, scheme.value.colour("soft-ink"), 1.5, true)]
        : []),
      ...(now?.path ? [line(now.path, scheme.value.colour("focus"), 2.5, false)] : []),
    ]);
    state.overlay(OVERLAY, lines.length > 0 ? { lines } : null);
  }

  private async askTrace(actor: WatchedActor): Promise<void> {
    await actor.askTrace();
    if (actor.trace) this.showTrace(actor, this.view);
  }

  /** Show what was traced on the map, or nothing of it any more. */
  private showTrace(actor: WatchedActor, view: TraceView | null): void {
    if (view === null) actor.trace = null;
    else this.view = view;
    const { trace } = actor;
    const { scheme, state } = this.app;
    const colours = {
      taken: scheme.value.colour("focus"),
      before: scheme.value.colour("soft-ink"),
    };
    state.overlay(TRACE, trace ? traceOverlay(trace, this.view, colours) : null);
    this.requestUpdate();
  }
}

function line(
  path: readonly (readonly [number, number, number, number])[],
  colour: string,
  widthPx: number,
  dashed: boolean,
): { points: [number, number, number][]; colour: string; widthPx: number; dashed: boolean } {
  return { points: path.map(([x, y, z]) => [x, y, z]), colour, widthPx, dashed };
}

customElements.define("esp-inspector", InspectorPanel);
