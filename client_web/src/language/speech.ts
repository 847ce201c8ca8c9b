/** The means by which a catalogue makes its phrases: numbers, units and plurals of one language. */

import { name, type Part, type Phrase, type Wording, partsOf } from "./phrase";

/** Texts are names of people and places, or what somebody has written; numbers are written out. */
type Value = string | number | Exclude<Part, string> | Phrase;

/** The wordings for the numbers of things that the language tells apart. */
type Plurals = Partial<Record<Intl.LDMLPluralRule, Wording>> & { other: Wording };

/** Writes a number as a phrase. */
type Written = (count: number) => Phrase;

export interface Speech {
  /** Tags a template literal. */
  say: (texts: TemplateStringsArray, ...values: Value[]) => Phrase;
  plural: (count: number, wordings: Plurals) => Phrase;
  metres: Written;
  centimetres: Written;
  seconds: Written;
  milliseconds: Written;
  /** A number of seconds that is counted down, such as "9:58 minutes". */
  span: Written;
  /** A day and the time on it, in the person's time zone. */
  moment: (date: Date) => Phrase;
}

export function speechOf(locale: string): Speech {
  const numbers = new Intl.NumberFormat(locale);
  const rules = new Intl.PluralRules(locale);
  const moments = new Intl.DateTimeFormat(locale, { dateStyle: "medium", timeStyle: "short" });
  const inUnits = (unit: string, digits = 0): Written => {
    const format = unitOf(locale, unit, "short", digits);
    return (count) => [format.format(count)];
  };
  const long = {
    second: unitOf(locale, "second", "long", 0),
    minute: unitOf(locale, "minute", "long", 0),
    hour: unitOf(locale, "hour", "long", 0),
  };
  return {
    say: (texts, ...values) =>
      texts.flatMap((text, i) => {
        const value = values[i];
        return text === "" ? written(value, numbers) : [text, ...written(value, numbers)];
      }),
    plural: (count, wordings) => partsOf(wordings[rules.select(count)] ?? wordings.other),
    metres: inUnits("meter", 1),
    centimetres: inUnits("centimeter", 0),
    seconds: inUnits("second", 0),
    milliseconds: inUnits("millisecond", 0),
    span: (seconds) => {
      const whole = Math.max(0, Math.ceil(seconds));
      if (whole < 60) return [long.second.format(whole)];
      const [unit, count] =
        whole < 3600 ? ([long.minute, whole] as const) : ([long.hour, whole / 60] as const);
      return [counted(unit, Math.floor(count / 60), Math.floor(count % 60))];
    },
    moment: (date) => [moments.format(date)],
  };
}

function unitOf(
  locale: string,
  unit: string,
  unitDisplay: "short" | "long",
  maximumFractionDigits: number,
): Intl.NumberFormat {
  return new Intl.NumberFormat(locale, { style: "unit", unit, unitDisplay, maximumFractionDigits });
}

/** A number of units and of sixtieths of them. */
function counted(unit: Intl.NumberFormat, count: number, sixtieths: number): string {
  if (sixtieths === 0) return unit.format(count);
  const clock = `${count}:${String(sixtieths).padStart(2, "0")}`;
  // Beside a clock the unit has the wording of several.
  return unit
    .formatToParts(Math.max(3, count))
    .map(({ type, value }) => (type === "integer" ? clock : value))
    .join("");
}

function written(value: Value | undefined, numbers: Intl.NumberFormat): Phrase {
  if (value === undefined) return [];
  if (typeof value === "string") return [name(value)];
  if (typeof value === "number") return [numbers.format(value)];
  return "tag" in value ? [value] : value;
}
