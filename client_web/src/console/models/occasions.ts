/** When a schedule is due, as a form says it and as the server is told. */

export type Occasion = "after" | "time" | "figure" | "tick";

export interface OccasionForm {
  readonly kind: Occasion;
  readonly afterS: string;
  readonly time: string;
  readonly tick: string;
  readonly figure: string;
  readonly side: "above" | "below";
  readonly limit: string;
  readonly forS: string;
  readonly againS: string;
}

export type When = Readonly<Record<string, unknown>>;

export function occasionForm(): OccasionForm {
  return {
    ...{ kind: "after", afterS: "60", time: "", tick: "", figure: "", side: "above", limit: "" },
    ...{ forS: "10", againS: "" },
  };
}

/** The occasion for the server; a text says what is missing. */
export function whenOf(form: OccasionForm): When | string {
  switch (form.kind) {
    case "after": {
      const seconds = Number(form.afterS);
      return seconds > 0 ? { after_s: seconds } : "Say after how many seconds.";
    }
    case "tick": {
      const tick = Number(form.tick);
      return Number.isInteger(tick) && tick > 0 ? { at_tick: tick } : "Say at which tick.";
    }
    case "time": {
      const moment = new Date(form.time);
      if (form.time === "" || Number.isNaN(moment.getTime())) return "Say when.";
      return { at_time: moment.toISOString().replace(/\.\d+Z$/, "Z") };
    }
    case "figure": {
      const limit = Number(form.limit);
      if (form.figure === "") return "Say which figure.";
      if (form.limit.trim() === "" || !Number.isFinite(limit)) return "Say beyond which limit.";
      const forS = Math.max(0, Number(form.forS) || 0);
      return { figure: { name: form.figure, [form.side]: limit, for_s: forS } };
    }
  }
}

/** An occasion in words. */
export function whenText(when: When): string {
  const { at_tick, after_s, at_time, figure } = when;
  if (typeof at_tick === "number") return `at tick ${at_tick}`;
  if (typeof after_s === "number") return `after ${after_s} s`;
  if (typeof at_time === "string") return `at ${at_time}`;
  if (typeof figure === "object" && figure !== null) {
    const { name, above, below, for_s } = figure as Record<string, number | string | null>;
    const side = above === null || above === undefined ? `below ${below}` : `above ${above}`;
    return `when ${name} is ${side} for ${for_s} s`;
  }
  return JSON.stringify(when);
}
