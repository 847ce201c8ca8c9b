/** The talk of the parameter form with the server: it loads, checks, applies and streams drafts. */

import type { Api } from "../net/api";
import { RefusedError } from "../net/api";
import type { Answer, Command, Fault } from "../net/types";
import { Draft } from "./draft";
import type { JsonObject, NumberField } from "./fields";
import { numberFields } from "./fields";
import { Debounced, Stream } from "./pacing";
import type { ParametersAnswer, Tagged } from "./scopes";
import { clearing, effective, groupsOf, shadowing } from "./scopes";

const TYPING_PAUSE_MS = 250;
/** A slider that is dragged sends no more often than this. */
const STREAM_EVERY_MS = 100;

interface Schemas {
  readonly parameters: JsonObject;
}

interface Ramp {
  readonly over_s?: number;
  readonly guard?: JsonObject;
}

export class ParameterWork {
  fields: readonly NumberField[] = [];
  answer: ParametersAnswer | null = null;
  actors: readonly Tagged[] = [];
  /** Faults that belong to no field. */
  faults: readonly Fault[] = [];
  scope = "world";
  note = "";
  /** How a change comes about: over some seconds, with a guard; as the form says. */
  manner: Ramp = {};
  private readonly drafts = new Map<string, Draft>();
  private readonly check = new Debounced(() => void this.dryRun(), TYPING_PAUSE_MS);
  private readonly stream: Stream<string>;
  private checks = 0;

  /** Called whenever there is something else to show. */
  changed: () => void = () => undefined;

  constructor(private readonly api: Api) {
    this.stream = new Stream((scope) => this.sendStreamed(scope), STREAM_EVERY_MS);
  }

  get draft(): Draft {
    return this.draftOf(this.scope);
  }

  /** All scopes with edits that are not applied. */
  get edited(): string[] {
    return [...this.drafts.values()].filter((draft) => !draft.isEmpty).map((draft) => draft.scope);
  }

  get tags(): readonly string[] {
    return this.tagsOf(this.scope);
  }

  async load(): Promise<void> {
    const [schema, , actors] = await Promise.all([
      this.api.get<Schemas>("/schema"),
      this.refresh(),
      this.api.get<{ actors: readonly Tagged[] }>("/actors"),
    ]);
    this.fields = numberFields(schema.parameters);
    this.actors = actors.actors;
    this.hear(null);
  }

  /** Ask for the values anew; `by` is whose change that is about. */
  async refresh(by: string | null = null): Promise<void> {
    this.answer = await this.api.get<ParametersAnswer>("/parameters");
    this.hear(by);
  }

  async refreshActors(): Promise<void> {
    this.actors = (await this.api.get<{ actors: readonly Tagged[] }>("/actors")).actors;
    this.hear(null);
  }

  choose(scope: string): void {
    this.scope = scope;
    this.faults = [];
    this.hear(null);
    if (!this.draft.isEmpty) this.check.want();
  }

  /** Take a draft of a link. */
  take(scope: string, values: Readonly<Record<string, unknown>>): void {
    this.scope = scope;
    const known = new Set(this.fields.map((field) => field.name));
    this.draft.load(values, (name) => known.has(name));
    this.hear(null);
    if (!this.draft.isEmpty) this.check.want();
  }

  edit(name: string, value: number | null, together = false): void {
    this.draft.set(name, value, together);
    this.touched();
  }

  /** Call this after any change of the draft. */
  touched(): void {
    if (this.draft.isEmpty) {
      this.check.cancel();
      this.faults = [];
    } else this.check.want();
    this.changed();
  }

  /** Send what is in the draft as it is, at most ten times a second. */
  drag(): void {
    this.check.cancel();
    this.stream.want(this.scope);
  }

  /** How many narrower scopes have a value of their own. */
  shadowing(name: string): string[] {
    return this.answer ? shadowing(this.answer, this.scope, name, this.actors) : [];
  }

  async clearShadows(name: string): Promise<void> {
    await this.api.commands(clearing(this.shadowing(name), name));
    await this.refresh();
  }

