/** The form of parameters: made from the schema, edited as a draft, applied in one tick. */

import { html, nothing, type TemplateResult } from "lit";
import type { AppContext } from "../../context";
import { byGroup, labelOf } from "../../models/fields";
import type { NumberField } from "../../models/fields";
import { ParameterWork } from "../../models/parameterwork";
import { scopeName } from "../../models/scopes";
import { RefusedError } from "../../net/api";
import type { LiveMessage } from "../../net/live";
import { CommandingPanel } from "../commanding";
import { Editing } from "./editing";
import { type Acts, foot } from "./foot";
import { formStyle } from "./formstyle";
import { head } from "./head";
import { manner, type Manner } from "./manner";
import { row, rowStyle } from "./row";

/** Values are asked for anew this often while the live interface is away. */
const POLL_MS = 2000;

interface ChangeMessage extends LiveMessage {
  change?: { account?: string | null; op?: string };
}

/** Drafts outlive the panel, which may be shut and opened again, but not their account's visit. */
const works = new WeakMap<AppContext, { account: string; work: ParameterWork }>();

function workOf(app: AppContext): ParameterWork {
  const account = app.state.me.value?.account ?? "";
  const kept = works.get(app);
  if (kept?.account === account) return kept.work;
  const work = new ParameterWork(app.api);
  works.set(app, { account, work });
  return work;
}

class ParametersPanel extends CommandingPanel {
  static override styles = [...CommandingPanel.styles, rowStyle, formStyle];
  private work: ParameterWork | null = null;
  private readonly editing = new Editing(() => {
    this.requestUpdate();
  });
  private explained = false;
  private sought = "";
  private how: Manner = manner();
  private figures: readonly string[] = [];

  protected override begin(): void {
    const { api, live, state } = this.app;
    const work = workOf(this.app);
    this.work = work;
    work.changed = () => {
      this.tellDraft(work);
      this.requestUpdate();
    };
    this.watch(state.chosen);
    this.watch(state.draft, (draft) => {
      if (draft && work.fields.length > 0 && JSON.stringify(draft) !== JSON.stringify(told(work)))
        work.take(draft.scope, draft.values);
    });
    this.hear("changes", {}, (message: ChangeMessage) => {
      const by = message.change?.account ?? null;
      void work.refresh(by).catch(() => undefined);
      if (/actor|group/.test(message.change?.op ?? "")) void work.refreshActors().catch(() => null);
    });
    this.every(POLL_MS, () => {
      if (live.phase.value !== "on") void work.refresh().catch(() => undefined);
    });
    this.atEnd(() => {
      work.stop();
    });
    const given = state.draft.value;
    void this.attempt(work.load()).then(() => {
      if (given) work.take(given.scope, given.values);
    });
    void api
      .get<{ figures?: { name: string }[] }>("/schedules")
      .then(({ figures }) => {
        this.figures = (figures ?? []).map((one) => one.name);
        this.requestUpdate();
      })
      .catch(() => undefined);
  }

  protected override render(): TemplateResult {
    const { work } = this;
    if (!work || work.fields.length === 0)
      return html`<p class="soft">The schema is on its way.</p>`;
    const fields = work.fields.filter((field) => this.fits(field));
    return html`<div class="form" @keydown=${this.pressed}>
      ${head(work, {
        chosen: this.app.state.chosen.value,
        sought: this.sought,
        explained: this.explained,
        seek: (words) => {
          this.sought = words;
          this.requestUpdate();
        },
        explain: (on) => {
          this.explained = on;
          this.requestUpdate();
        },
      })}
      <div class="fields">
        ${[...byGroup(fields)].map(
          ([group, members]) =>
            html`<fieldset>
              <legend>${labelOf(group)}</legend>
              <div class="columns">${members.map((field) => this.row(work, field))}</div>
            </fieldset>`,
        )}
        ${fields.length === 0 ? html`<p class="soft">No parameter is called that.</p>` : nothing}
      </div>
      ${foot(work, this.acts(work))}
    </div>`;
  }

