/** Time series of the world's figures, as columns that a chart draws, and marks across them. */

export interface Mark {
  readonly atUs: number;
  readonly text: string;
  readonly account: string | null;
}

export interface SeriesAnswer {
  readonly at_us: readonly number[];
  readonly values: Readonly<Record<string, readonly (number | null)[]>>;
  readonly marks?: readonly {
    readonly at_us: number;
    readonly text: string;
    readonly account?: string | null;
  }[];
}

/** Steps that the server keeps, and how long a window of each is shown. */
export const STEPS = [
  { stepS: 1, spanS: 600, label: "10 minutes", step: "1 s" },
  { stepS: 10, spanS: 6 * 3600, label: "6 hours", step: "10 s" },
  { stepS: 60, spanS: 7 * 24 * 3600, label: "7 days", step: "1 min" },
] as const;
const MOST_MARKS = 500;

/** A window of some series at one step; all columns have the same length. */
export class SeriesWindow {
  private atUs: number[] = [];
  private columns = new Map<string, (number | null)[]>();
  private found: Mark[] = [];
  /** Names of the columns that the server keeps. */
  private kept = new Set<string>();

  constructor(
    readonly stepS: number,
    readonly spanS: number,
  ) {}

  get names(): string[] {
    return [...this.columns.keys()];
  }

  get length(): number {
    return this.atUs.length;
  }

  get marks(): readonly Mark[] {
    return this.found;
  }

  /** Take what the server has kept, and of the window before what the server does not know. */
  load(answer: SeriesAnswer, before?: SeriesWindow): void {
    this.atUs = [...answer.at_us];
    this.kept = new Set(Object.keys(answer.values));
    this.columns = new Map(
      Object.entries(answer.values).map(([name, values]) => [name, [...values]]),
    );
    for (const name of before?.stepS === this.stepS ? before.names : []) {
      if (this.columns.has(name)) continue;
      const known = new Map(before?.data([name])[0]?.map((at, index) => [at, index]));
      const values = before?.data([name])[1] ?? [];
      this.columns.set(
        name,
        this.atUs.map((us) => values[known.get(us / 1e6) ?? -1] ?? null),
      );
    }
    this.found = (answer.marks ?? []).map((mark) => ({
      atUs: mark.at_us,
      text: mark.text,
      account: mark.account ?? null,
    }));
    this.trim();
  }

  /** The end of the latest step that is over at a moment. */
  endUs(atUs: number): number {
    const stepUs = this.stepS * 1e6;
    return Math.floor(atUs / stepUs) * stepUs;
  }

  /**
   * Take the figures of a second. Of longer steps only columns that the server does not keep have
   * them, at the latest step that it has told: the server tells of the others when a step is over.
   */
  append(atUs: number, values: Readonly<Record<string, number | null>>): void {
    const last = this.atUs.at(-1);
    const at = this.stepS > 1 ? last : this.endUs(atUs);
    if (at === undefined || (last !== undefined && at < last)) return;
    if (at !== last) {
      this.atUs.push(at);
      for (const column of this.columns.values()) column.push(null);
    }
    for (const [name, value] of Object.entries(values)) {
      if (this.stepS > 1 && this.kept.has(name)) continue;
      let column = this.columns.get(name);
      if (!column) {
        column = new Array<number | null>(this.atUs.length).fill(null);
        this.columns.set(name, column);
      }
      column[column.length - 1] = value;
    }
    this.trim();
  }

  mark(mark: Mark): void {
    if (this.found.some((one) => one.atUs === mark.atUs && one.text === mark.text)) return;
    this.found.push(mark);
    this.trim();
  }

  /** Columns as uPlot takes them: seconds, then the values of each name. */
  data(names: readonly string[]): (number | null)[][] {
    const empty = (): null[] => new Array<null>(this.atUs.length).fill(null);
    return [
      this.atUs.map((us) => us / 1e6),
      ...names.map((name) => this.columns.get(name) ?? empty()),
    ];
  }

  /** The marks nearest to a time, within some seconds of it. */
  near(atS: number, withinS: number): Mark[] {
    return this.found.filter((mark) => Math.abs(mark.atUs / 1e6 - atS) <= withinS);
  }

  private trim(): void {
    const last = this.atUs.at(-1);
    if (last === undefined) return;
    const from = last - this.spanS * 1e6;
    const gone = this.atUs.findIndex((us) => us > from);
    if (gone > 0) {
      this.atUs.splice(0, gone);
      for (const column of this.columns.values()) column.splice(0, gone);
    }
    this.found = this.found.filter((mark) => mark.atUs > from).slice(-MOST_MARKS);
  }
}
