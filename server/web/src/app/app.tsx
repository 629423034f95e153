/** The page of `wsrender serve`: jobs, new jobs, results, two results side by side. */

import { useEffect, useRef, useState } from "preact/hooks";
import { useSignalEffect, type Signal } from "@preact/signals";
import type { Api } from "../sources/api";
import { Submit } from "./form/submit";
import { Files, JobList } from "./jobs/list";
import { hashOf, placeOf, type Go, type Place } from "./route";
import { Compare } from "./view/compare";
import { JobView } from "./view/job_view";

export type Theme = "light" | "dark" | "system";

export function App({ api, theme }: { api: Api; theme: Signal<Theme> }) {
  const [place, setPlace] = useState<Place>(placeOf(location.hash)), [entering, setEntering] = useState(false), [files, setFiles] = useState(false);
  const go: Go = (next) => {
    history.pushState(null, "", hashOf(next));
    setPlace(next);
  };
  useEffect(() => {
    const follow = () => setPlace(placeOf(location.hash));
    addEventListener("popstate", follow);
    addEventListener("hashchange", follow);
    return () => {
      removeEventListener("popstate", follow);
      removeEventListener("hashchange", follow);
    };
  }, []);
  useSignalEffect(() => { if (api.refused.value !== null) setEntering(true); });
  useEffect(() => { document.title = `${titleOf(place)} · wsrender`; }, [place]);
  const link = (to: Place, text: string, current: boolean) => <a href={hashOf(to)} aria-current={current ? "page" : undefined} onClick={(e) => { if (!e.metaKey && !e.ctrlKey) { e.preventDefault(); go(to); } }}>{text}</a>;
  return (
    <>
      <header class="top">
        <span class="brand">wsrender</span>
        <nav aria-label="Pages">
          {link({ page: "jobs" }, "Jobs", place.page === "jobs")}
          {link({ page: "new", start: null }, "New job", place.page === "new")}
          {place.page === "job" && <span aria-current="page">Job <span class="mono">{place.id.slice(0, 8)}</span></span>}
          {place.page === "compare" && <span aria-current="page">Two results</span>}
        </nav>
        <span class="space" />
        {place.page === "job" && <button onClick={() => setFiles(!files)} aria-expanded={files}>Files</button>}
        <ThemeChoice theme={theme} />
        <button onClick={() => setEntering(true)}>{api.key.value ? "API key: set" : "API key"}</button>
        <a href="docs">API</a>
      </header>
      {api.lost.value && <p class="banner" role="alert">The server does not answer. Looking for it again …</p>}
      {files && place.page === "job" && <section class="card drawer" aria-label="Files of the job"><h2>Files</h2><Files api={api} id={place.id} /></section>}
      <main class={`at-${place.page}`}>
        {place.page === "jobs" && <JobList key={api.key.value} api={api} go={go} />}
        {place.page === "none" && <p class="problem page" role="alert">The address of this link is no page here: it must be that of a job or of two, whole.</p>}
        {place.page === "new" && <Submit key={JSON.stringify(place.start)} api={api} theme={theme} start={place.start} onSubmitted={() => go({ page: "jobs" })} />}
        {place.page === "job" && <JobView key={place.id + api.key.value} api={api} id={place.id} view={place.view} theme={theme} go={go} />}
        {place.page === "compare" && <Compare key={place.first + place.second + api.key.value} api={api} first={place.first} second={place.second} view={place.view} other={place.other} theme={theme} />}
      </main>
      {entering && <KeyDialog api={api} onDone={() => setEntering(false)} />}
    </>
  );
}

function titleOf(place: Place): string {
  if (place.page === "job") return `Job ${place.id.slice(0, 8)}`;
  return { jobs: "Jobs", new: "New job", compare: "Two results", none: "No page" }[place.page];
}

export function ThemeChoice({ theme }: { theme: Signal<Theme> }) {
  return (
    <label class="theme"><span class="hidden">Theme</span>
      <select value={theme.value} onChange={(e) => { theme.value = e.currentTarget.value as Theme; }}>
        <option value="system">as the system</option>
        <option value="light">light</option>
        <option value="dark">dark</option>
      </select>
    </label>
  );
}

function KeyDialog({ api, onDone }: { api: Api; onDone(): void }) {
  const dialog = useRef<HTMLDialogElement>(null), [key, setKey] = useState("");
  useEffect(() => { dialog.current!.showModal(); }, []);
  return (
    <dialog ref={dialog} onClose={onDone} aria-labelledby="key-title">
      <form method="dialog" onSubmit={() => api.setKey(key)}>
        <h2 id="key-title">API key</h2>
        {api.refused.value && <p class="problem">{api.refused.value}</p>}
        <p class="help">Kept for this tab only, and in no link.</p>
        <label class="wide">Key <input type="password" autocomplete="off" value={key} onInput={(e) => setKey(e.currentTarget.value)} /></label>
        <div class="bar">
          <button class="primary" type="submit">Use it</button>
          {api.key.value && <button type="button" onClick={() => { api.setKey(""); dialog.current!.close(); }}>Forget it</button>}
          <button type="button" onClick={() => dialog.current!.close()}>Close</button>
        </div>
      </form>
    </dialog>
  );
}
