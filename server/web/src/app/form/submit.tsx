/** A new job: a form of its schema or its JSON, checked by the server while it is written, with what it would take. */

import type { Signal } from "@preact/signals";
import { useEffect, useId, useMemo, useRef, useState } from "preact/hooks";
import { ApiError, type Api } from "../../sources/api";
import type { Theme } from "../app";
import type { Job } from "../jobs/job";
import { parse } from "../../json";
import { Failure, seconds, size, useLoaded } from "../parts";
import { Form, ObjectFields, type Problem, type Uploaded } from "./fields";
import { Preview } from "./preview";
import { Schemas, plain, words, type AnalysisSchema, type Json, type JsonObject } from "./schema";

interface Estimate { samples: number; memory_bytes: number | null; file_bytes: number | null; seconds: number | null }
type Checked = { state: "none" } | { state: "checking" } | { state: "good"; estimate: Estimate } | { state: "bad"; problems: Problem[]; text: string };

const CHECK_AFTER_MS = 450, CHECK_AGAIN_MS = 2000;
const OPTIONS = ["labels", "priority", "timeout_s"];

/** `start` is a document to begin with, such as of what was dragged, or of another job. */
export function Submit({ api, theme, start, onSubmitted }: { api: Api; theme: Signal<Theme>; start: JsonObject | null; onSubmitted(job: Job): void }) {
  const loaded = useLoaded(async () => new Schemas(await api.description()), [api]);
  if (loaded.error) return <Failure error={loaded.error} />;
  if (!loaded.value) return <p class="wait" role="status">Reading what can be asked for …</p>;
  return <Written api={api} theme={theme} schemas={loaded.value} start={start} onSubmitted={onSubmitted} />;
}

function Written({ api, theme, schemas, start, onSubmitted }: { api: Api; theme: Signal<Theme>; schemas: Schemas; start: JsonObject | null; onSubmitted(job: Job): void }) {
  const analyses = useMemo(() => schemas.analyses(), [schemas]);
  const [name, setName] = useState(String(start?.analysis ?? "workspace"));
  const [value, setValue] = useState<JsonObject>(() => {
    const schema = start && analyses.find((each) => each.name === start.analysis)?.schema;
    return schema ? (schemas.trimmed(start, schema) as JsonObject) : { analysis: "workspace" };
  });
  const [raw, setRaw] = useState(false), [touched, setTouched] = useState(start !== null), [sending, setSending] = useState(false);
  const [checked, setChecked] = useState<Checked>({ state: "none" }), [text, setText] = useState("");
  const page = useRef<HTMLDivElement>(null), form = useId();
  const analysis = analyses.find((each) => each.name === name);

  const change = (next: JsonObject) => {
    setValue(next);
    setTouched(true);
  };
  const choose = (other: AnalysisSchema) => { // what both know is kept
    const kept = Object.fromEntries(Object.entries(value).filter(([key, item]) => other.schema.properties?.[key] && schemas.fits(item, other.schema.properties[key])));
    setName(other.name);
    change({ ...kept, analysis: other.name });
  };

  useEffect(() => {
    if (!touched) return;
    setChecked({ state: "checking" });
    const controller = new AbortController();
    const check = async () => {
      try {
        setChecked({ state: "good", estimate: await api.post<Estimate>("v1/jobs:validate", value, controller.signal) });
      } catch (error) {
        if (controller.signal.aborted) return;
        if (error instanceof ApiError && error.problem.retryable) timer = window.setTimeout(check, CHECK_AGAIN_MS); // still planning
        else setChecked(wrong(error));
      }
    };
    let timer = window.setTimeout(check, CHECK_AFTER_MS);
    return () => {
      clearTimeout(timer);
      controller.abort();
    };
  }, [value, touched]);

  const upload = async (file: File) => {
    const type = typeOf(file.name);
    const response = await api.fetch("v1/models", { method: "POST", body: file, headers: { "Content-Type": type } });
    return (await response.json()) as Uploaded;
  };
  const submit = async (event: Event) => {
    event.preventDefault();
    setSending(true);
    try {
      onSubmitted(await api.post<Job>("v1/jobs", value));
    } catch (error) {
      setTouched(true);
      setChecked(wrong(error));
      requestAnimationFrame(() => page.current?.querySelector<HTMLElement>("[aria-invalid], .problems button")?.focus());
    } finally {
      setSending(false);
    }
  };
  const problems = checked.state === "bad" ? checked.problems : [];
  const find = (pointer: string) => {
    for (let at = pointer; at; at = at.slice(0, at.lastIndexOf("/"))) {
      const field = page.current?.querySelector<HTMLElement>(`[data-pointer="${CSS.escape(at)}"]`);
      if (!field) continue;
      for (let details = field.closest("details"); details; details = details.parentElement?.closest("details") ?? null) details.open = true;
      field.scrollIntoView({ block: "center" });
      return field.focus();
    }
  };
  const edit = () => {
    if (!raw) setText(JSON.stringify(value, null, 2));
    setRaw(!raw);
  };
  return (
    <Form.Provider value={{ schemas, problems, upload }}>
      <div class="submit" ref={page}>
        <form class="column" id={form} onSubmit={submit} noValidate>
          <div class="bar">
            <h1>New job</h1>
            <button type="button" onClick={edit} aria-pressed={raw}>Edit as JSON</button>
          </div>
          {raw ? <RawEditor text={text} onText={(typed, parsed) => {
            setText(typed);
            if (!parsed) return;
            if (typeof parsed.analysis === "string") setName(parsed.analysis);
            change(parsed);
          }} /> : (
            <>
              <div class="field">
                <label for="analysis">Analysis</label>
                <select id="analysis" value={name} onChange={(e) => choose(analyses.find((each) => each.name === e.currentTarget.value)!)}>
                  {analyses.map((each) => <option value={each.name}>{each.title}</option>)}
                </select>
                <p class="help">{analysis?.description}</p>
              </div>
              {analysis && <ObjectFields key={name} name={name} schema={analysis.schema} value={value} pointer="#" leave={OPTIONS} open onChange={(next) => change(next as JsonObject)} />}
              {analysis && <fieldset class="group"><legend>Of the job itself</legend>
                <ObjectFields name="options" schema={optionsOf(analysis)} value={value} pointer="#" onChange={(next) => change(next as JsonObject)} />
              </fieldset>}
            </>
          )}
        </form>
        <aside class="column side" aria-label="Preview and cost">
          <Preview api={api} document={value} theme={theme} onChange={(next) => { change(next); setText(JSON.stringify(next, null, 2)); }} />
          <section class="card" aria-live="polite">
            <h2>What it takes</h2>
            <Cost checked={checked} onFind={find} />
          </section>
          <button class="primary" type="submit" form={form} disabled={sending}>{sending ? "Submitting …" : "Submit"}</button>
        </aside>
      </div>
    </Form.Provider>
  );
}

