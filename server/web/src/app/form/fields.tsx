/** Fields of a form, made from a JSON Schema: each shows its unit, default, help, and the server's own problems with it. */

import type { ComponentChildren } from "preact";
import { createContext } from "preact";
import { useContext, useEffect, useId, useState } from "preact/hooks";
import { isExact, parse, typedNumber } from "../../json";
import { message, size } from "../parts";
import { plain, step, unit, words, type Json, type JsonObject, type Schema, type Schemas } from "./schema";

export interface Problem { pointer: string; detail: string }
export interface Uploaded { sha256: string; missing_files: string[] }
export interface FormContext { schemas: Schemas; problems: Problem[]; upload(file: File): Promise<Uploaded> }
export const Form = createContext<FormContext>(null as unknown as FormContext);

interface FieldProps {
  name: string | number;
  schema: Schema;
  value: Json | undefined; // undefined: not set, the default counts
  pointer: string;
  required?: boolean;
  bare?: boolean; // without help and unit: an item of a row
  onChange(value: Json | undefined): void;
}

const LEAVES = ["number", "integer", "string", "boolean"];
const LONG = /text of an? /i;
const MOST_TEXT = 16 * 2 ** 20; // bytes that a field of text takes

/** Any field. */
export function Field(props: FieldProps) {
  const { schemas } = useContext(Form);
  const schema = schemas.resolved(props.schema);
  if (schema.const !== undefined) return null;
  const { variants, nullable } = schemas.variants(schema);
  const only = variants.length === 1 ? variants[0]!.schema : null;
  const described = { ...props, schema: only ? { ...only, description: schema.description ?? only.description, ...(schema.default !== undefined ? { default: schema.default } : {}) } : schema };
  if (only && (!nullable || (schema.default ?? null) === null)) {
    if (only.enum || LEAVES.includes(only.type ?? "")) return <Leaf {...described} nullable={nullable} />;
    if (!nullable || props.bare) return <Whole {...described} />;
    return <Optional {...described} />;
  }
  return <Choice {...props} schema={schema} variants={variants} nullable={nullable} />;
}

function problemsAt(problems: Problem[], pointer: string, within = false): string[] {
  return problems.filter((each) => each.pointer === pointer || (within && each.pointer.startsWith(pointer + "/"))).map((each) => each.detail);
}

/** Label, control, help and problems. `control` gets what ties it to them. */
function Labelled({ props, extra, within, control }: { props: FieldProps; extra?: string | null; within?: boolean; control(tied: Record<string, any>): ComponentChildren }) {
  const id = useId(), { problems } = useContext(Form);
  const wrong = [...(extra ? [extra] : []), ...problemsAt(problems, props.pointer, within)];
  const help = props.bare ? "" : plain(props.schema.description ?? "");
  const described = [help && `${id}h`, wrong.length && `${id}p`].filter(Boolean).join(" ");
  const tied = { id, "aria-invalid": wrong.length ? "true" : undefined, "aria-describedby": described || undefined, "aria-required": props.required || undefined, "data-pointer": props.pointer };
  return (
    <div class={`field ${wrong.length ? "wrong" : ""}`}>
      <label for={id}>{typeof props.name === "number" ? <span class="index">{props.name + 1}</span> : words(props.name)}{props.required && <span class="required" title="needed"> *</span>}</label>
      {control(tied)}
      {wrong.length > 0 && <p class="problem" id={`${id}p`}>{wrong.join("; ")}</p>}
      {help && <p class="help" id={`${id}h`}>{help}</p>}
    </div>
  );
}

function said(value: Json | undefined): string {
  if (value === undefined || value === null) return "";
  return typeof value === "object" ? JSON.stringify(value) : String(value);
}

