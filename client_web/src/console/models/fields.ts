/** Fields of a form, read from a JSON schema alone: whatever the server adds to it shows up. */

export interface NumberField {
  readonly name: string;
  /** The name without its unit, as people read it. */
  readonly label: string;
  readonly unit: string;
  readonly doc: string;
  readonly group: string;
  readonly least: number;
  readonly most: number;
  readonly usual: number;
  readonly integer: boolean;
  readonly logarithmic: boolean;
  /** Whether a change has to be prepared before it takes effect. */
  readonly prepared: boolean;
}

export type Json = null | boolean | number | string | readonly Json[] | JsonObject;
export interface JsonObject {
  readonly [name: string]: Json;
}

/** A slider is logarithmic where its greatest value is more than so many times its least. */
const LOG_ABOVE = 50;
/** Steps of a slider from one end to the other. */
export const SLIDER_STEPS = 1000;
/** The suffixes of names that repeat the unit. */
const UNIT_SUFFIX = /_(m|s|ms|mps2?|rad|hz|px|cells)$/;
const UNITS: Readonly<Partial<Record<string, string>>> = { mps: "m/s", mps2: "m/s²", hz: "Hz" };

export function isObject(value: unknown): value is JsonObject {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function text(value: Json | undefined, otherwise: string): string {
  return typeof value === "string" ? value : otherwise;
}

function number(value: Json | undefined, otherwise: number): number {
  return typeof value === "number" ? value : otherwise;
}

/** A name of the wire as words: `max_speed_mps` is read as "Max speed". */
export function labelOf(name: string): string {
  const words = name.replace(UNIT_SUFFIX, "").replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** The unit that a name of the wire ends in, as people read it; empty without one. */
export function unitIn(name: string): string {
  const unit = UNIT_SUFFIX.exec(name)?.[1] ?? "";
  return UNITS[unit] ?? unit;
}

/** All numbers of a schema of an object, in its order; what is no number is left out. */
export function numberFields(schema: JsonObject): NumberField[] {
  const properties = isObject(schema["properties"]) ? schema["properties"] : {};
  return Object.entries(properties).flatMap(([name, property]) => {
    if (!isObject(property)) return [];
    const kind = property["type"];
    if (kind !== "number" && kind !== "integer") return [];
    return [numberField(name, property)];
  });
}

export function numberField(name: string, property: JsonObject): NumberField {
  const least = number(property["minimum"] ?? property["exclusiveMinimum"], 0);
  const most = number(
    property["maximum"] ?? property["exclusiveMaximum"],
    Math.max(least + 1, 100),
  );
  const scale = property["scale"];
  const wide = least > 0 && most > LOG_ABOVE * least;
  return {
    name,
    label: labelOf(name),
    unit: text(property["unit"], unitOf(name)),
    doc: text(property["description"], ""),
    group: text(property["group"], "other"),
    least,
    most,
    usual: number(property["default"], least),
    integer: property["type"] === "integer",
    logarithmic: scale === "log" || scale === "linear" ? scale === "log" : wide,
    prepared: property["applies"] === "prepared",
  };
}

function unitOf(name: string): string {
  const suffix = UNIT_SUFFIX.exec(name)?.[1] ?? "";
  return { mps: "m/s", mps2: "m/s²" }[suffix] ?? suffix;
}

/** Fields under their headings, both in the order of the schema. */
export function byGroup(fields: readonly NumberField[]): Map<string, NumberField[]> {
  const groups = new Map<string, NumberField[]>();
  for (const field of fields) {
    const there = groups.get(field.group);
    if (there) there.push(field);
    else groups.set(field.group, [field]);
  }
  return groups;
}

/** Where a value lies on a slider from 0 to `SLIDER_STEPS`. */
export function toSlider(field: NumberField, value: number): number {
  const held = Math.min(field.most, Math.max(field.least, value));
  const part = field.logarithmic
    ? Math.log(held / field.least) / Math.log(field.most / field.least)
    : (held - field.least) / (field.most - field.least);
  return Math.round(part * SLIDER_STEPS);
}

/** The value at a place of the slider, rounded to what its neighbourhood can tell apart. */
export function fromSlider(field: NumberField, place: number): number {
  const part = Math.min(1, Math.max(0, place / SLIDER_STEPS));
  if (part === 0) return field.least;
  if (part === 1) return field.most;
  const value = field.logarithmic
    ? field.least * (field.most / field.least) ** part
    : field.least + part * (field.most - field.least);
  return rounded(field, value);
}

function rounded(field: NumberField, value: number): number {
  if (field.integer) return Math.round(value);
  const grain = field.logarithmic ? value / 50 : (field.most - field.least) / 200;
  const digits = Math.max(0, Math.ceil(-Math.log10(grain)));
  return Number(value.toFixed(Math.min(digits, 6)));
}

/** The next value up or down, for arrow keys. */
export function stepOf(field: NumberField): number {
  if (field.integer) return 1;
  return 10 ** Math.floor(Math.log10((field.most - field.least) / 100));
}

/** A number of people's typing; null for what is none. A comma counts as a point. */
export function parsed(field: NumberField, typed: string): number | null {
  const trimmed = typed.trim().replace(",", ".");
  if (trimmed === "" || !/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(trimmed)) return null;
  const value = Number(trimmed);
  if (!Number.isFinite(value)) return null;
  return field.integer && !Number.isInteger(value) ? null : value;
}

/** The fault of a value by the schema alone; null if there is none. */
export function outOfRange(field: NumberField, value: number): string | null {
  if (value < field.least) return `must not be below ${field.least} ${field.unit}`;
  if (value > field.most) return `must not be above ${field.most} ${field.unit}`;
  return null;
}

/** A value as people read it. */
export function shown(value: number): string {
  return String(Number(value.toPrecision(6)));
}
