/** Forms of behaviours, read from their JSON schema: a new kind shows up by itself. */

import type { Json, JsonObject, NumberField } from "./fields";
import { isObject, labelOf, numberField } from "./fields";

export type InputKind = "number" | "place" | "places" | "choice" | "boolean" | "text";

export interface Input {
  readonly name: string;
  readonly label: string;
  readonly doc: string;
  readonly kind: InputKind;
  readonly required: boolean;
  readonly usual: Json | undefined;
  /** The range of a number. */
  readonly field: NumberField | null;
  readonly choices: readonly string[];
  readonly most: number;
}

export interface BehaviourKind {
  readonly kind: string;
  readonly label: string;
  readonly doc: string;
  readonly inputs: readonly Input[];
}

/** The kinds that a schema of a tagged union has, in its order. */
export function behaviourKinds(schema: JsonObject): BehaviourKind[] {
  const options = schema["oneOf"] ?? schema["anyOf"] ?? [schema];
  if (!Array.isArray(options)) return [];
  return (options as readonly Json[]).flatMap((option) => {
    const found = resolved(schema, option);
    const properties = isObject(found["properties"]) ? found["properties"] : {};
    const tag = resolved(schema, properties["kind"] ?? null);
    const kind = tag["const"] ?? tag["default"];
    if (typeof kind !== "string") return [];
    const required = Array.isArray(found["required"]) ? (found["required"] as readonly Json[]) : [];
    const inputs = Object.entries(properties)
      .filter(([name]) => name !== "kind")
      .map(([name, property]) => input(schema, name, resolved(schema, property), required));
    return [{ kind, label: labelOf(kind), doc: textOf(found["description"]), inputs }];
  });
}

/** The data that a form stands for; what is left empty is left out. */
export function specOf(kind: BehaviourKind, values: Readonly<Record<string, Json>>): JsonObject {
  const spec: Record<string, Json> = { kind: kind.kind };
  for (const { name } of kind.inputs) {
    const value = values[name];
    if (value !== undefined && value !== "" && value !== null) spec[name] = value;
  }
  return spec;
}

/** The field that is missing before the form can be sent; null if none is. */
export function missing(
  kind: BehaviourKind,
  values: Readonly<Record<string, Json>>,
): string | null {
  for (const { name, label, required } of kind.inputs) {
    const value = values[name];
    const empty =
      value === undefined || value === "" || (Array.isArray(value) && value.length === 0);
    if (required && empty) return `${label} is missing.`;
  }
  return null;
}

function resolved(schema: JsonObject, given: Json): JsonObject {
  if (!isObject(given)) return {};
  const reference = given["$ref"];
  if (typeof reference !== "string") return given;
  let found: Json | undefined = schema;
  for (const part of reference.replace(/^#\//, "").split("/")) {
    found = isObject(found) ? found[part] : undefined;
  }
  return isObject(found) ? { ...found, ...given } : given;
}

function input(
  schema: JsonObject,
  name: string,
  property: JsonObject,
  required: readonly Json[],
): Input {
  const choices = property["enum"];
  return {
    name,
    label: labelOf(name),
    doc: textOf(property["description"]),
    kind: kindOf(schema, property),
    required: required.includes(name),
    usual: property["default"],
    field: ["number", "integer"].includes(textOf(property["type"]))
      ? numberField(name, property)
      : null,
    choices: Array.isArray(choices) ? (choices as readonly Json[]).map(String) : [],
    most: typeof property["maxItems"] === "number" ? property["maxItems"] : 64,
  };
}

function kindOf(schema: JsonObject, property: JsonObject): InputKind {
  if (Array.isArray(property["enum"])) return "choice";
  if (isPlace(schema, property)) return "place";
  switch (property["type"]) {
    case "number":
    case "integer":
      return "number";
    case "boolean":
      return "boolean";
    case "array":
      return isPlace(schema, resolved(schema, property["items"] ?? null)) ? "places" : "text";
    default:
      return "text";
  }
}

/** A place is the name of one, or three numbers. */
function isPlace(schema: JsonObject, property: JsonObject): boolean {
  const options = property["anyOf"];
  if (!Array.isArray(options)) return false;
  const found = (options as readonly Json[]).map((option) => resolved(schema, option));
  return (
    found.some((option) => option["type"] === "string") &&
    found.some((option) => option["type"] === "array" && option["maxItems"] === 3)
  );
}

function textOf(value: Json | undefined): string {
  return typeof value === "string" ? value : "";
}