/** Numbers, text, names, yes or no. */
function Leaf(props: FieldProps & { nullable: boolean }) {
  const { schema, value, onChange } = props, { schemas } = useContext(Form);
  if (schemas.isUpload(schema)) return <Upload {...props} />;
  if (schema.enum) return (
    <Labelled props={props} control={(tied) => (
      <select {...tied} value={said(value)} onChange={(e) => onChange(schema.enum!.find((each) => said(each) === e.currentTarget.value))}>
        {(!props.required || value === undefined) && <option value="">{props.required ? "choose …" : schema.default != null ? `default: ${said(schema.default)}` : "none"}</option>}
        {schema.enum!.map((each) => <option value={said(each)}>{said(each)}</option>)}
      </select>
    )} />
  );
  if (schema.type === "boolean") return (
    <Labelled props={props} control={(tied) => (
      <select {...tied} value={said(value)} onChange={(e) => onChange(e.currentTarget.value === "" ? undefined : e.currentTarget.value === "true")}>
        {!props.required && <option value="">{`default: ${schema.default === true ? "yes" : "no"}`}</option>}
        <option value="true">yes</option>
        <option value="false">no</option>
      </select>
    )} />
  );
  if (schema.type === "string") return LONG.test(schema.description ?? "") ? <LongText {...props} /> : (
    <Labelled props={props} control={(tied) => (
      <input {...tied} type="text" value={said(value)} placeholder={said(schema.default)} onInput={(e) => onChange(e.currentTarget.value || (props.bare ? "" : undefined))} />
    )} />
  );
  return <NumberField {...props} />;
}

/** A number as text, so that 1e6 can be written; empty: not set. */
function NumberField(props: FieldProps) {
  const { schema, value, onChange } = props;
  const [text, setText] = useState(said(value));
  useEffect(() => { if (text.trim() === "" ? value != null : Number(text) !== value) setText(said(value)); }, [value]);
  const number = Number(text.replace(",", ".")), empty = text.trim() === "";
  const wrong = empty ? null : !Number.isFinite(number) ? "must be a number"
    : schema.type === "integer" && !Number.isInteger(number) ? "must be a whole number"
    : schema.type === "integer" && !Number.isSafeInteger(number) && !isExact(value) ? "is too large for this form; the JSON editor takes text as it is" : null;
  const mark = props.bare ? "" : unit(schema.description);
  return (
    <Labelled props={props} extra={wrong} control={(tied) => (
      <span class="with-unit">
        <input {...tied} type="text" inputMode="decimal" value={text} placeholder={said(schema.default) || (props.required || props.bare ? "" : "none")}
          onInput={(e) => {
            const typed = e.currentTarget.value, parsed = typedNumber(typed);
            setText(typed);
            if (typed.trim() === "") onChange(props.bare ? null : undefined);
            else if (Number.isFinite(parsed) || isExact(parsed)) onChange(parsed);
          }} />
        {mark && <span class="unit">{mark}</span>}
      </span>
    )} />
  );
}

/** Text of a model: written, or of a file. */
function LongText(props: FieldProps) {
  return (
    <Labelled props={props} control={(tied) => (
      <Drop onFile={async (file) => {
        if (await isArchive(file)) return `${file.name} is a ZIP: choose the source “Model” to upload it`;
        if (file.size > MOST_TEXT) return `${file.name} has ${size(file.size)}: choose the source “Model” to upload it`;
        props.onChange(await file.text());
        return "";
      }}>
        <textarea {...tied} rows={5} spellcheck={false} value={said(props.value)} onInput={(e) => props.onChange(e.currentTarget.value || undefined)} />
      </Drop>
    )} />
  );
}

/** The SHA-256 of a file that is uploaded here. */
function Upload(props: FieldProps) {
  const { upload } = useContext(Form);
  const [told, setTold] = useState(""), [missing, setMissing] = useState("");
  const send = async (file: File) => {
    setTold(`uploading ${file.name} …`);
    setMissing("");
    try {
      const { sha256, missing_files } = await upload(file);
      props.onChange(sha256);
      setTold(`${file.name} is uploaded`);
      setMissing(without(missing_files));
      return "";
    } catch (error) {
      setTold("");
      return `${file.name}: ${message(error)}`;
    }
  };
  const typed = (sha256: string) => {
    setTold("");
    setMissing("");
    props.onChange(sha256 || undefined);
  };
  return (
    <Labelled props={props} control={(tied) => (
      <Drop onFile={send}>
        <input {...tied} type="text" class="mono" value={said(props.value)} placeholder="drop a file, or its SHA-256" onInput={(e) => typed(e.currentTarget.value)} />
        {told && <p class="help" role="status">{told}</p>}
        {missing && <p class="notice" role="status">{missing}</p>}
      </Drop>
    )} />
  );
}

/** What is said of files that a model names, and that were not uploaded with it. */
function without(files: string[]): string {
  if (!files.length) return "";
  const first = files.slice(0, 3).join(", ") + (files.length > 3 ? ", …" : "");
  return `Without files that it names (${first}): upload the model's folder as a ZIP to have them.`;
}

