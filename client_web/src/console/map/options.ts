/** The contents of the map. */

export interface MapOptions {
  trailS: 0 | 1 | 10 | 60;
  tags: "none" | "name" | "group" | "reason";
  heat: "none" | "density" | "speed" | "waiting" | "contacts" | "risk";
  heatS: 60 | 600 | 3600;
  ways: boolean;
  goals: boolean;
  circles: boolean;
  contacts: boolean;
  places: boolean;
}

export const USUAL: Readonly<MapOptions> = {
  trailS: 0,
  tags: "name",
  heat: "none",
  heatS: 600,
  ways: false,
  goals: false,
  circles: false,
  contacts: true,
  places: true,
};

export const CHOICES = {
  trailS: [
    [0, "none"],
    [1, "1 s"],
    [10, "10 s"],
    [60, "60 s"],
  ],
  tags: [
    ["none", "none"],
    ["name", "name"],
    ["group", "group"],
    ["reason", "reason"],
  ],
  heat: [
    ["none", "none"],
    ["density", "density"],
    ["speed", "speed"],
    ["waiting", "waiting"],
    ["contacts", "contacts"],
    ["risk", "risk"],
  ],
  heatS: [
    [60, "1 min"],
    [600, "10 min"],
    [3600, "60 min"],
  ],
} as const satisfies Partial<
  Record<keyof MapOptions, readonly (readonly [string | number, string])[]>
>;

/** The unit of the values of a heat map. */
export const HEAT_UNITS: Readonly<Record<Exclude<MapOptions["heat"], "none">, string>> = {
  density: "a m²",
  speed: "m/s",
  waiting: "s",
  contacts: "",
  risk: "s",
};

export const SWITCHES = {
  ways: "planned ways",
  goals: "goals",
  circles: "predictions",
  contacts: "contacts",
  places: "places",
} as const satisfies Partial<Record<keyof MapOptions, string>>;

/** Options from a text that may be of another version of the page. */
export function readOptions(text: string | null): MapOptions {
  let given: unknown = null;
  try {
    given = JSON.parse(text ?? "null");
  } catch {
    // Not ours; the usual ones hold.
  }
  const found: Record<string, unknown> = { ...USUAL };
  if (typeof given !== "object" || given === null) return { ...USUAL };
  for (const [name, value] of Object.entries(given)) {
    const choices: readonly (readonly [unknown, string])[] | undefined =
      name in CHOICES ? CHOICES[name as keyof typeof CHOICES] : undefined;
    const fits = choices
      ? choices.some(([choice]) => choice === value)
      : name in SWITCHES && typeof value === "boolean";
    if (fits) found[name] = value;
  }
  return found as unknown as MapOptions;
}
