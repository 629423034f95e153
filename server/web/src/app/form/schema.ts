/** JSON Schema as the server publishes it, as far as forms need it: references, variants, units, first values. */

import { isExact } from "../../json";

export type Json = null | boolean | number | string | Json[] | { [name: string]: Json | undefined };
export type JsonObject = { [name: string]: Json | undefined };

export interface Schema {
  $ref?: string;
  type?: string;
  title?: string;
  description?: string;
  default?: Json;
  "x-default"?: Json; // one that is an object, which generators of clients cannot have as a default
  "x-sources"?: string[]; // of a union of objects: the field that each has alone
  const?: Json;
  enum?: Json[];
  anyOf?: Schema[];
  oneOf?: Schema[];
  discriminator?: { propertyName: string; mapping: Record<string, string> };
  properties?: Record<string, Schema>;
  patternProperties?: Record<string, Schema>;
  additionalProperties?: Schema | boolean;
  required?: string[];
  items?: Schema;
  prefixItems?: Schema[];
  minItems?: number;
  maxItems?: number;
  uniqueItems?: boolean;
  pattern?: string;
  minimum?: number;
  maximum?: number;
}

export interface Variant { label: string; schema: Schema }
export interface AnalysisSchema { name: string; title: string; description: string; schema: Schema }

/** Fields of a document that hold its robots, by what there is of them; others have `robots`. */
export const ARMS = [["robot"], ["left", "right"], ["first", "second"], ["master", "slave"]];

const SHA256 = "^[0-9a-f]{64}$";

/** The schemas of an OpenAPI document's components. */
export class Schemas {
  private readonly parts: Record<string, Schema>;

  constructor(openapi: { components: { schemas: Record<string, Schema> } }) {
    this.parts = Object.fromEntries(Object.entries(openapi.components.schemas).map(([name, part]) => [name, whole(part, openapi.components.schemas)]));
  }

  /** What can be submitted, by analysis. */
  analyses(): AnalysisSchema[] {
    const submissions = (this.parts.JobSubmission?.anyOf ?? []).map((part) => this.resolved(part)).filter((part) => part.properties?.analysis);
    return submissions.map((schema) => {
      const name = String(this.resolved(schema.properties!.analysis!).const);
      return { name, title: words(name), description: plain(schema.description ?? ""), schema };
    }).sort((a, b) => a.title.localeCompare(b.title));
  }

  /** A schema without `$ref`; what stands beside the reference counts. */
  resolved(schema: Schema): Schema {
    if (!schema.$ref) return schema;
    const { $ref, ...beside } = schema;
    return { ...this.resolved(this.parts[$ref.split("/").pop()!] ?? {}), ...beside };
  }

  /** The alternatives of a schema, null apart; one for a schema that is none. */
  variants(schema: Schema): { variants: Variant[]; nullable: boolean } {
    const all = (schema.anyOf ?? (schema.discriminator ? schema.oneOf : undefined) ?? [schema]).map((part) => this.resolved(part));
    const among = all.some((part) => this.listOf(part) === "array");
    const variants = all.filter((part) => part.type !== "null").map((part) => ({ label: among && this.listOf(part) === "number" ? "one" : this.named(part, schema.discriminator?.propertyName), schema: part }));
    return { variants, nullable: variants.length < all.length };
  }

  /** The type of a list's items; undefined of what is no list. Beside a list of rows a list of numbers is one of these. */
  private listOf(part: Schema): string | undefined {
    return part.type === "array" && !part.prefixItems ? this.resolved(part.items ?? {}).type : undefined;
  }

  /** The sources of which exactly one is to be given, such as of a robot's model; [] where there are none. */
  sources(schema: Schema): string[][] {
    if (schema.discriminator || !schema.oneOf?.every((part) => part.required && !part.type && !part.properties)) return [];
    return schema.oneOf.map((part) => part.required!);
  }

  isUpload(schema: Schema): boolean { return this.variants(schema).variants.some((variant) => variant.schema.pattern === SHA256); }

  /** Whether a value has the shape of a schema; numbers that are not written yet (null) count as numbers. */
  fits(value: Json | undefined, schema: Schema): boolean {
    const part = this.resolved(schema);
    if (part.const !== undefined) return value === part.const;
    if (part.enum) return part.enum.includes(value as Json);
    if (part.anyOf) return part.anyOf.some((each) => this.fits(value, each));
    if (part.discriminator) return part.oneOf!.some((each) => this.fits(value, each));
    switch (part.type) {
      case "null": return value === null;
      case "boolean": return typeof value === "boolean";
      case "integer": case "number": return typeof value === "number" || isExact(value);
      case "string": return typeof value === "string";
      case "array": return Array.isArray(value) && (!part.maxItems || value.length <= part.maxItems) && value.every((item, i) => item === null || this.fits(item, part.prefixItems?.[i] ?? part.items ?? {}));
      case "object": return typeof value === "object" && value !== null && !Array.isArray(value) && !isExact(value) && this.holds(value, part);
      default: return true;
    }
  }

  private holds(value: JsonObject, part: Schema): boolean {
    const properties = part.properties ?? {};
    return Object.entries(value).every(([name, item]) => {
      const schema = properties[name] && this.resolved(properties[name]);
      if (!schema) return part.additionalProperties !== false || Boolean(part.patternProperties);
      return schema.const === undefined || item === schema.const;
    });
  }