function optionsOf(analysis: AnalysisSchema) {
  const properties = Object.fromEntries(OPTIONS.map((name) => [name, analysis.schema.properties![name]!]));
  return { type: "object", properties };
}

function Cost({ checked, onFind }: { checked: Checked; onFind(pointer: string): void }) {
  if (checked.state === "none") return <p class="help">Fill in what is marked with *; the server checks the job while it is written.</p>;
  if (checked.state === "checking") return <p class="help">Checking …</p>;
  if (checked.state === "bad") return (
    <>
      <p class="problem" role="alert">{checked.problems.length ? "The job can't be submitted yet:" : checked.text}</p>
      <ul class="problems">{checked.problems.map((each) => <li><button type="button" class="link" onClick={() => onFind(each.pointer)}>{pathOf(each.pointer)}</button>: {each.detail}</li>)}</ul>
    </>
  );
  const { estimate } = checked;
  return (
    <dl class="facts">
      <dt>Samples</dt><dd>{estimate.samples.toLocaleString("en")}</dd>
      <dt>Time, about</dt><dd>{estimate.seconds === null ? "little" : seconds(estimate.seconds)}</dd>
      <dt>Memory, about</dt><dd>{estimate.memory_bytes === null ? "little" : size(estimate.memory_bytes)}</dd>
      <dt>Files, about</dt><dd>{estimate.file_bytes === null ? "little" : size(estimate.file_bytes)}</dd>
    </dl>
  );
}

function pathOf(pointer: string): string {
  const steps = pointer.replace(/^#\/?/, "").split("/").filter(Boolean).map((each) => (/^\d+$/.test(each) ? String(Number(each) + 1) : words(each)));
  return steps.join(" › ") || "The job";
}

function wrong(error: unknown): Checked {
  if (error instanceof ApiError) return { state: "bad", text: error.problem.detail, problems: (error.problem.errors ?? []).map((each) => ({ ...each, detail: plain(each.detail) })) };
  return { state: "bad", text: "The server does not answer.", problems: [] };
}

function RawEditor({ text, onText }: { text: string; onText(text: string, parsed: JsonObject | null): void }) {
  const [problem, setProblem] = useState("");
  return (
    <div class={`field ${problem ? "wrong" : ""}`}>
      <label for="document">Job document</label>
      <textarea id="document" class="mono" rows={30} spellcheck={false} value={text} aria-invalid={problem ? "true" : undefined} aria-describedby="document-problem"
        onInput={(e) => {
          const typed = e.currentTarget.value;
          let parsed: Json = null;
          try {
            parsed = parse(typed);
            setProblem(typeof parsed === "object" && parsed && !Array.isArray(parsed) ? "" : "must be a JSON object");
          } catch (error) {
            setProblem((error as Error).message);
          }
          onText(typed, typeof parsed === "object" && parsed && !Array.isArray(parsed) ? parsed : null);
        }} />
      <p class="problem" id="document-problem">{problem}</p>
    </div>
  );
}

/** Media types that the server takes, by ending. */
function typeOf(name: string): string {
  const ending = name.toLowerCase().split(".").pop() ?? "";
  return { stl: "model/stl", obj: "model/obj", ply: "model/ply", npy: "application/x-npy", csv: "text/csv", parquet: "application/vnd.apache.parquet", zip: "application/zip" }[ending] ?? "application/xml";
}