  private acts(work: ParameterWork): Acts {
    return {
      button: (text, needs, press, look) => this.button(text, needs, press, look),
      apply: () => this.apply(),
      undo: () => this.undo(),
      redo: () => this.redo(),
      liveDrag: this.editing.live,
      dragLive: (on) => {
        this.editing.live = on;
        this.requestUpdate();
      },
      how: this.how,
      figures: this.figures,
      change: (how) => {
        this.how = how;
        work.manner = how.command;
        work.touched();
        this.requestUpdate();
      },
    };
  }

  private row(work: ParameterWork, field: NumberField): TemplateResult {
    const { draft } = work;
    const { name } = field;
    const source = draft.source(name);
    const edit = draft.edit(name);
    const value = edit ?? source?.value ?? field.usual;
    return row(
      {
        field,
        value,
        typed: this.editing.typed(name),
        edit,
        from: scopeName(source?.from ?? "default", work.actors),
        own: source?.from === work.scope,
        beside: draft.beside(name),
        fault: draft.fault(name),
        shadows: work.shadowing(name).length,
        explained: this.explained,
        locked: this.whyNot("set_parameters"),
      },
      this.editing.events(work, field, value, source?.from === work.scope, (name) => {
        void this.attempt(work.clearShadows(name));
      }),
    );
  }

  private readonly pressed = (event: KeyboardEvent): void => {
    const { work } = this;
    if (!work) return;
    const control = event.ctrlKey || event.metaKey;
    if (control && event.key === "Enter") void this.apply();
    else if (control && event.key.toLowerCase() === "z" && event.shiftKey) void this.redo();
    else if (control && event.key.toLowerCase() === "y") void this.redo();
    else if (control && event.key.toLowerCase() === "z") void this.undo();
    else if (event.key === "Escape") {
      const field = (event.target as Element).closest<HTMLElement>("[data-field]")?.dataset[
        "field"
      ];
      if (field === undefined || work.draft.edit(field) === undefined) return;
      this.editing.drop(work, field);
    } else return;
    event.preventDefault();
    event.stopPropagation();
  };

  private async apply(): Promise<void> {
    const { work } = this;
    if (!work) return;
    const why = this.whyNot("set_parameters");
    if (why !== null) {
      this.app.toast(why);
      return;
    }
    try {
      const answer = await work.apply();
      this.editing.applied(work);
      this.requestUpdate();
      if (answer) this.app.toast(appliedText(answer.tick), "done");
    } catch (error) {
      if (!(error instanceof RefusedError)) throw error;
      if (work.draft.names.every((name) => work.draft.fault(name) === null))
        this.app.toast(error.message, "fault");
    }
  }

  private async undo(): Promise<void> {
    const { work } = this;
    if (!work) return;
    this.editing.typedOut();
    if (work.draft.canUndo) {
      work.draft.undo();
      work.touched();
    } else await this.revert(work, "latest", "Your latest change is taken back.");
  }

  private async redo(): Promise<void> {
    const { work } = this;
    if (!work) return;
    this.editing.typedOut();
    if (work.draft.canRedo) {
      work.draft.redo();
      work.touched();
    } else await this.revert(work, "undone", "It is made anew.");
  }

  private async revert(work: ParameterWork, change: string, done: string): Promise<void> {
    const answer = await this.carryOut({ op: "revert", change }, done);
    if (answer) await work.refresh().catch(() => undefined);
  }

  private fits(field: NumberField): boolean {
    const words = this.sought.toLowerCase().split(/\s+/);
    const text = `${field.name} ${field.label} ${field.doc} ${field.group}`.toLowerCase();
    return words.every((word) => text.includes(word));
  }

  private tellDraft(work: ParameterWork): void {
    const now = told(work);
    const { draft } = this.app.state;
    if (JSON.stringify(now) !== JSON.stringify(draft.value)) draft.value = now;
  }
}

function told(work: ParameterWork): { scope: string; values: Record<string, unknown> } | null {
  return work.draft.isEmpty ? null : { scope: work.scope, values: work.draft.values };
}

function appliedText(tick: number | null): string {
  return tick === null ? "Applied." : `Applied in tick ${tick}.`;
}

customElements.define("esp-parameters", ParametersPanel);