  /** What stands there once a user has chosen to set it. */
  first(schema: Schema): Json {
    const part = this.resolved(schema);
    if (part.const !== undefined) return part.const;
    if (part.default !== undefined && part.default !== null) return structuredClone(part.default);
    if (part.enum) return part.enum[0]!;
    const choices = part.anyOf ?? (part.discriminator ? part.oneOf : undefined);
    if (choices) return this.first(choices[0]!);
    switch (part.type) {
      case "boolean": return true;
      case "string": return "";
      case "array": return Array.from({ length: part.minItems ?? 0 }, (_, i) => this.first(part.prefixItems?.[i] ?? part.items ?? {}));
      case "object": {
        const value: JsonObject = {};
        for (const [name, property] of Object.entries(part.properties ?? {})) {
          const one = this.resolved(property);
          if (one.const !== undefined) value[name] = one.const;
          else if (part.required?.includes(name) && one.type !== "number" && one.type !== "integer") value[name] = this.first(one);
        }
        const source = this.sources(part)[0];
        for (const name of source ?? []) value[name] ??= this.first(part.properties![name]!);
        return value;
      }
      default: return null;
    }
  }

  /** A document without what is there by default anyway: a result's has every field. */
  trimmed(value: Json, schema: Schema): Json {
    const part = this.variants(this.resolved(schema)).variants.find((each) => this.fits(value, each.schema))?.schema;
    if (Array.isArray(value)) return value.map((each, i) => this.trimmed(each, part?.prefixItems?.[i] ?? part?.items ?? {}));
    if (typeof value !== "object" || value === null || isExact(value)) return value;
    const kept: JsonObject = {};
    for (const [name, item] of Object.entries(value)) {
      const own = part?.properties?.[name] ?? (typeof part?.additionalProperties === "object" ? part.additionalProperties : {}), one = this.resolved(own);
      const unset = item === undefined || (item === null ? (one.default ?? null) === null : one.const === undefined && same(item, one.default));
      if (!unset || part?.required?.includes(name)) kept[name] = this.trimmed(item as Json, own);
    }
    return kept;
  }

  private named(part: Schema, tag?: string): string {
    if (tag) return words(String(this.resolved(part.properties?.[tag] ?? {}).const));
    if (part.const !== undefined) return words(String(part.const));
    if (part.enum) return "by name";
    if (part.type === "array") return part.prefixItems && part.minItems ? "one" : "list";
    if (part.type === "object") return part.title ? words(part.title.replace(/([a-z])([A-Z])/g, "$1 $2").replace(/ (Spec|Choice)$/, "")) : "by name";
    return { boolean: "yes or no", integer: "number", number: "number", string: "name" }[part.type ?? ""] ?? "value";
  }
}

/** A schema with the defaults that are objects; a union of objects by their sources as one object again. */
function whole(part: Schema, parts: Record<string, Schema>): Schema {
  const own = defaulted(part), sources = part["x-sources"];
  if (!sources) return own;
  const members = part.anyOf!.map((each) => defaulted(parts[each.$ref!.split("/").pop()!]!));
  const properties = Object.assign({}, ...members.map((each) => each.properties));
  const { anyOf, ...rest } = own;
  return { ...members[0]!, ...rest, required: undefined, properties, oneOf: sources.map((source) => ({ required: [source] })) };
}

function defaulted(node: Schema): Schema;
function defaulted(node: unknown): unknown;
function defaulted(node: unknown): unknown {
  if (Array.isArray(node)) return node.map((each) => defaulted(each));
  if (typeof node !== "object" || node === null || isExact(node)) return node;
  const copy: Record<string, unknown> = Object.fromEntries(Object.entries(node).map(([name, value]) => [name, defaulted(value)]));
  if ("x-default" in copy) copy.default = copy["x-default"];
  return copy;
}

/** Whether two values are the same, whatever the order of their names. */
function same(a: Json | undefined, b: Json | undefined): boolean {
  if (typeof a !== "object" || typeof b !== "object" || a === null || b === null) return a === b;
  const [own, other] = [Object.entries(a), b as JsonObject];
  return Array.isArray(a) === Array.isArray(b) && own.length === Object.keys(b).length && own.every(([name, item]) => same(item, other[name]));
}

/** A field's name for people: without underscores and the unit at its end. */
export function words(name: string): string {
  const text = name.replace(/_(m|m_s2|kg|s|rad|deg|wxyz|kg_m2|m3|n|nm)$/, "").replaceAll("_", " ");
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** The unit that a description says in brackets, such as [m]. */
export function unit(description = ""): string {
  const found = [...description.matchAll(/\[([^\][,]{1,24})\]/g)].map((match) => match[1]!).filter((text) => !/^[A-Z]{2,}/.test(text) && text !== "1");
  return found.at(-1) ?? "";
}

/** A docstring as text; in a form null is what is left empty. */
export function plain(text: string): string { return text.replaceAll("``", "").replaceAll("`", "").replace(/([^\n])\n([^\n])/g, "$1 $2").replace(/\bnull\b/g, "empty"); }

/** The JSON pointer of a step within a pointer. */
export function step(pointer: string, name: string | number): string { return `${pointer}/${String(name).replaceAll("~", "~0").replaceAll("/", "~1")}`; }
