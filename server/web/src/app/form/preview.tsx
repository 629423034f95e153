/** What the robots and the environment of a document look like while they are edited; a robot is moved, and its volume shown. */

import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Signal } from "@preact/signals";
import type { Manifest } from "../../contract";
import type { Api } from "../../sources/api";
import { editedSource } from "../../sources/served";
import type { Theme } from "../app";
import { message } from "../parts";
import { ViewModel } from "../view/model";
import { Robots } from "../view/robots";
import { ARMS, words, type Json, type JsonObject } from "./schema";

const AFTER_MS = 500;

interface Edited { label: string; parts: JsonObject; put(robot: Json): JsonObject } // put: the document with another robot there

/** The robots of a document, each with what is beside it, as the server takes it for a preview. */
function editedIn(document: JsonObject): Edited[] {
  const around = among(document, ["environment", "constraints", "gravity_m_s2"]);
  const part = (label: string, holder: JsonObject, name: string, put: (holder: JsonObject) => JsonObject): Edited[] => {
    const robot = holder[name];
    if (robot == null || robot === "") return [];
    return [{ label, parts: { ...around, robot, ...among(holder, ["base", "tip", "environment", "constraints", "gravity_m_s2"]) }, put: (other) => put({ ...holder, [name]: other }) }];
  };
  const held = (name: string): Edited[] => {
    const value = document[name];
    return isObject(value) && "robot" in value ? part(words(name), value, "robot", (holder) => ({ ...document, [name]: holder })) : part(words(name), document, name, (holder) => holder);
  };
  const several = Array.isArray(document.robots) ? document.robots : [];
  const found = [...ARMS.flat().flatMap(held), ...several.flatMap((each, i) => (isObject(each) ? part(String(each.name ?? `Robot ${i + 1}`), each, "robot", (holder) => ({ ...document, robots: several.map((other, k) => (k === i ? holder : other)) })) : []))];
  return found.length || !document.environment ? found : [{ label: "Environment", parts: among(document, ["environment"]), put: () => document }];
}

const isObject = (value: Json | undefined): value is JsonObject => typeof value === "object" && value !== null && !Array.isArray(value);
const among = (holder: JsonObject, names: string[]): JsonObject => Object.fromEntries(names.filter((name) => holder[name]).map((name) => [name, holder[name]]));

const NOTHING: Manifest = { format: 1, title: "", analysis: "", headline: [], warnings: [], job: null, robots: [], skeletons: [], volumes: [], meshes: [], points: [], glyphs: [], curves: [], maps: [], plots: [], mapping: null, pictures: [], omitted: [] };

interface PreviewProps { api: Api; document: JsonObject; theme: Signal<Theme>; onChange(document: JsonObject): void }

export function Preview({ api, document, theme, onChange }: PreviewProps) {
  const host = useRef<HTMLDivElement>(null), [at, setAt] = useState(0), [said, setSaid] = useState("");
  const model = useMemo(() => new ViewModel({ home: "served", manifest: async () => NOTHING, blob: () => Promise.reject(new Error("there is none")) }), []);
  const edited = editedIn(document), shown = edited[Math.min(at, edited.length - 1)], asked = JSON.stringify(shown?.parts ?? null);
  useEffect(() => {
    void model.open(host.current!, { theme: theme.value });
    return () => model.close();
  }, []);
  useEffect(() => {
    if (asked === "null") return;
    let gone = false;
    const timer = setTimeout(async () => {
      try {
        await model.replace(editedSource(api, JSON.parse(asked) as JsonObject));
        if (!gone) setSaid("");
      } catch (error) {
        if (!gone) setSaid(message(error));
      }
    }, AFTER_MS);
    return () => {
      gone = true;
      clearTimeout(timer);
    };
  }, [asked, api]);
  useEffect(() => model.update({ theme: theme.value }), [theme.value]);
  const manifest = model.manifest.value, drawn = model.ready.value;
  return (
    <section class="card" aria-label="Preview">
      <div class="bar">
        <h2>Preview</h2>
        {edited.length > 1 && <label><span class="hidden">Robot of the preview</span><select value={String(at)} onChange={(e) => setAt(Number(e.currentTarget.value))}>{edited.map((each, i) => <option value={String(i)}>{each.label}</option>)}</select></label>}
      </div>
      <div class="preview-host" ref={host} hidden={!shown} />
      {!shown && <p class="help">The robot is shown here, with what stands around.</p>}
      {shown && !drawn && model.undrawn.value && <p class="help" role="status">{model.undrawn.value}</p>}
      {shown && said && <p class="help" role="status">{said}</p>}
      {shown && model.lost.value && <p class="notice" role="alert">What computes behind this preview does not answer. Looking for it again …</p>}
      {shown && model.unanswered.value && <p class="notice" role="alert">No more questions about this preview are answered: {model.unanswered.value}</p>}
      {manifest?.omitted.map((each) => <p class="help">{each}</p>)}
      {shown && drawn && manifest!.robots.length > 0 && <div class="viewer moved"><div class="panel"><Robots key={asked} model={model} open={false} jobLabel="Into the form" onJob={(part) => onChange(shown.put(part.robot!))} /></div></div>}
      <p class="help" role="status">{shown && !model.gizmo.value ? model.said.value : ""}</p>
    </section>
  );
}
