/** A view with its panels. */

import type { Signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Source } from "../../contract";
import type { Theme } from "../app";
import type { JsonObject } from "../form/schema";
import { packed, unpacked } from "../route";
import { About, Found } from "./found";
import { Colors, Cuts, Layers, MappingPanel, Painted, Slices, VolumePanel } from "./look";
import { ViewModel } from "./model";
import { PictureDialog } from "./picture";
import { Plots } from "./plots";
import { themeOf } from "./restored";
import { Robots } from "./robots";

const KEEP_MS = 500;
const NARROW = 1100; // panels lie over the view

export interface ViewerProps {
  source: Source;
  theme: Signal<Theme>;
  view?: string | undefined; // packed settings to begin with
  title?: string;
  named?: string; // beside others, what it is called
  panels?: boolean;
  actions?: ComponentChildren;
  onView?(packed: string): void; // the settings changed
  linkOf?(packed: string): string | Promise<string>;
  onJob?(document: JsonObject): void;
  onModel?(model: ViewModel): void;
  picture?(url: string): Promise<string>; // what an img shows of a static picture
}

export function Viewer(props: ViewerProps) {
  const { source, theme } = props, host = useRef<HTMLDivElement>(null), frame = useRef<HTMLDivElement>(null);
  const model = useMemo(() => new ViewModel(source), [source]);
  const [left, setLeft] = useState(false), [right, setRight] = useState(false), [picture, setPicture] = useState(false), [copied, setCopied] = useState("");
  useEffect(() => {
    const wide = frame.current!.clientWidth > NARROW;
    setLeft(wide && props.panels !== false);
    setRight(wide && props.panels !== false);
    let gone = false;
    void (async () => {
      const link = props.view ? await unpacked(props.view) : null;
      if (gone) return;
      theme.value = themeOf(link) ?? theme.value;
      props.onModel?.(model);
      await model.open(host.current!, link);
      if (gone) model.close();
    })();
    return () => {
      gone = true;
      model.close();
    };
  }, [model]);
  const settings = model.settings.value, manifest = model.manifest.value, camera = model.camera.value;
  useEffect(() => { if (settings && settings.theme !== theme.value) model.update({ theme: theme.value }); }, [theme.value, settings?.theme]);
  useEffect(() => {
    if (!settings || !model.ready.value || !props.onView) return;
    const timer = setTimeout(async () => props.onView!(await packed(model.whole())), KEEP_MS);
    return () => clearTimeout(timer);
  }, [settings, camera, model.ready.value]);
  const copy = async () => {
    const link = await props.linkOf!(await packed(model.whole()));
    try {
      await navigator.clipboard.writeText(link);
      setCopied("The link is copied.");
    } catch { // no clipboard: the link is in the address
      setCopied("The link is in the address.");
    }
    history.replaceState(null, "", link);
    setTimeout(() => setCopied(""), 3000);
  };
  const shown = settings && manifest && model.ready.value;
  const told = manifest?.headline.find((each) => !each.label.startsWith("No ")), first = told && (told.label ? `${told.label}: ${told.value}` : told.value);
  return (
    <div class="viewer" ref={frame}>
      <div class="bar">
        <button aria-expanded={left} onClick={() => setLeft(!left)} disabled={!shown}>Look</button>
        <h1 title={props.title ?? manifest?.title}>{props.named && <span class="mono">{props.named} </span>}{props.title ?? manifest?.title ?? "…"}</h1>
        {first && <span class="help" title={first}>{first}</span>}
        <span class="space" />
        {props.actions}
        <button disabled={!shown} onClick={() => model.stage?.fit()}>Show all</button>
        <button disabled={!shown} onClick={() => model.reset()}>Reset</button>
        <button disabled={!shown} onClick={() => setPicture(true)}>Picture</button>
        {props.linkOf && <button disabled={!shown} onClick={copy}>Link</button>}
        <button aria-expanded={right} onClick={() => setRight(!right)} disabled={!shown}>Explore</button>
      </div>
      {model.lost.value && <p class="banner" role="alert">What computes behind this view does not answer. Looking for it again …</p>}
      {model.unanswered.value && <p class="banner" role="alert">No more questions about this view are answered: {model.unanswered.value}</p>}
      <p class="hidden" role="status" aria-live="polite">{model.said.value} {copied}</p>
      <div class="stage-row">
        {shown && left && (
          <div class="panel" role="group" aria-label="What it looks like">
            <Layers model={model} /><VolumePanel model={model} /><Painted model={model} /><Colors model={model} /><Slices model={model} /><Cuts model={model} /><MappingPanel model={model} /><About model={model} />
          </div>
        )}
        <div class="stage">
          <div class="stage-host" ref={host} />
          {!shown && !model.failed.value && !model.undrawn.value && <p class="loading" role="status">Reading the view …</p>}
          {model.failed.value && <p class="loading problem" role="alert">{model.failed.value}</p>}
          {model.undrawn.value && <Pictures model={model} picture={props.picture} />}
          {shown && <div class="overlay">
            {model.shown?.reduced && <p class="notice">{model.shown.reduced}</p>}
            {copied && <p>{copied}</p>}
            {model.said.value && !model.said.value.startsWith("Voxel") && <p>{model.said.value}</p>}
          </div>}
        </div>
        {shown && right && (
          <div class="panel right" role="group" aria-label="Explore">
            <Found model={model} /><Robots model={model} onJob={props.onJob} /><Plots model={model} />
          </div>
        )}
      </div>
      {picture && <PictureDialog model={model} onDone={() => setPicture(false)} />}
    </div>
  );
}

/** Instead of the view: what the result has of pictures. */
function Pictures({ model, picture }: { model: ViewModel; picture: ((url: string) => Promise<string>) | undefined }) {
  const manifest = model.manifest.value, [urls, setUrls] = useState<Record<string, string>>({});
  useEffect(() => {
    const found = (manifest?.pictures ?? []).map(async ({ name, url }) => [name, await (picture?.(url) ?? url)] as const);
    for (const each of found) void each.then(([name, url]) => setUrls((before) => ({ ...before, [name]: url })), () => undefined);
    return () => { for (const each of found) void each.then(([, url]) => URL.revokeObjectURL(url), () => undefined); }; // where it is one
  }, [manifest]);
  return (
    <div class="pictures" tabIndex={0} role="region" aria-label="Pictures of the result">
      <p class="notice" role="alert">{model.undrawn.value} {manifest?.pictures.length ? "These are pictures of the result instead." : model.source.home === "file" ? "Pictures of the result, where it has any, are further down." : "The result has no pictures to show instead."}</p>
      {(manifest?.pictures ?? []).map((each) => urls[each.name] && <figure key={each.name}><img src={urls[each.name]} alt={each.label} /><figcaption>{each.label}</figcaption></figure>)}
    </div>
  );
}