async function isArchive(file: File): Promise<boolean> { return (await file.slice(0, 2).text()) === "PK"; }

/** A place where a file can be dropped or chosen; `onFile` says what is wrong with it. */
function Drop({ onFile, children }: { onFile(file: File): Promise<string>; children?: ComponentChildren }) {
  const [over, setOver] = useState(false), [wrong, setWrong] = useState("");
  const take = async (file: File | undefined) => {
    setWrong("");
    if (file) setWrong(await onFile(file));
  };
  const drop = (data: DataTransfer | null) => {
    const folder = [...(data?.items ?? [])].map((item) => item.webkitGetAsEntry?.()).find((entry) => entry?.isDirectory);
    if (folder) return setWrong(`${folder.name} is a folder: drop it as a ZIP`);
    if (data && data.files.length > 1) return setWrong("Several files: drop their folder as a ZIP");
    return take(data?.files[0]);
  };
  return (
    <div class={`drop ${over ? "over" : ""}`} onDragOver={(e) => { e.preventDefault(); setOver(true); }} onDragLeave={() => setOver(false)}
      onDrop={(e) => { e.preventDefault(); setOver(false); void drop(e.dataTransfer); }}>
      {children}
      <label class="button file">Choose a file<input type="file" onChange={(e) => { const file = e.currentTarget.files?.[0]; void take(file); e.currentTarget.value = ""; }} /></label>
      {wrong && <p class="problem" role="alert">{wrong}</p>}
    </div>
  );
}

/** A list, a row of numbers, an object: what has fields of its own. */
function Whole(props: FieldProps) {
  const { schemas } = useContext(Form), { schema } = props;
  if (schema.type === "array") {
    const item = schemas.resolved(schema.items ?? {});
    if (schema.prefixItems) return <Row {...props} />;
    if (item.enum && schema.uniqueItems) return <Several {...props} names={item.enum} />;
    if (item.type === "array" && item.prefixItems?.every((each) => schemas.resolved(each).type === "number")) return <Rows {...props} />;
    return <List {...props} />;
  }
  return <Group legend={words(String(props.name))} {...props}><ObjectFields {...props} /></Group>;
}

function Group({ legend, children, ...props }: FieldProps & { legend: string; children: ComponentChildren }) {
  const { problems } = useContext(Form), wrong = problemsAt(problems, props.pointer);
  return (
    <fieldset class="group" data-pointer={props.pointer} tabIndex={-1}>
      <legend>{legend}{props.required && <span class="required"> *</span>}</legend>
      {props.schema.description && !props.bare && <p class="help">{plain(props.schema.description)}</p>}
      {wrong.length > 0 && <p class="problem">{wrong.join("; ")}</p>}
      {children}
    </fieldset>
  );
}

/** What may be left out: a box to tick, then its fields. */
function Optional(props: FieldProps) {
  const { schemas } = useContext(Form), set = props.value != null;
  return (
    <div class="optional">
      <label class="tick"><input type="checkbox" checked={set} data-pointer={props.pointer} onChange={(e) => props.onChange(e.currentTarget.checked ? schemas.first({ ...props.schema, default: undefined }) : undefined)} />{words(String(props.name))}</label>
      {set ? <Whole {...props} /> : props.schema.description && <p class="help">{plain(props.schema.description)}</p>}
    </div>
  );
}

/** One of several kinds: a choice, names among them, then the fields of the kind. */
function Choice(props: FieldProps & { variants: { label: string; schema: Schema }[]; nullable: boolean }) {
  const { schemas } = useContext(Form), { schema, variants, nullable } = props;
  const fallback = schema.default, { value } = props;
  const chosen = value == null ? -1 : variants.findIndex((each) => schemas.fits(value, each.schema)), variant = variants[chosen];
  const state = value === undefined ? "unset" : value === null ? "null" : variant?.schema.enum ? `${chosen} ${said(value)}` : String(chosen);
  const change = (kind: string) => {
    if (kind === "unset" || kind === "-1") return props.onChange(undefined);
    if (kind === "null") return props.onChange(null);
    const [number, ...name] = kind.split(" "), next = variants[Number(number)]!.schema;
    props.onChange(name.length ? next.enum!.find((each) => said(each) === name.join(" ")) : startOf(schemas, next, fallback, value));
  };
  const inner = variant && !variant.schema.enum && variant.schema.const === undefined && { ...props, schema: { ...variant.schema, description: undefined, default: undefined }, value, bare: false, required: true };
  return (
    <div class="choice">
      <Labelled props={props} control={(tied) => (
        <select {...tied} value={state} onChange={(e) => change(e.currentTarget.value)}>
          {!props.required && <option value="unset">{fallback == null ? "none" : `default: ${brief(fallback)}`}</option>}
          {props.required && chosen < 0 && <option value="unset">choose …</option>}
          {variants.map((each, i) => (each.schema.enum ? each.schema.enum.map((name) => <option value={`${i} ${said(name)}`}>{said(name)}</option>) : <option value={String(i)}>{each.label}{each.schema.const === undefined ? " …" : ""}</option>))}
          {nullable && fallback != null && <option value="null">none</option>}
        </select>
      )} />
      {inner && (inner.schema.type === "object" ? <div class="nested"><ObjectFields {...inner} /></div> : <Field {...inner} />)}
    </div>
  );
}

