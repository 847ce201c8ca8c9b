/** The bar at the top: the world, the connection, panels, layouts, the link, and who is logged in. */

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import type { AppContext } from "../context";
import { type Layout, readLayout, usualLayout, writeLayout } from "../layout/layout";
import { keepFile, openFile } from "../models/files";
import { pageOfZone } from "../net/addresses";
import type { Zones } from "../net/types";
import { PANELS } from "../panels/registry";
import { Watching } from "../state/signal";
import { controls } from "../style/controls";
import { popup } from "../style/popup";

class TopBar extends LitElement {
  static override styles = [
    controls,
    popup,
    css`
      :host {
        display: flex;
        flex-wrap: wrap;
        gap: 2px 12px;
        align-items: center;
        padding: 4px 10px;
        background: var(--paper);
        border-bottom: 1px solid var(--line);
      }

      h1 {
        margin: 0;
        font-size: 15px;
      }

      .figures {
        flex: 1;
        display: flex;
        gap: 12px;
        align-items: center;
        min-width: 0;
        font-variant-numeric: tabular-nums;
        white-space: nowrap;
        overflow: hidden;
      }

      .lamp {
        display: inline-block;
        width: 9px;
        height: 9px;
        border-radius: 50%;
        background: var(--warn);
      }

      .lamp.on {
        background: var(--done);
      }

      details {
        position: relative;
      }

      summary {
        padding: 3px 9px;
        border-radius: 6px;
        cursor: pointer;
      }

      details > div {
        z-index: 12;
        min-width: 180px;
        max-height: 70dvh;
        overflow: auto;
      }

      details > div button {
        text-align: left;
      }

      details > div a {
        display: block;
        padding: 4px 9px;
        border-radius: 6px;
        color: var(--ink);
        text-decoration: none;
        white-space: nowrap;
      }

      details > div a:hover,
      details > div a[aria-current] {
        background: var(--raised);
      }

      @media (max-width: 759px) {
        .wide {
          display: none;
        }

        :host {
          gap: 2px 4px;
          padding: 2px 6px;
        }

        h1 {
          position: absolute;
          width: 1px;
          height: 1px;
          overflow: hidden;
          clip-path: inset(50%);
        }

        summary {
          padding: 3px 6px;
        }

        /* It is the first menu, and would open beyond the left edge. */
        details.zones > div {
          right: auto;
          left: 0;
        }
      }
    `,
  ];
  static override properties = {
    app: { attribute: false },
    layout: { attribute: false },
    shown: { attribute: false },
  };
  declare app: AppContext;
  declare layout: Layout;
  /** Panels that are open now. */
  declare shown: ReadonlySet<string>;

  constructor() {
    super();
    new Watching(this, () => [
      this.app.state.world,
      this.app.state.me,
      this.app.state.zones,
      this.app.live.phase,
      this.app.avatars.roster,
    ]);
  }

  protected override render(): TemplateResult {
    const { state, live, avatars } = this.app;
    const world = state.world.value;
    const several = state.zones.value && state.zones.value.zones.length > 1 && state.zones.value;
    const on = live.phase.value === "on";
    const people = [...avatars.byId.values()].filter(({ kind }) => kind === "person").length;
    return html`
      <h1>Esplanade</h1>
      <div class="figures">
        <span role="status"
          ><span class="lamp ${on ? "on" : ""}" aria-hidden="true"></span>
          ${on ? "live" : "connecting…"}</span
        >
        ${
          world
            ? html`${several ? nothing : html`<span class="wide">${world.scene}</span>`}
                <span class="wide">${avatars.byId.size - people} actors, ${people} people</span>
                ${this.pace()}`
            : nothing
        }
      </div>
      ${several ? this.menu(world?.scene ?? "Zones", this.zones(several), "zones") : nothing}
      ${this.menu("Panels", this.panels())} ${this.menu("Layout", this.layouts())}
      <button class="plain" @click=${() => this.dispatchEvent(new Event("copylink"))}>
        Copy link
      </button>
      <button class="plain" aria-label="Keys" @click=${() => this.dispatchEvent(new Event("keys"))}>
        ?
      </button>
      ${this.menu(
        state.me.value?.account ?? "",
        html`<span class="soft">${state.me.value?.role ?? ""}</span>
          <button class="plain" @click=${() => this.dispatchEvent(new Event("logout"))}>
            Log out
          </button>`,
      )}
    `;
  }

  private pace(): TemplateResult | typeof nothing {
    const pace = this.app.state.world.value?.pace;
    if (!pace || (!pace.paused && pace.factor === 1)) return nothing;
    return html`<strong class="warn">${pace.paused ? "paused" : `${pace.factor} ×`}</strong>`;
  }

  private menu(name: string, content: unknown, kind = ""): TemplateResult {
    return html`<details class=${kind} @focusout=${closeOutside} @keydown=${closeByKey}>
      <summary>${name}</summary>
      <div>${content}</div>
    </details>`;
  }

  /** The zones of the world, each with a link to its own page. */
  private zones({ here, zones }: Zones): TemplateResult[] {
    const page = new URL(window.location.href);
    return zones.map(
      ({ name, scene, people, actors }) =>
        html`<a href=${pageOfZone(page, name)} aria-current=${name === here ? "page" : nothing}>
          ${scene} <span class="soft">${name}, ${people} people, ${actors} actors</span>
        </a>`,
    );
  }

  private panels(): TemplateResult[] {
    const offered = PANELS.filter(({ right }) => this.app.state.may(right));
    return offered.map(
      ({ id, title }) =>
        html`<button
          class="plain"
          @click=${(event: Event) => {
            closeMenuOf(event);
            this.app.show(id);
          }}
        >
          ${title}${this.shown.has(id) ? html` <span class="soft">open</span>` : nothing}
        </button>`,
    );
  }

  private layouts(): TemplateResult {
    return html`
      <button
        class="plain"
        @click=${(event: Event) => {
          closeMenuOf(event);
          this.use(usualLayout());
        }}
      >
        The usual one
      </button>
      <button
        class="plain"
        @click=${(event: Event) => {
          closeMenuOf(event);
          keepFile("esplanade-layout.json", writeLayout(this.layout), "application/json");
        }}
      >
        Save as a file
      </button>
      <button
        class="plain"
        @click=${(event: Event) => {
          closeMenuOf(event);
          void this.open();
        }}
      >
        Open a file…
      </button>
    `;
  }

  private async open(): Promise<void> {
    const text = await openFile(".json,application/json");
    if (text === null) return;
    const layout = readLayout(text);
    if (layout) this.use(layout);
    else this.app.toast("this file holds no layout", "fault");
  }

  private use(layout: Layout): void {
    this.dispatchEvent(new CustomEvent<Layout>("layout", { detail: layout }));
  }
}

function closeMenuOf(event: Event): void {
  const menu = (event.currentTarget as HTMLElement).closest("details");
  if (menu) menu.open = false;
}

function closeOutside(event: FocusEvent): void {
  const menu = event.currentTarget as HTMLDetailsElement;
  if (!menu.contains(event.relatedTarget as Node | null)) menu.open = false;
}

function closeByKey(event: KeyboardEvent): void {
  const menu = event.currentTarget as HTMLDetailsElement;
  if (event.key !== "Escape" || !menu.open) return;
  event.stopPropagation();
  menu.open = false;
  menu.querySelector("summary")?.focus();
}

customElements.define("esp-topbar", TopBar);