  /** Apply the draft; what is typed meanwhile is applied after it. Says what was done. */
  async apply(): Promise<Answer | null> {
    this.check.cancel();
    this.checks += 1;
    const draft = this.draft;
    let last: Answer | null = null;
    for (;;) {
      const known = draft.knownRevision;
      const taken = draft.take();
      if (!taken) return last;
      const sent = commandsOf(
        draft.scope,
        taken,
        {
          if_revision: known,
          ...(this.note.trim() === "" ? {} : { note: this.note.trim() }),
        },
        this.manner,
      );
      this.changed();
      try {
        const answers = await this.api.commands(sent);
        last = answers.at(-1) ?? null;
        draft.applied(last?.revision ?? known);
        this.faults = [];
        this.note = "";
      } catch (error) {
        if (!(error instanceof RefusedError)) throw error;
        this.faults = draft.refused(error.faults);
        this.changed();
        throw error;
      }
      await this.refresh().catch(() => undefined);
    }
  }

  stop(): void {
    this.check.cancel();
    this.stream.stop();
    this.checks += 1;
  }

  private draftOf(scope: string): Draft {
    let draft = this.drafts.get(scope);
    if (!draft) {
      draft = new Draft(scope);
      this.drafts.set(scope, draft);
      if (this.answer) {
        draft.heard(effective(this.answer, scope, this.tagsOf(scope)), this.answer.revision);
      }
    }
    return draft;
  }

  private tagsOf(scope: string): readonly string[] {
    const actor = this.actors.find((one) => `actor:${one.id}` === scope);
    return actor ? groupsOf(actor) : [];
  }

  private hear(by: string | null): void {
    if (!this.answer) return;
    for (const scope of new Set([this.scope, ...this.edited])) {
      const values = effective(this.answer, scope, this.tagsOf(scope));
      this.draftOf(scope).heard(values, this.answer.revision, by);
    }
    this.changed();
  }

  /** Ask the server what would come of the draft: faults by field, and the price. */
  private async dryRun(): Promise<void> {
    const draft = this.draft;
    if (draft.isEmpty || draft.isFlying) return;
    const asked = (this.checks += 1);
    const edits = draft.values;
    const values = Object.entries(edits).filter((one): one is [string, number] => one[1] !== null);
    const cleared = Object.keys(edits).filter((name) => edits[name] === null);
    const more = { dry_run: true };
    const taken = { values: Object.fromEntries(values), cleared };
    const sent = commandsOf(draft.scope, taken, more, this.manner);
    try {
      const answers = await this.api.commands(sent);
      if (asked !== this.checks) return;
      const prices = answers.map((answer) => answer.price);
      draft.checked([]);
      draft.price = prices.includes("prepared") ? "prepared" : "tick";
      draft.prepareSeconds = Math.max(0, ...answers.map((answer) => answer.prepare_s ?? 0)) || null;
      this.faults = [];
    } catch (error) {
      if (!(error instanceof RefusedError)) throw error;
      if (asked !== this.checks) return;
      draft.price = null;
      this.faults = draft.checked(error.faults);
    }
    this.changed();
  }

  private async sendStreamed(scope: string): Promise<void> {
    const draft = this.draftOf(scope);
    const taken = draft.take();
    if (!taken) return;
    try {
      const sent = commandsOf(scope, taken, { stream: true }, {});
      const answers = await this.api.commands(sent);
      draft.applied(answers.at(-1)?.revision ?? draft.revision);
      this.faults = [];
    } catch (error) {
      if (!(error instanceof RefusedError)) throw error;
      this.faults = draft.refused(error.faults);
    }
    this.changed();
    if (!draft.hasUnsent) await this.refresh().catch(() => undefined);
  }
}

interface Taken {
  readonly values: Readonly<Record<string, number>>;
  readonly cleared: readonly string[];
}

/** The commands that carry a draft out, in one tick. */
export function commandsOf(
  scope: string,
  taken: Taken,
  more: Readonly<Record<string, unknown>>,
  manner: Ramp,
): Command[] {
  const commands: Command[] = [];
  const { values, cleared } = taken;
  if (Object.keys(values).length > 0) {
    commands.push({ op: "set_parameters", scope, values, ...more, ...manner });
  }
  if (cleared.length > 0) {
    const rest = Object.entries(more).filter(([name]) => name !== "stream");
    commands.push({ op: "clear_parameters", scope, names: cleared, ...Object.fromEntries(rest) });
  }
  return commands;
}
