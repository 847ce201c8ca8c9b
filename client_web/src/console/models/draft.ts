/** Edits of a scope's parameters that wait for being applied, beside what others do meanwhile. */

import type { Fault } from "../net/types";
import type { Effective } from "./scopes";

/** An edit: a value for the scope, or null to take its own value away. */
export type Edit = number | null;

/** The value that somebody else has given a field while it was being edited here. */
export interface Beside {
  readonly value: number;
  readonly by: string | null;
}

export interface FieldFault {
  readonly code: string;
  readonly text: string;
}

export type Price = "tick" | "prepared";

export class Draft {
  /** The server's effective values, as last heard. */
  private known = new Map<string, Effective>();
  private readonly edits = new Map<string, Edit>();
  /** The value that a field had when its edit began. */
  private readonly begun = new Map<string, number>();
  /** The revision since which changes of others to a field matter. */
  private readonly seenAt = new Map<string, number>();
  private readonly besides = new Map<string, Beside>();
  private faultTexts = new Map<string, FieldFault>();
  private flying: Map<string, Edit> | null = null;
  private readonly past: Map<string, Edit>[] = [];
  private readonly future: Map<string, Edit>[] = [];
  revision = 0;
  price: Price | null = null;
  prepareSeconds: number | null = null;
  shadowed: Readonly<Record<string, number>> = {};

  constructor(readonly scope: string) {}

  // --- reading ---------------------------------------------------------------------------------

  /** The value to show: that of the draft, or else the effective one. */
  value(name: string): number | null {
    const edit = this.edits.get(name);
    if (edit !== undefined && edit !== null) return edit;
    return this.known.get(name)?.value ?? null;
  }

  source(name: string): Effective | null {
    return this.known.get(name) ?? null;
  }

  edit(name: string): Edit | undefined {
    return this.edits.get(name);
  }

  beside(name: string): Beside | null {
    return this.besides.get(name) ?? null;
  }

  fault(name: string): FieldFault | null {
    return this.faultTexts.get(name) ?? null;
  }

  get names(): string[] {
    return [...this.edits.keys()];
  }

  get isEmpty(): boolean {
    return this.edits.size === 0;
  }

  get isFlying(): boolean {
    return this.flying !== null;
  }

  /** Whether there is anything to send that is not under way. */
  get hasUnsent(): boolean {
    return [...this.edits].some(([name, edit]) => this.flying?.get(name) !== edit);
  }

  /** The revision to be checked against: others have not touched the edited fields up to there. */
  get knownRevision(): number {
    return Math.min(this.revision, ...this.names.map((name) => this.seenAt.get(name) ?? Infinity));
  }

  get canUndo(): boolean {
    return this.past.length > 0;
  }

  get canRedo(): boolean {
    return this.future.length > 0;
  }

  // --- editing ---------------------------------------------------------------------------------

  /** Set a field in the draft; edits of the same field in a row count as one for undo. */
  set(name: string, edit: Edit, together = false): void {
    if (this.edits.get(name) === edit) return;
    if (!together || this.past.length === 0) this.remember();
    this.put(name, edit);
  }

  /** Take a field out of the draft. */
  drop(name: string): void {
    if (!this.edits.has(name)) return;
    this.remember();
    this.forget(name);
  }

  /** Note that what is typed in a field is no value; null takes the note away. */
  mistyped(name: string, text: string | null): void {
    if (text === null) this.faultTexts.delete(name);
    else this.faultTexts.set(name, { code: "mistyped", text });
  }

  discard(): void {
    if (this.isEmpty) return;
    this.remember();
    for (const name of this.names) this.forget(name);
    this.faultTexts.clear();
    this.price = null;
  }

  undo(): void {
    this.swap(this.past, this.future);
  }

  redo(): void {
    this.swap(this.future, this.past);
  }

  /** The value of others stands: the edit goes. */
  takeTheirs(name: string): void {
    this.drop(name);
  }

  /** The edit stands, knowing what others have set. */
  keepMine(name: string): void {
    const theirs = this.besides.get(name)?.value ?? this.known.get(name)?.value;
    if (theirs !== undefined) this.agreed(name, theirs);
  }

  // --- the server ------------------------------------------------------------------------------

  /** Take effective values from the server; a field that is edited here keeps its edit. */
  heard(
    sources: Readonly<Record<string, Effective>>,
    revision: number,
    by: string | null = null,
  ): void {
    // An answer that was asked for before a change of our own says what was, not what others did.
    if (revision < this.revision) return;
    this.known = new Map(Object.entries(sources));
    this.revision = revision;
    for (const name of this.edits.keys()) {
      const now = this.known.get(name)?.value;
      const before = this.begun.get(name);
      if (now === undefined) continue;
      const own = now === this.edits.get(name) || now === this.flying?.get(name);
      if (before === undefined || now === before || own) this.agreed(name, now);
      else this.besides.set(name, { value: now, by: by ?? this.besides.get(name)?.by ?? null });
    }
  }

