/** The panel that lists all actors and people; only the rows in sight are in the page. */

import { css, html, type TemplateResult } from "lit";
import { Panel } from "../panels/panel";
import { reasonColour, reasonName } from "../state/reasons";
import { controls } from "../style/controls";
import { styled } from "../style/styled";
import { choiceAfter, type Row, rowsOf, windowOf } from "./rows";

const ROW_PX = 28;
/** Reasons in the list are this old at most. */
const AGAIN_MS = 1000;

class EverybodyPanel extends Panel {
  static override styles = [
    controls,
    css`
      :host {
        display: flex;
        flex-direction: column;
        height: 100%;
      }

      input {
        width: 100%;
      }

      p {
        margin: 6px 0 0;
      }

      [role="listbox"] {
        flex: 1;
        min-height: 0;
        position: relative;
        margin-top: 6px;
        overflow: auto;
      }

      [role="listbox"]:focus-visible {
        outline-offset: -2px;
      }

      [role="option"] {
        position: absolute;
        left: 0;
        right: 0;
        height: ${ROW_PX}px;
        display: flex;
        gap: 6px;
        align-items: center;
        padding: 0 6px;
        border-radius: 5px;
        white-space: nowrap;
        cursor: default;
      }

      [role="option"] .name {
        flex: 1;
        overflow: hidden;
        text-overflow: ellipsis;
      }

      [role="option"][aria-selected="true"] {
        background: var(--accent-wash);
      }

      [role="listbox"]:focus-visible [role="option"].active {
        outline: 2px solid var(--focus);
        outline-offset: -2px;
      }

      .dot {
        flex: none;
        width: 9px;
        height: 9px;
      }

      .dot.person {
        border-radius: 50%;
        background: var(--person);
      }
    `,
  ];

  private wanted = "";
  private active = 0;
  private rows: readonly Row[] = [];
  private scrolledPx = 0;
  private heightPx = 600;

  protected override begin(): void {
    this.watch(this.app.avatars.roster);
    this.watch(this.app.state.chosen);
    this.watch(this.app.scheme);
    this.every(AGAIN_MS, () => {
      this.requestUpdate();
    });
    this.atEnd(
      this.app.shortcuts.add({
        key: "/",
        text: "look for somebody in the list",
        call: () => {
          this.app.show("everybody");
          this.renderRoot.querySelector("input")?.focus();
        },
      }),
    );
  }

  protected override firstUpdated(): void {
    new ResizeObserver(([entry]) => {
      if (entry) this.heightPx = entry.contentRect.height;
      this.requestUpdate();
    }).observe(this.list);
  }

  protected override render(): TemplateResult {
    this.rows = rowsOf(this.app.avatars.byId.values(), this.wanted);
    this.active = Math.max(0, Math.min(this.active, this.rows.length - 1));
    const { from, to } = windowOf(this.rows.length, ROW_PX, this.scrolledPx, this.heightPx);
    const chosen = new Set(this.app.state.chosen.value);
    const active = this.active >= from && this.active < to ? `row-${this.active}` : "";
    return html`
      <input
        type="search"
        aria-label="Look for a name, a group, a reason"
        placeholder="Name, group, reason…"
        .value=${this.wanted}
        @input=${this.search}
        @keydown=${(event: KeyboardEvent) => {
          if (event.key !== "ArrowDown") return;
          event.preventDefault();
          this.list.focus();
        }}
      />
      <p class="soft" role="status">${this.summary(chosen.size)}</p>
      <div
        role="listbox"
        tabindex="0"
        aria-label="Actors and people"
        aria-multiselectable="true"
        aria-activedescendant=${active}
        @scroll=${() => {
          this.scrolledPx = this.list.scrollTop;
          this.requestUpdate();
        }}
        @keydown=${this.key}
      >
        <div ${styled({ height: `${this.rows.length * ROW_PX}px` })} role="presentation"></div>
        ${this.rows.slice(from, to).map((row, index) => this.row(row, from + index, chosen))}
      </div>
    `;
  }

  private row(row: Row, index: number, chosen: ReadonlySet<string>): TemplateResult {
    const colour =
      row.kind === "actor"
        ? { background: reasonColour(reasonName(row.reason), this.app.scheme.value.dark) }
        : {};
    return html`<div
      role="option"
      id="row-${index}"
      class=${index === this.active ? "active" : ""}
      aria-selected=${chosen.has(row.key) ? "true" : "false"}
      aria-setsize=${this.rows.length}
      aria-posinset=${index + 1}
      ${styled({ top: `${index * ROW_PX}px` })}
      @click=${(event: MouseEvent) => {
        this.active = index;
        this.choose(row.key, event);
      }}
      @dblclick=${() => {
        this.app.choose(row.key);
        this.app.state.following.value = true;
      }}
    >
      <span class="dot ${row.kind}" ${styled(colour)}></span>
      <span class="name">${row.name}</span>
      <span class="soft">${row.kind === "person" ? "person" : row.detail}</span>
    </div>`;
  }

  private summary(chosen: number): string {
    const all = this.app.avatars.byId.size;
    const shown =
      this.rows.length === all ? `${all} in the world` : `${this.rows.length} of ${all}`;
    return chosen > 1 ? `${shown}, ${chosen} chosen` : shown;
  }

  private readonly search = (event: InputEvent): void => {
    this.wanted = (event.target as HTMLInputElement).value;
    this.active = 0;
    this.list.scrollTop = 0;
    this.requestUpdate();
  };

  private readonly key = (event: KeyboardEvent): void => {
    if (event.altKey) return;
    const page = Math.max(1, Math.floor(this.heightPx / ROW_PX) - 1);
    const steps: Record<string, number> = {
      ArrowDown: 1,
      ArrowUp: -1,
      PageDown: page,
      PageUp: -page,
      Home: -this.rows.length,
      End: this.rows.length,
    };
    const step = steps[event.key];
    const row = this.rows[this.active];
    if (step !== undefined) {
      this.active = Math.max(0, Math.min(this.rows.length - 1, this.active + step));
      this.reveal();
      const next = this.rows[this.active];
      if (event.shiftKey && next) this.choose(next.key, event);
    } else if ((event.key === "Enter" || event.key === " ") && row) {
      this.choose(row.key, event);
    } else if (event.key === "a" && event.ctrlKey) {
      this.app.choose(this.rows.map(({ key }) => key));
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    this.requestUpdate();
  };

  private choose(key: string, event: MouseEvent | KeyboardEvent): void {
    const held = { shift: event.shiftKey, ctrl: event.ctrlKey || event.metaKey };
    this.app.choose(choiceAfter(this.rows, this.app.state.chosen.value, key, held));
  }

  private reveal(): void {
    const { list } = this;
    const top = this.active * ROW_PX;
    if (top < list.scrollTop) list.scrollTop = top;
    else if (top + ROW_PX > list.scrollTop + this.heightPx) {
      list.scrollTop = top + ROW_PX - this.heightPx;
    }
    this.scrolledPx = list.scrollTop;
  }

  private get list(): HTMLElement {
    const list = this.renderRoot.querySelector<HTMLElement>('[role="listbox"]');
    if (!list) throw new Error("the list is not drawn yet");
    return list;
  }
}

customElements.define("esp-everybody", EverybodyPanel);
