/** What the robots and the environment of a document look like, while they are edited. */

import { useEffect, useRef, useState } from "preact/hooks";
import type { Signal } from "@preact/signals";
import { readReply } from "../../sources/answer";
import type { Api } from "../../sources/api";
import type { Manifest } from "../../contract";
import { Stage } from "../../scene/stage";
import { defaultSettings } from "../../settings";
import type { Theme } from "../app";
import { message } from "../parts";
import { ARMS, words, type Json, type JsonObject } from "./schema";

const AFTER_MS = 500;

interface Edited { label: string; parts: JsonObject }

/** The robots of a document, each with what is beside it, as the server takes it for a preview. */
function editedIn(document: JsonObject): Edited[] {
  const { environment } = document, around = environment ? { environment } : {};
  const part = (label: string, holder: JsonObject, robot: Json | undefined): Edited[] => {
    if (robot == null || robot === "") return [];
    const ends = Object.fromEntries(["base", "tip"].filter((end) => holder[end]).map((end) => [end, holder[end]]));
    return [{ label, parts: { robot, ...ends, ...around } }];
  };
  const held = (name: string): Edited[] => {
    const value = document[name];
    const inside = typeof value === "object" && value !== null && !Array.isArray(value) && "robot" in value ? value : null;
    return inside ? part(words(name), inside, inside.robot) : part(words(name), document, value);
  };
  const several = Array.isArray(document.robots) ? document.robots : [];
  const found = [...ARMS.flat().flatMap(held), ...several.flatMap((each, i) => (typeof each === "object" && each !== null && !Array.isArray(each) ? part(String(each.name ?? `Robot ${i + 1}`), each, each.robot) : []))];
  return found.length || !environment ? found : [{ label: "Environment", parts: around }];
}

export function Preview({ api, document, theme }: { api: Api; document: JsonObject; theme: Signal<Theme> }) {
  const host = useRef<HTMLDivElement>(null), stage = useRef<Stage | null>(null);
  const [at, setAt] = useState(0), [said, setSaid] = useState(""), [manifest, setManifest] = useState<Manifest | null>(null);
  const edited = editedIn(document), shown = edited[Math.min(at, edited.length - 1)], asked = JSON.stringify(shown?.parts ?? null);
  useEffect(() => {
    try {
      stage.current = new Stage(host.current!);
    } catch (error) {
      setSaid(message(error));
    }
    return () => stage.current?.dispose();
  }, []);
  useEffect(() => {
    if (asked === "null" || !stage.current) return;
    const controller = new AbortController();
    const timer = setTimeout(async () => {
      try {
        const response = await api.fetch("v1/robots:view", { method: "POST", body: asked, signal: controller.signal, headers: { "Content-Type": "application/json" } });
        const { reply, blobs } = readReply(await response.arrayBuffer()), found = (reply as unknown as { manifest: Manifest }).manifest;
        if (controller.signal.aborted) return;
        await stage.current!.load(found, async (name) => blobs[name]!);
        setManifest(found);
        setSaid("");
      } catch (error) {
        if (!controller.signal.aborted) setSaid(message(error));
      }
    }, AFTER_MS);
    return () => {
      clearTimeout(timer);
      controller.abort();
    };
  }, [asked, api]);
  useEffect(() => { if (manifest) stage.current?.apply({ ...defaultSettings(manifest), theme: theme.value }); }, [manifest, theme.value]);
  return (
    <section class="card" aria-label="Preview">
      <div class="bar">
        <h2>Preview</h2>
        {edited.length > 1 && <label><span class="hidden">Robot of the preview</span><select value={String(at)} onChange={(e) => setAt(Number(e.currentTarget.value))}>{edited.map((each, i) => <option value={String(i)}>{each.label}</option>)}</select></label>}
      </div>
      <div class="preview-host" ref={host} hidden={!shown} />
      {!shown && <p class="help">The robot is shown here, with what stands around.</p>}
      {shown && said && <p class="help" role="status">{said}</p>}
      {manifest?.omitted.map((each) => <p class="help">{each}</p>)}
    </section>
  );
}
