/** Moments and spans as people read them. */

/** The time of day of a moment, microseconds since 1970, with the day where it is not today. */
export function clock(us: number | null | undefined, now = Date.now()): string {
  if (us === null || us === undefined) return "never";
  const date = new Date(us / 1000);
  const two = (value: number): string => String(value).padStart(2, "0");
  const time = [date.getHours(), date.getMinutes(), date.getSeconds()].map(two).join(":");
  if (date.toDateString() === new Date(now).toDateString()) return time;
  return `${day(us)} ${time}`;
}

export function day(us: number): string {
  const date = new Date(us / 1000);
  const two = (value: number): string => String(value).padStart(2, "0");
  return `${date.getFullYear()}-${two(date.getMonth() + 1)}-${two(date.getDate())}`;
}

/** Moments at even steps, in seconds since 1970, as short as the step allows. */
export function tickTexts(atS: readonly number[]): string[] {
  const stepS = (atS[1] ?? Number.POSITIVE_INFINITY) - (atS[0] ?? 0);
  return atS.map((each) => {
    const time = clock(each * 1e6, each * 1e3);
    if (stepS < 60) return time;
    return stepS < 86_400 ? time.slice(0, 5) : day(each * 1e6).slice(5);
  });
}

/** The same in universal time, as the audit has it. */
export function utc(us: number): string {
  return new Date(us / 1000).toISOString().replace("T", " ").slice(0, 19);
}

export function span(seconds: number): string {
  if (seconds < 100) return `${Math.round(seconds)} s`;
  if (seconds < 6000) return `${Math.round(seconds / 60)} min`;
  if (seconds < 172_800) return `${Math.round(seconds / 3600)} h`;
  return `${Math.round(seconds / 86_400)} days`;
}

/** The moment that somebody has typed into a `datetime-local` input; null for none. */
export function typedMoment(text: string): number | null {
  const ms = Date.parse(text);
  return text === "" || Number.isNaN(ms) ? null : ms * 1000;
}
