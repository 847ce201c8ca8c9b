/** Presets as files, TOML or JSON, that the command line and the server's start read too. */

import type { Values } from "./scopes";

export interface Preset {
  readonly name: string;
  readonly version: number;
  readonly note?: string | null;
  readonly values: Values;
}

export function toJson(preset: Preset): string {
  const { name, version, note, values } = preset;
  const head = note ? { name, version, note } : { name, version };
  return `${JSON.stringify({ ...head, values: sorted(values) }, null, 1)}\n`;
}

export function toToml(preset: Preset): string {
  const lines = [`name = ${quoted(preset.name)}`, `version = ${preset.version}`];
  if (preset.note) lines.push(`note = ${quoted(preset.note)}`);
  const values = Object.entries(sorted(preset.values)).map(([name, value]) => `${name} = ${value}`);
  return `${[...lines, "", "[values]", ...values].join("\n")}\n`;
}

/** Read a preset of either kind of file. Throws an error that says what is wrong with it. */
export async function readPreset(text: string, fileName: string): Promise<Preset> {
  const found: unknown = fileName.endsWith(".json")
    ? JSON.parse(text)
    : (await import("smol-toml")).parse(text);
  return asPreset(found);
}

/** See that data are a preset. */
export function asPreset(found: unknown): Preset {
  if (typeof found !== "object" || found === null) throw new Error("it holds no preset");
  const { name, version, note, values } = found as Record<string, unknown>;
  if (typeof name !== "string" || !/^[a-z0-9][a-z0-9-]{0,31}$/.test(name)) {
    throw new Error("its name must be small letters, digits and hyphens");
  }
  if (typeof values !== "object" || values === null) throw new Error("it has no values");
  const entries = Object.entries(values as Record<string, unknown>);
  for (const [field, value] of entries) {
    if (typeof value !== "number" || !Number.isFinite(value)) {
      throw new Error(`${field} is no number`);
    }
  }
  if (entries.length === 0) throw new Error("it has no values");
  return {
    name,
    version: typeof version === "number" ? version : 1,
    note: typeof note === "string" ? note : null,
    values: values as Values,
  };
}

function sorted(values: Values): Values {
  return Object.fromEntries(Object.entries(values).sort(([a], [b]) => (a < b ? -1 : 1)));
}

/** A basic string of TOML: that of JSON, but for one character that TOML wants escaped. */
function quoted(text: string): string {
  return JSON.stringify(text).replaceAll("\u007f", "\\u007f");
}