/** What was there or the default where it is of the kind, so that one starts from it; a name becomes its source. */
function startOf(schemas: Schemas, schema: Schema, fallback: Json | undefined, before: Json | undefined): Json {
  const source = typeof before === "string" ? schemas.sources(schema).flat().find((name) => schemas.fits(before, schema.properties![name]!)) : undefined;
  if (source) return { [source]: before };
  return fallback != null && schemas.fits(fallback, schema) ? structuredClone(fallback) : schemas.first(schema);
}

function brief(value: Json): string {
  if (typeof value !== "object" || value === null) return said(value);
  if (Array.isArray(value)) return value.length ? value.map(brief).join(", ") : "empty";
  return String(Object.values(value).find((each) => typeof each === "string") ?? (Object.keys(value).length ? "set" : "empty"));
}

/** The fields of an object; what is needed first. */
export function ObjectFields(props: FieldProps & { leave?: string[]; open?: boolean }) {
  const { schemas } = useContext(Form), { schema, pointer } = props, value = (props.value ?? {}) as JsonObject;
  const change = (name: string, item: Json | undefined) => {
    const next = { ...value, [name]: item };
    if (item === undefined) delete next[name];
    props.onChange(next);
  };
  if (!schema.properties) return <Entries {...props} />;
  const sources = schemas.sources(schema), inSources = new Set(sources.flat());
  const names = Object.keys(schema.properties).filter((name) => !props.leave?.includes(name) && !inSources.has(name) && schemas.resolved(schema.properties![name]!).const === undefined);
  const needed = names.filter((name) => schema.required?.includes(name)), others = names.filter((name) => !schema.required?.includes(name));
  const field = (name: string, required: boolean) => (
    <Field key={name} name={name} schema={schema.properties![name]!} value={value[name]} pointer={step(pointer, name)} required={required} onChange={(item) => change(name, item)} />
  );
  const set = others.filter((name) => value[name] !== undefined).length;
  return (
    <>
      {sources.length > 0 && <Sources {...props} sources={sources} />}
      {needed.length > 0 && <div class="fields">{needed.map((name) => field(name, true))}</div>}
      {others.length > 0 && (others.length <= 6 ? <div class="fields">{others.map((name) => field(name, false))}</div> : (
        <details open={props.open}>
          <summary>{needed.length || sources.length ? "More" : "Fields"} ({set ? `${set} of ${others.length} set` : others.length})</summary>
          <div class="fields">{others.map((name) => field(name, false))}</div>
        </details>
      ))}
    </>
  );
}

/** Exactly one of several: a choice, then its fields. */
function Sources(props: FieldProps & { sources: string[][] }) {
  const { schemas } = useContext(Form), { schema, pointer, sources } = props, value = (props.value ?? {}) as JsonObject;
  const chosen = Math.max(0, sources.findIndex((names) => names.some((name) => value[name] !== undefined)));
  const [wanted, setWanted] = useState(chosen);
  const at = sources[wanted]!.some((name) => value[name] !== undefined) ? wanted : sources.some((names) => names.some((name) => value[name] !== undefined)) ? chosen : wanted;
  const choose = (next: number) => {
    const rest = Object.fromEntries(Object.entries(value).filter(([name]) => !sources.flat().includes(name)));
    for (const name of sources[next]!) rest[name] = schemas.first(schema.properties![name]!) === "" ? undefined : schemas.first(schema.properties![name]!);
    setWanted(next);
    props.onChange(parse(JSON.stringify(rest)));
  };
  return (
    <div class="fields">
      <Labelled props={{ ...props, name: "source", pointer: `${pointer}#source`, schema: { description: "" }, bare: true }} control={(tied) => (
        <select {...tied} value={String(at)} onChange={(e) => choose(Number(e.currentTarget.value))}>{sources.map((names, i) => <option value={String(i)}>{names.map(words).join(", ")}</option>)}</select>
      )} />
      {sources[at]!.map((name) => (
        <Field key={name} name={name} schema={schema.properties![name]!} value={value[name]} pointer={step(pointer, name)} required
          onChange={(item) => props.onChange(parse(JSON.stringify({ ...value, [name]: item })))} />
      ))}
    </div>
  );
}

