/** Where values hold (the world, a group, one actor), and what is effective in each of them. */

export type Values = Readonly<Record<string, number>>;

/** The answer to GET /parameters. */
export interface ParametersAnswer {
  readonly revision: number;
  readonly defaults: Values;
  readonly scopes: Readonly<Record<string, Values>>;
}

export interface Effective {
  readonly value: number;
  /** The scope that it comes from: `default`, `world`, `group:TAG`, `actor:ID`. */
  readonly from: string;
}

export interface Tagged {
  readonly id: string;
  readonly name: string;
  readonly tags: readonly string[];
  /** The name of its group for each purpose. */
  readonly groups?: Readonly<Record<string, string>>;
}

/** All groups of an actor; the last one prevails over those before. */
export function groupsOf(actor: Tagged): string[] {
  const purposes = Object.entries(actor.groups ?? {}).sort(([a], [b]) => (a < b ? -1 : 1));
  return [...actor.tags, ...purposes.map(([purpose, name]) => `${purpose}:${name}`)];
}

/** Scopes from wide to narrow that hold where this one does; of groups the last one prevails. */
export function chainOf(scope: string, tags: readonly string[] = []): string[] {
  if (scope === "world") return ["world"];
  if (scope.startsWith("group:")) return ["world", scope];
  return ["world", ...tags.map((tag) => `group:${tag}`), scope];
}

/** Every value of a scope, with where it comes from. */
export function effective(
  answer: ParametersAnswer,
  scope: string,
  tags: readonly string[] = [],
): Record<string, Effective> {
  const found: Record<string, Effective> = {};
  for (const [name, value] of Object.entries(answer.defaults)) {
    found[name] = { value, from: "default" };
  }
  for (const wider of chainOf(scope, tags)) {
    for (const [name, value] of Object.entries(answer.scopes[wider] ?? {})) {
      found[name] = { value, from: wider };
    }
  }
  return found;
}

/** The narrower scopes in which a value is set too, so that one set here does not show there. */
export function shadowing(
  answer: ParametersAnswer,
  scope: string,
  name: string,
  actors: readonly Tagged[],
): string[] {
  if (scope.startsWith("actor:")) return [];
  const members = scope.startsWith("group:")
    ? new Set(
        actors
          .filter((actor) => groupsOf(actor).includes(scope.slice("group:".length)))
          .map((actor) => `actor:${actor.id}`),
      )
    : null;
  return Object.keys(answer.scopes).filter((other) => {
    if (other === scope || other === "world" || answer.scopes[other]?.[name] === undefined) {
      return false;
    }
    return members === null || members.has(other);
  });
}

/** Commands that take a value away from scopes, in one tick. */
export function clearing(scopes: readonly string[], name: string): ClearCommand[] {
  return scopes.map((scope) => ({ op: "clear_parameters", scope, names: [name] }));
}

interface ClearCommand {
  op: "clear_parameters";
  scope: string;
  names: string[];
  [field: string]: unknown;
}

/** A scope as people read it. */
export function scopeName(scope: string, actors: readonly Tagged[] = []): string {
  if (scope === "default") return "usual";
  if (scope === "world") return "world";
  if (scope.startsWith("group:")) return `group ${scope.slice("group:".length)}`;
  const id = scope.slice("actor:".length);
  const actor = actors.find((one) => one.id === id);
  return actor ? `${actor.name} (${shortId(id)})` : shortId(id);
}

/** An actor's id without its zone where that is the usual one. */
export function shortId(id: string): string {
  return id.startsWith("main/") ? id.slice("main/".length) : id;
}
