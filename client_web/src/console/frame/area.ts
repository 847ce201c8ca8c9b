/** One area of the page: tabs of the panels in it, and the one that is shown. */

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { type Area, panelOf } from "../panels/registry";
import { AREAS } from "../layout/layout";
import { rove } from "../state/roving";
import { controls } from "../style/controls";
import { popup } from "../style/popup";

/** The wishes of the operator about a panel. */
export type AreaWish =
  { wish: "show" | "shut"; panel: string } | { wish: "move"; panel: string; to: Area };

const NAMES: Readonly<Record<Area, string>> = {
  left: "Left",
  centre: "Middle",
  right: "Right",
  bottom: "Bottom",
};
const DRAGGED = "application/x-esplanade-panel";

class AreaElement extends LitElement {
  static override styles = [
    controls,
    popup,
    css`
      :host {
        display: flex;
        flex-direction: column;
        min-width: 0;
        min-height: 0;
        background: var(--paper);
        overflow: hidden;
      }

      .tabs {
        display: flex;
        gap: 2px;
        padding: 3px 4px 0;
        background: var(--raised);
        border-bottom: 1px solid var(--line);
        align-items: end;
      }

      [role="tablist"] {
        display: flex;
        flex: 1;
        min-width: 0;
        gap: 2px;
        overflow-x: auto;
        scrollbar-width: thin;
      }

      [role="tab"] {
        flex: none;
        border-color: transparent;
        border-radius: 6px 6px 0 0;
        border-bottom: 0;
        white-space: nowrap;
      }

      [role="tab"][aria-selected="true"] {
        border-color: var(--line);
        background: var(--paper);
        box-shadow: inset 0 2px 0 var(--accent);
        font-weight: 600;
      }

      [role="tab"]:focus-visible {
        outline-offset: -2px;
      }

      [role="tabpanel"] {
        flex: 1;
        min-height: 0;
        overflow: auto;
      }

      [role="tabpanel"]:focus-visible {
        outline-offset: -3px;
      }

      .padded {
        padding: 8px;
      }

      details {
        position: relative;
        flex: none;
      }

      summary {
        list-style: none;
        padding: 3px 9px;
        border-radius: 6px;
        cursor: pointer;
      }

      details > div {
        z-index: 5;
      }

      :host(.dropping) {
        outline: 2px dashed var(--accent);
        outline-offset: -4px;
      }

      .empty {
        padding: 16px;
      }
    `,
  ];
  static override properties = {
    name: { attribute: false },
    panels: { attribute: false },
    active: { attribute: false },
    content: { attribute: false },
    alone: { type: Boolean },
  };
  declare name: Area;
  declare panels: readonly string[];
  declare active: string | null;
  /** The element of the active panel. */
  declare content: HTMLElement | null;
  /** Whether there is one area only, so that nothing can be moved. */
  declare alone: boolean;

  constructor() {
    super();
    this.alone = false;
    this.addEventListener("dragover", (event) => {
      if (!event.dataTransfer?.types.includes(DRAGGED)) return;
      event.preventDefault();
      this.classList.add("dropping");
    });
    this.addEventListener("dragleave", () => {
      this.classList.remove("dropping");
    });
    this.addEventListener("drop", (event) => {
      this.classList.remove("dropping");
      const panel = event.dataTransfer?.getData(DRAGGED);
      if (!panel || this.alone) return;
      event.preventDefault();
      this.wish({ wish: "move", panel, to: this.name });
    });
  }

  /** Bring the keyboard into the area: to its tab. */
  override focus(): void {
    this.renderRoot.querySelector<HTMLElement>('[role="tab"][aria-selected="true"]')?.focus();
  }

  protected override updated(changes: PropertyValues): void {
    // Where there are more tabs than room, the one that is shown is in sight.
    if (!changes.has("active") && !changes.has("panels")) return;
    const tab = this.renderRoot.querySelector('[role="tab"][aria-selected="true"]');
    tab?.scrollIntoView({ block: "nearest", inline: "nearest" });
  }

  protected override render(): TemplateResult {
    const { panels, active, content } = this;
    if (active === null) return html`<p class="empty soft">Nothing is shown here.</p>`;
    return html`
      <div class="tabs">
        <div role="tablist" aria-label="${NAMES[this.name]} panels" @keydown=${this.key}>
          ${panels.map((id) => this.tab(id))}
        </div>
        <details @focusout=${this.closeMenu} @keydown=${this.closeMenu}>
          <summary aria-label="What to do with ${panelOf(active)?.title ?? active}">⋯</summary>
          <div>
            ${
              this.alone
                ? nothing
                : AREAS.filter((area) => area !== this.name).map(
                    (to) =>
                      html`<button
                        class="plain"
                        @click=${() => {
                          this.wish({ wish: "move", panel: active, to });
                        }}
                      >
                        Move to: ${NAMES[to].toLowerCase()}
                      </button>`,
                  )
            }
            <button
              class="plain"
              @click=${() => {
                this.wish({ wish: "shut", panel: active });
              }}
            >
              Close
            </button>
          </div>
        </details>
      </div>
      <div
        role="tabpanel"
        id="content"
        tabindex="-1"
        aria-label=${panelOf(active)?.title ?? active}
        class=${active === "map" ? "" : "padded"}
      >
        ${content}
      </div>
    `;
  }

  private tab(id: string): TemplateResult {
    const isActive = id === this.active;
    return html`<button
      role="tab"
      id="tab-${id}"
      aria-selected=${isActive ? "true" : "false"}
      aria-controls=${isActive ? "content" : nothing}
      tabindex=${isActive ? 0 : -1}
      draggable="true"
      @dragstart=${(event: DragEvent) => event.dataTransfer?.setData(DRAGGED, id)}
      @click=${() => {
        this.wish({ wish: "show", panel: id });
      }}
    >
      ${panelOf(id)?.title ?? id}
    </button>`;
  }

  private readonly key = (event: KeyboardEvent): void => {
    const { panels, active } = this;
    if (active !== null && event.key === "Delete") {
      this.wish({ wish: "shut", panel: active });
      return;
    }
    const next = event.altKey
      ? null
      : rove(event.key, active === null ? 0 : panels.indexOf(active), panels.length);
    const panel = next === null ? undefined : panels[next];
    if (panel === undefined) return;
    event.preventDefault();
    this.wish({ wish: "show", panel });
    void this.updateComplete.then(() => {
      this.focus();
    });
  };

  private readonly closeMenu = (event: FocusEvent | KeyboardEvent): void => {
    const menu = event.currentTarget as HTMLDetailsElement;
    if (event instanceof KeyboardEvent) {
      if (event.key !== "Escape" || !menu.open) return;
      event.stopPropagation();
      menu.open = false;
      menu.querySelector("summary")?.focus();
    } else if (!menu.contains(event.relatedTarget as Node | null)) {
      menu.open = false;
    }
  };

  private wish(detail: AreaWish): void {
    const menu = this.renderRoot.querySelector("details");
    if (menu) menu.open = false;
    this.dispatchEvent(new CustomEvent<AreaWish>("wish", { detail }));
  }
}

customElements.define("esp-area", AreaElement);