/** What the numbers of a row are. */
function lettersOf(name: string, count: number): string[] {
  if (count === 4) return ["w", "x", "y", "z"];
  if (count === 2) return name.startsWith("size") ? ["x", "y"] : ["lower", "upper"];
  if (/^([xyz]|roll|pitch|yaw)(_|$)/.test(name)) return ["lower", "upper", "step"];
  return name.startsWith("rpy") ? ["roll", "pitch", "yaw"] : ["x", "y", "z"];
}

/** A row of so many items, such as a position. */
function Row(props: FieldProps) {
  const { schemas } = useContext(Form), items = props.schema.prefixItems!;
  const fallback = Array.isArray(props.schema.default) ? props.schema.default : [];
  const value = (Array.isArray(props.value) ? props.value : items.map(() => null)) as Json[];
  const letters = lettersOf(String(props.name), items.length);
  const { problems } = useContext(Form);
  const wrong = problemsAt(problems, props.pointer, true);
  const change = (i: number, item: Json) => {
    const next = items.map((_, k) => (k === i ? item : (value[k] ?? (props.value === undefined ? (fallback[k] ?? null) : null))));
    props.onChange(next.every((each) => each === null) && !props.required ? undefined : next);
  };
  const mark = unit(props.schema.description);
  const isNumber = items.every((each) => schemas.variants(schemas.resolved(each)).variants.every((one) => one.schema.type === "number"));
  return (
    <fieldset class={`row ${wrong.length ? "wrong" : ""}`} data-pointer={props.pointer} tabIndex={-1}>
      <legend>{typeof props.name === "number" ? props.name + 1 : words(props.name)}{props.required && <span class="required"> *</span>}{mark && <span class="unit">{mark}</span>}</legend>
      <div class="cells">
        {items.map((item, i) => isNumber
          ? <Cell label={letters[i] ?? String(i + 1)} value={value[i] as number | null} placeholder={said(fallback[i])} onChange={(number) => change(i, number)} />
          : <Field key={i} name={i} bare schema={item} value={value[i]} pointer={step(props.pointer, i)} onChange={(each) => change(i, each ?? null)} />)}
      </div>
      {wrong.length > 0 && <p class="problem">{wrong.join("; ")}</p>}
      {props.schema.description && !props.bare && <p class="help">{plain(props.schema.description)}</p>}
    </fieldset>
  );
}

function Cell({ label, value, placeholder, onChange }: { label: string; value: number | null; placeholder: string; onChange(value: number | null): void }) {
  const [text, setText] = useState(said(value));
  useEffect(() => { if (text.trim() === "" ? value != null : Number(text) !== value) setText(said(value)); }, [value]);
  return (
    <label class="cell"><span>{label}</span>
      <input type="text" inputMode="decimal" value={text} placeholder={placeholder} aria-invalid={text.trim() !== "" && !Number.isFinite(Number(text)) ? "true" : undefined}
        onInput={(e) => {
          const typed = e.currentTarget.value;
          setText(typed);
          if (typed.trim() === "") onChange(null);
          else if (Number.isFinite(Number(typed))) onChange(Number(typed));
        }} />
    </label>
  );
}

