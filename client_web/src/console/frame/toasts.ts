/** Short messages in the corner; faults stay until they are closed. */

import { css, html, LitElement, type TemplateResult } from "lit";
import type { Mood } from "../context";
import { controls } from "../style/controls";

interface Toast {
  id: number;
  text: string;
  mood: Mood;
}

const SHOWN_MS = 6000;
const MOST = 5;

export class Toasts extends LitElement {
  static override styles = [
    controls,
    css`
      :host {
        position: fixed;
        z-index: 15;
        right: 12px;
        bottom: 12px;
        display: grid;
        gap: 6px;
        width: min(380px, calc(100% - 24px));
        pointer-events: none;
      }

      .toast {
        display: flex;
        gap: 8px;
        align-items: start;
        justify-content: space-between;
        padding: 8px 12px;
        border: 1px solid var(--line);
        border-left: 5px solid var(--accent);
        border-radius: 8px;
        background: var(--paper);
        box-shadow: 0 4px 16px rgb(0 0 0 / 25%);
        overflow-wrap: anywhere;
        pointer-events: auto;
      }

      .toast.fault {
        border-left-color: var(--fault);
      }

      .toast.done {
        border-left-color: var(--done);
      }
    `,
  ];
  private toasts: readonly Toast[] = [];
  private next = 0;

  add(text: string, mood: Mood): void {
    // The same once more is no news.
    const others = this.toasts.filter((toast) => toast.text !== text || toast.mood !== mood);
    const toast = { id: this.next++, text, mood };
    this.toasts = [...others, toast].slice(-MOST);
    this.requestUpdate();
    if (mood === "fault") return;
    setTimeout(() => {
      this.drop(toast);
    }, SHOWN_MS);
  }

  protected override render(): TemplateResult {
    const told = (urgent: boolean): TemplateResult[] =>
      this.toasts
        .filter(({ mood }) => (mood === "fault") === urgent)
        .map(
          (toast) =>
            html`<div class="toast ${toast.mood}">
              <span>${toast.text}</span>
              <button
                class="plain"
                aria-label="Close this message"
                @click=${() => {
                  this.drop(toast);
                }}
              >
                ✕
              </button>
            </div>`,
        );
    return html`<div role="status">${told(false)}</div>
      <div role="alert">${told(true)}</div>`;
  }

  private drop(toast: Toast): void {
    this.toasts = this.toasts.filter((other) => other !== toast);
    this.requestUpdate();
  }
}

customElements.define("esp-toasts", Toasts);
