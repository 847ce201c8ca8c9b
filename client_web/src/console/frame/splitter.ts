/** A bar between two areas, which is dragged or moved with the arrow keys. */

import { css, html, LitElement, type TemplateResult } from "lit";

const KEY_PX = 20;

class Splitter extends LitElement {
  static override styles = css`
    :host {
      display: block;
      background: var(--ground);
      touch-action: none;
    }

    div {
      width: 100%;
      height: 100%;
      cursor: col-resize;
    }

    :host([across]) div {
      cursor: row-resize;
    }

    div:hover {
      background: var(--accent);
    }

    div:focus-visible {
      outline: 2px solid var(--focus);
      background: var(--focus);
    }
  `;
  static override properties = {
    label: { attribute: false },
    size: { attribute: false },
    grows: { attribute: false },
    across: { type: Boolean, reflect: true },
  };
  declare label: string;
  /** Pixels of the area beside it. */
  declare size: number;
  /** Whether that area grows (1) or shrinks (-1) when the bar goes right or down. */
  declare grows: 1 | -1;
  /** Whether the bar lies across, above an area at the bottom. */
  declare across: boolean;
  private from: { pointer: number; size: number } | null = null;

  constructor() {
    super();
    this.across = false;
  }

  protected override render(): TemplateResult {
    return html`<div
      role="separator"
      tabindex="0"
      aria-label=${this.label}
      aria-orientation=${this.across ? "horizontal" : "vertical"}
      aria-valuenow=${Math.round(this.size)}
      aria-valuemin="0"
      aria-valuemax="2000"
      @pointerdown=${this.press}
      @pointermove=${this.move}
      @pointerup=${this.release}
      @pointercancel=${this.release}
      @keydown=${this.key}
    ></div>`;
  }

  private readonly press = (event: PointerEvent): void => {
    (event.target as HTMLElement).setPointerCapture(event.pointerId);
    this.from = { pointer: this.along(event), size: this.size };
  };

  private readonly move = (event: PointerEvent): void => {
    if (this.from) {
      this.tell(this.from.size + this.grows * (this.along(event) - this.from.pointer));
    }
  };

  private readonly release = (): void => {
    this.from = null;
  };

  private readonly key = (event: KeyboardEvent): void => {
    const steps: Record<string, number> = this.across
      ? { ArrowUp: -KEY_PX, ArrowDown: KEY_PX }
      : { ArrowLeft: -KEY_PX, ArrowRight: KEY_PX };
    const step = steps[event.key];
    if (step === undefined || event.altKey) return;
    event.preventDefault();
    this.tell(this.size + this.grows * step);
  };

  private along(event: PointerEvent): number {
    return this.across ? event.clientY : event.clientX;
  }

  private tell(size: number): void {
    this.dispatchEvent(new CustomEvent<number>("resized", { detail: size }));
  }
}

customElements.define("esp-splitter", Splitter);
