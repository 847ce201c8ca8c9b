/** The base of panels that give commands: buttons that say why they cannot be used, answers told. */

import { css, html, nothing, type TemplateResult } from "lit";
import { whyNot } from "../models/rights";
import { type Query, RefusedError } from "../net/api";
import type { LiveMessage } from "../net/live";
import type { Answer, Command } from "../net/types";
import { Panel } from "./panel";

interface ChangeMessage extends LiveMessage {
  about?: string;
  change?: { op?: string };
}

export interface ButtonLook {
  main?: boolean;
  plain?: boolean;
  pressed?: boolean;
  /** For screen readers, where the text alone does not say what it is about. */
  label?: string;
  /** Why it cannot be used just now, whatever the rights. */
  blocked?: string | null;
  keys?: string;
}

export abstract class CommandingPanel extends Panel {
  static override styles = [
    ...Panel.styles,
    css`
      [aria-disabled="true"] {
        opacity: 0.6;
        cursor: not-allowed;
      }
      fieldset {
        margin: 0 0 10px;
        padding: 8px;
        border: 1px solid var(--line);
        border-radius: 8px;
        min-width: 0;
      }
      legend {
        padding: 0 4px;
        font-weight: 600;
      }
      details {
        margin: 0 0 8px;
      }
      summary {
        cursor: pointer;
        font-weight: 600;
      }
      label.field {
        display: inline-flex;
        flex-direction: column;
        gap: 2px;
        font-size: 0.93em;
        color: var(--soft-ink);
      }
      label.field > * {
        color: var(--ink);
      }
      label.field > input:not(.short),
      label.field > select,
      .grow > input,
      .grow > select {
        width: 100%;
        min-width: 0;
      }
      .row {
        margin-bottom: 6px;
      }
      .row > .row {
        margin-bottom: 0;
      }
      .row:has(> label.field) {
        align-items: end;
      }
      :host {
        display: block;
      }
      .grow {
        flex: 1 1 8em;
        min-width: 0;
      }
      .scroll {
        overflow-x: auto;
      }
      .number {
        text-align: right;
        font-variant-numeric: tabular-nums;
      }
      input.short {
        width: 6em;
      }
      ul.plain,
      ol.plain {
        list-style: none;
        margin: 0;
        padding: 0;
      }
      .chip {
        display: inline-block;
        padding: 0 6px;
        border: 1px solid var(--line);
        border-radius: 9px;
        background: var(--raised);
        font-size: 0.86em;
        white-space: nowrap;
      }
    `,
  ];

  private refusal: string | null = null;

  constructor() {
    super();
    this.watchRights();
  }

  /** A button for a command, or for a right; it stays in reach and says why it cannot be used. */
  protected button(
    text: string,
    needs: string,
    press: () => unknown,
    look: ButtonLook = {},
  ): TemplateResult {
    const why = this.whyNot(needs) ?? look.blocked ?? null;
    return html`<button
      type="button"
      class=${look.main ? "main" : look.plain ? "plain" : ""}
      aria-disabled=${why === null ? nothing : "true"}
      aria-pressed=${look.pressed === undefined ? nothing : String(look.pressed)}
      aria-label=${look.label ?? nothing}
      aria-keyshortcuts=${look.keys ?? nothing}
      title=${why ?? look.label ?? nothing}
      @click=${() => {
        if (why === null) void press();
        else this.app.toast(why);
      }}
    >
      ${text}
    </button>`;
  }

  /** Why the operator may not do something; null if it is allowed. */
  protected whyNot(needs: string): string | null {
    const { state } = this.app;
    return whyNot(needs, (right) => state.may(right), state.me.value?.role ?? "without a name");
  }

  /** Carry out a command and tell what came of it; undefined if it was refused. */
  protected async carryOut(command: Command, done?: string): Promise<Answer | undefined> {
    const answer = await this.attempt(this.app.api.command(command));
    if (answer && done !== undefined) this.app.toast(done, "done");
    return answer;
  }

  /** Carry out several commands in one tick: all, or none. */
  protected async carryOutAll(commands: Command[], done?: string): Promise<Answer[] | undefined> {
    const answers = await this.attempt(this.app.api.commands(commands));
    if (answers && done !== undefined) this.app.toast(done, "done");
    return answers;
  }

  /** Ask for something that this panel shows; a refusal stands in the panel instead of a toast. */
  protected async ask<T>(path: string, query: Query = {}): Promise<T | undefined> {
    try {
      const found = await this.app.api.get<T>(path, query);
      this.refusal = null;
      return found;
    } catch (error) {
      if (!(error instanceof RefusedError)) throw error;
      this.refusal = error.message;
      this.requestUpdate();
      return undefined;
    }
  }

  /** Call with every change of one of these commands, or news about one of these subjects. */
  protected hearAbout(about: RegExp, call: () => void): void {
    this.hear("changes", {}, (message: ChangeMessage) => {
      if (about.test(message.change?.op ?? message.about ?? "")) call();
    });
    // Changes that were missed while the connection was away are asked for when it is back.
    this.watch(this.app.live.phase, (phase) => {
      if (phase === "on") call();
    });
  }

  /** Why there is nothing to see, where the server has refused to tell. */
  protected refused(): TemplateResult | typeof nothing {
    return this.refusal === null
      ? nothing
      : html`<p class="fault" role="alert">${this.refusal}</p>`;
  }

  private watchRights(): void {
    this.addController({
      hostConnected: () => {
        // The rights may change while the panel is open.
        if (this.app as typeof this.app | undefined) this.watch(this.app.state.me);
      },
    });
  }
}