  /** The edits to send now; they stay in the draft until the answer comes. */
  take(): { values: Record<string, number>; cleared: string[] } | null {
    if (this.flying || !this.hasUnsent) return null;
    this.flying = new Map(this.edits);
    const values: Record<string, number> = {};
    const cleared: string[] = [];
    for (const [name, edit] of this.flying) {
      if (edit === null) cleared.push(name);
      else values[name] = edit;
    }
    return { values, cleared };
  }

  /** The server has carried out what was taken; what was typed since stays in the draft. */
  applied(revision: number): void {
    const sent = this.flying ?? new Map<string, Edit>();
    this.flying = null;
    this.revision = Math.max(this.revision, revision);
    this.faultTexts.clear();
    for (const [name, edit] of sent) {
      if (edit !== null) {
        this.known.set(name, { value: edit, from: this.scope });
      }
      const now = this.known.get(name)?.value;
      if (now !== undefined) this.agreed(name, now);
      if (this.edits.get(name) === edit) this.forget(name);
    }
    if (this.isEmpty) this.price = null;
    // A draft that has been applied is taken back by a change of its own, not by forgetting it.
    this.past.length = 0;
    this.future.length = 0;
  }

  /** The server has refused it: all edits stay, each fault at its field. Returns other faults. */
  refused(faults: readonly Fault[]): Fault[] {
    this.flying = null;
    return this.checked(faults);
  }

  /** Faults of a dry run, by field; those that belong to no field are returned. */
  checked(faults: readonly Fault[]): Fault[] {
    this.faultTexts = new Map();
    const others: Fault[] = [];
    for (const fault of faults) {
      const named = this.namedIn(fault);
      for (const name of named) this.faultTexts.set(name, { code: fault.code, text: fault.text });
      if (fault.code === "conflict") this.differences(fault);
      if (named.length === 0) others.push(fault);
    }
    return others;
  }

  // --- links -----------------------------------------------------------------------------------

  /** The edits as plain data. */
  get values(): Record<string, Edit> {
    return Object.fromEntries(this.edits);
  }

  /** Take edits over, of a link for example; what is no edit of a known field is left out. */
  load(values: Readonly<Record<string, unknown>>, isKnown: (name: string) => boolean): void {
    for (const [name, value] of Object.entries(values)) {
      if (!isKnown(name)) continue;
      if (value === null || (typeof value === "number" && Number.isFinite(value))) {
        this.put(name, value);
      }
    }
  }

  // --- inside ----------------------------------------------------------------------------------

  private put(name: string, edit: Edit): void {
    this.edits.set(name, edit);
    const now = this.known.get(name)?.value;
    if (!this.begun.has(name) && now !== undefined) this.agreed(name, now);
    this.faultTexts.delete(name);
  }

  private forget(name: string): void {
    this.edits.delete(name);
    this.begun.delete(name);
    this.seenAt.delete(name);
    this.besides.delete(name);
    this.faultTexts.delete(name);
  }

  /** Up to this revision, whoever edits the field knows that it had this value. */
  private agreed(name: string, now: number): void {
    this.begun.set(name, now);
    this.seenAt.set(name, this.revision);
    this.besides.delete(name);
  }

  private remember(): void {
    this.past.push(new Map(this.edits));
    this.future.length = 0;
  }

  private swap(from: Map<string, Edit>[], to: Map<string, Edit>[]): void {
    const found = from.pop();
    if (!found) return;
    to.push(new Map(this.edits));
    for (const name of this.names) if (!found.has(name)) this.forget(name);
    for (const [name, edit] of found) this.put(name, edit);
  }

  /** The fields that a fault speaks of: by its path, or because its text names them. */
  private namedIn(fault: Fault): string[] {
    const inPath = this.names.filter((name) => fault.path?.includes(name));
    if (inPath.length > 0) return inPath;
    return this.names.filter((name) => new RegExp(`\\b${name}\\b`).test(fault.text));
  }

  private differences(fault: Fault): void {
    const found = fault.arguments?.["differences"];
    const revision = fault.arguments?.["revision"];
    if (typeof revision === "number") this.revision = Math.max(this.revision, revision);
    if (!Array.isArray(found)) return;
    for (const one of found as Readonly<Record<string, unknown>>[]) {
      const { field, now } = one;
      if (typeof field !== "string" || !this.edits.has(field)) continue;
      const value = typeof now === "number" ? now : this.known.get(field)?.value;
      const by = typeof one["account"] === "string" ? one["account"] : null;
      if (value !== undefined) this.besides.set(field, { value, by });
    }
  }
}