/** Rows of numbers, a line each: points can be pasted. */
function Rows(props: FieldProps) {
  const { schemas } = useContext(Form), width = schemas.resolved(props.schema.items!).prefixItems!.length;
  const written = (value: Json | undefined) => (Array.isArray(value) ? value.map((row) => (Array.isArray(row) ? row.map(said).join(" ") : said(row))).join("\n") : "");
  const [text, setText] = useState(written(props.value));
  const parse = (typed: string) => typed.split("\n").map((line) => line.trim()).filter(Boolean).map((line) => line.split(/[\s,;]+/).filter(Boolean).map(Number));
  useEffect(() => { if (JSON.stringify(parse(text)) !== JSON.stringify(props.value ?? [])) setText(written(props.value)); }, [props.value]);
  const bad = parse(text).findIndex((row) => row.length !== width || !row.every(Number.isFinite));
  return (
    <Labelled props={props} within extra={bad >= 0 ? `line ${bad + 1} must have ${width} numbers` : null} control={(tied) => (
      <textarea {...tied} class="mono" rows={3} spellcheck={false} value={text} placeholder={`${width} numbers a line`}
        onInput={(e) => {
          setText(e.currentTarget.value);
          const rows = parse(e.currentTarget.value);
          if (rows.every((row) => row.length === width && row.every(Number.isFinite))) props.onChange(rows.length ? rows : undefined);
        }} />
    )} />
  );
}

/** Names of which any number may be ticked. */
function Several(props: FieldProps & { names: Json[] }) {
  const value = (Array.isArray(props.value) ? props.value : []) as Json[], { problems } = useContext(Form), wrong = problemsAt(problems, props.pointer, true);
  return (
    <fieldset class="several" data-pointer={props.pointer} tabIndex={-1}>
      <legend>{words(String(props.name))}</legend>
      <div class="ticks">
        {props.names.map((each) => (
          <label class="tick"><input type="checkbox" checked={value.includes(each)} onChange={(e) => props.onChange(e.currentTarget.checked ? [...value, each] : value.filter((one) => one !== each))} />{said(each)}</label>
        ))}
      </div>
      {wrong.length > 0 && <p class="problem">{wrong.join("; ")}</p>}
      {props.schema.description && <p class="help">{plain(props.schema.description)}</p>}
    </fieldset>
  );
}

/** A list of anything. */
function List(props: FieldProps) {
  const { schemas } = useContext(Form), value = (Array.isArray(props.value) ? props.value : []) as Json[], item = props.schema.items ?? {};
  const most = props.schema.maxItems ?? Infinity;
  const put = (next: Json[]) => props.onChange(next.length || props.required ? next : undefined);
  return (
    <Group {...props} legend={words(String(props.name))}>
      <ol class="list">
        {value.map((each, i) => (
          <li key={i}>
            <Field name={i} schema={item} value={each} pointer={step(props.pointer, i)} required onChange={(next) => put(value.map((one, k) => (k === i ? (next ?? null) : one)))} />
            <button type="button" class="quiet" aria-label={`Remove ${words(String(props.name))} ${i + 1}`} onClick={() => put(value.filter((_, k) => k !== i))}>Remove</button>
          </li>
        ))}
      </ol>
      <button type="button" disabled={value.length >= most} onClick={() => put([...value, schemas.first(item)])}>Add to {words(String(props.name)).toLowerCase()}</button>
    </Group>
  );
}

/** Values by names that the user writes, such as of joints. */
function Entries(props: FieldProps) {
  const { schemas } = useContext(Form), value = (props.value ?? {}) as JsonObject, [name, setName] = useState(""), id = useId();
  const { schema } = props, every = Object.values(schema.patternProperties ?? {})[0] ?? (typeof schema.additionalProperties === "object" ? schema.additionalProperties : {});
  const put = (next: JsonObject) => props.onChange(Object.keys(next).length ? next : undefined);
  const add = () => {
    if (!name.trim()) return;
    put({ ...value, [name.trim()]: schemas.first(every) });
    setName("");
  };
  return (
    <>
      {Object.entries(value).map(([key, each]) => (
        <div class="entry" key={key}>
          <Field name={key} schema={every} value={each} pointer={step(props.pointer, key)} required onChange={(next) => put({ ...value, [key]: next ?? null })} />
          <button type="button" class="quiet" aria-label={`Remove ${key}`} onClick={() => { const { [key]: _, ...rest } = value; put(rest); }}>Remove</button>
        </div>
      ))}
      <div class="add">
        <label for={id} class="hidden">New name in {words(String(props.name))}</label>
        <input id={id} type="text" placeholder="name" value={name} onInput={(e) => setName(e.currentTarget.value)} onKeyDown={(e) => { if (e.key === "Enter") { e.preventDefault(); add(); } }} />
        <button type="button" onClick={add} disabled={!name.trim()}>Add</button>
      </div>
    </>
  );
}
