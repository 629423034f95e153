/** The list of jobs: states and progress as they happen, filters, and what can be done with each. */

import { useEffect, useRef, useState } from "preact/hooks";
import type { Api } from "../../sources/api";
import { Schemas, words } from "../form/schema";
import { message, number, seconds, size, useLoaded, download } from "../parts";
import type { Go } from "../route";
import { ENDED, newer, STATES, type Job, type JobFile, type Progress, type State } from "./job";

const MOST_FOLLOWED = 3; // browsers open six connections to a host
const LOOK_AGAIN_MS = 4000;
const PAGE = 50;

export function JobList({ api, go }: { api: Api; go: Go }) {
  const [jobs, setJobs] = useState<Job[] | null>(null), [next, setNext] = useState<string | null>(null), [problem, setProblem] = useState(""), [undone, setUndone] = useState("");
  const [state, setState] = useState(""), [analysis, setAnalysis] = useState(""), [label, setLabel] = useState(""), [robot, setRobot] = useState(""), [said, setSaid] = useState("");
  const [open, setOpen] = useState(""), [marked, setMarked] = useState<string[]>([]);
  const analyses = useLoaded(async () => new Schemas(await api.description()).analyses(), [api]);
  const further = useRef(false); // whether more than the first page is shown
  const asking = useRef(0); // what was asked before other filters were chosen is no longer shown
  const followed = useRef(new Map<string, AbortController>());

  const query = (cursor?: string) => {
    const parameters = new URLSearchParams({ limit: String(PAGE) });
    if (state) parameters.set("state", state);
    if (analysis) parameters.set("analysis", analysis);
    if (/^[^=]+=/.test(label)) parameters.set("label", label);
    if (robot) parameters.set("robot", robot);
    if (cursor) parameters.set("cursor", cursor);
    return `v1/jobs?${parameters}`;
  };
  const load = async () => {
    const asked = asking.current;
    try {
      const page = await api.get<{ items: Job[]; next_cursor: string | null }>(query());
      if (asked !== asking.current) return;
      setJobs((before) => [...page.items.map((job) => newer(before?.find((each) => each.id === job.id), job)), ...(further.current ? olderThan(page.items, before ?? []) : [])]);
      if (!further.current) setNext(page.next_cursor);
      setProblem("");
    } catch (error) {
      if (asked === asking.current) setProblem(message(error));
    }
  };
  const more = async () => {
    const asked = asking.current;
    try {
      const page = await api.get<{ items: Job[]; next_cursor: string | null }>(query(next!));
      if (asked !== asking.current) return;
      further.current = true;
      setJobs((before) => [...(before ?? []), ...page.items]);
      setNext(page.next_cursor);
    } catch (error) {
      setProblem(message(error));
    }
  };
  const put = (id: string, change: (job: Job) => Job) => setJobs((before) => before && before.map((each) => (each.id === id ? newer(each, change(each)) : each)));

  useEffect(() => {
    setJobs(null);
    asking.current++;
    further.current = false;
    void load();
    const timer = setInterval(() => { if (document.visibilityState === "visible") void load(); }, LOOK_AGAIN_MS);
    return () => clearInterval(timer);
  }, [state, analysis, label, robot, api.key.value]);

  useEffect(() => { // the newest that go on are followed by their events
    const going = (jobs ?? []).filter((job) => !ENDED.includes(job.state)).slice(0, MOST_FOLLOWED);
    for (const [id, controller] of followed.current) {
      if (going.some((job) => job.id === id)) continue;
      controller.abort();
      followed.current.delete(id);
    }
    for (const job of going) if (!followed.current.has(job.id)) {
      const controller = new AbortController();
      followed.current.set(job.id, controller);
      void follow(job, controller.signal);
    }
  }, [jobs?.map((job) => job.id + job.state).join()]);
  useEffect(() => () => { for (const controller of followed.current.values()) controller.abort(); }, []);

  const follow = async ({ id, last_event: after }: Job, signal: AbortSignal) => { // what came before is in the list
    for await (const { id: number, event, data } of api.events(`v1/jobs/${id}/events`, after, signal)) {
      const last_event = Number(number);
      if (event === "progress") put(id, (job) => ({ ...job, last_event, progress: { ...job.progress, ...(data as Partial<Progress>) } }));
      if (event !== "state") continue;
      put(id, (job) => ({ ...job, last_event, state: data.state as State, error: data.error ?? null }));
      if (!ENDED.includes(data.state)) continue;
      setSaid(`Job ${id.slice(0, 8)} has ${data.state === "succeeded" ? "succeeded" : data.state.replace("_", " ")}.`);
      return void load();
    }
  };
  const act = async (job: Job, what: "cancel" | "retry" | "delete") => {
    setUndone("");
    try {
      if (what === "delete") {
        await api.fetch(`v1/jobs/${job.id}`, { method: "DELETE" });
        setJobs((before) => before && before.filter((each) => each.id !== job.id));
        setMarked((before) => before.filter((each) => each !== job.id));
      } else {
        const changed = await api.post<Job>(`v1/jobs/${job.id}:${what}`);
        put(job.id, () => changed);
      }
      setSaid(`Job ${job.id.slice(0, 8)}: ${what} is done.`);
    } catch (error) {
      setUndone(`Job ${job.id.slice(0, 8)}, ${what}: ${message(error)}`);
    }
  };
  const mark = (id: string) => setMarked((before) => (before.includes(id) ? before.filter((each) => each !== id) : [...before.slice(-1), id]));

  return (
    <section class="jobs" aria-label="Jobs">
      <div class="bar">
        <h1>Jobs</h1>
        <label>State <select value={state} onChange={(e) => setState(e.currentTarget.value)}><option value="">all</option>{STATES.map((each) => <option value={each}>{each.replace("_", " ")}</option>)}</select></label>
        <label>Analysis <select value={analysis} onChange={(e) => setAnalysis(e.currentTarget.value)}>
          <option value="">all</option>
          {(analyses.value ?? []).map((each) => <option value={each.name}>{each.title}</option>)}
        </select></label>
        <label>Robot <input type="text" placeholder="part of its name" maxLength={100} value={robot} onInput={(e) => setRobot(e.currentTarget.value)} /></label>
        <label>Label <input type="text" placeholder="key=value" value={label} onInput={(e) => setLabel(e.currentTarget.value)} /></label>
        <span class="space" />
        <button disabled={marked.length !== 2} onClick={() => go({ page: "compare", first: marked[0]!, second: marked[1]! })}>Compare two{marked.length ? ` (${marked.length} marked)` : ""}</button>
        <button class="primary" onClick={() => go({ page: "new", start: null })}>New job</button>
      </div>
      <p class="hidden" role="status" aria-live="polite">{said}</p>
      {[problem, undone].map((each) => each && <p class="problem" role="alert">{each}</p>)}
      {!jobs ? !problem && <p class="wait" role="status">Reading the jobs …</p> : jobs.length === 0 ? <p class="empty">No jobs{state || analysis || label || robot ? " like that" : " yet"}. <button class="link" onClick={() => go({ page: "new", start: null })}>Write one</button>.</p> : (
        <div class="table"><table>
          <thead><tr><th scope="col"><span class="hidden">Compare</span></th><th scope="col">Job</th><th scope="col">Analysis, robots</th><th scope="col">State</th><th scope="col">Progress</th><th scope="col">Submitted</th><th scope="col">Labels</th><th scope="col">What to do</th></tr></thead>
          <tbody>{jobs.map((job) => <Row key={job.id} job={job} api={api} go={go} open={open === job.id} onOpen={() => setOpen(open === job.id ? "" : job.id)} marked={marked.includes(job.id)} onMark={() => mark(job.id)} act={act} />)}</tbody>
        </table></div>
      )}
      {next && <button onClick={more}>More</button>}
    </section>
  );
}

/** Of the jobs that were shown those that come after a page which was read again. */
function olderThan(page: Job[], before: Job[]): Job[] {
  const last = page.at(-1)?.created_at ?? "", ids = new Set(page.map((job) => job.id));
  return before.filter((job) => job.created_at <= last && !ids.has(job.id));
}

function Row({ job, api, go, open, onOpen, marked, onMark, act }: { job: Job; api: Api; go: Go; open: boolean; onOpen(): void; marked: boolean; onMark(): void; act(job: Job, what: "cancel" | "retry" | "delete"): void }) {
  const short = job.id.slice(0, 8), done = job.state === "succeeded", ended = ENDED.includes(job.state);
  return (
    <>
      <tr data-job={job.id} data-state={job.state}>
        <td>{done && <input type="checkbox" aria-label={`Compare job ${short}`} checked={marked} onChange={onMark} />}</td>
        <td class="mono">{done ? <button class="link" onClick={() => go({ page: "job", id: job.id })}>{short}</button> : short}</td>
        <td>{words(job.analysis)}{job.robots.length > 0 && <span class="of">{job.robots.join(", ")}</span>}</td>
        <td><span class={`state ${job.state}`}>{job.state.replace("_", " ")}</span></td>
        <td><Bar job={job} /></td>
        <td><time dateTime={job.created_at}>{new Date(job.created_at).toLocaleString()}</time></td>
        <td>{Object.entries(job.labels).map(([key, value]) => <span class="tag">{key}={value}</span>)}</td>
        <td class="actions">
          {done && <button onClick={() => go({ page: "job", id: job.id })} aria-label={`View job ${short}`}>View</button>}
          <button onClick={onOpen} aria-expanded={open} aria-label={`Details of job ${short}`}>Details</button>
          {!ended && <button disabled={job.state === "canceling"} onClick={() => act(job, "cancel")} aria-label={`Cancel job ${short}`}>Cancel</button>}
          {ended && !done && <button onClick={() => act(job, "retry")} aria-label={`Retry job ${short}`}>Retry</button>}
          {ended && <Delete short={short} onDelete={() => act(job, "delete")} />}
        </td>
      </tr>
      {open && <tr class="details"><td colSpan={8}><Details job={job} api={api} /></td></tr>}
    </>
  );
}

/** Asks again: what is deleted is gone. */
function Delete({ short, onDelete }: { short: string; onDelete(): void }) {
  const [sure, setSure] = useState(false);
  return <button class={sure ? "danger" : ""} onClick={() => (sure ? onDelete() : setSure(true))} onBlur={() => setSure(false)} aria-label={sure ? `Really delete job ${short}` : `Delete job ${short}`}>{sure ? "Really?" : "Delete"}</button>;
}

function Bar({ job }: { job: Job }) {
  if (job.state === "queued") return <span class="help">waits</span>;
  if (ENDED.includes(job.state)) return (
    <>
      <span class="help">{job.finished_at && job.started_at ? seconds((Date.parse(job.finished_at) - Date.parse(job.started_at)) / 1000) : ""}</span>
      {job.error && <span class="why problem" title={job.error.detail}>{job.error.detail}</span>}
    </>
  );
  const { fraction, eta_s, message: doing } = job.progress;
  return (
    <span class="progress">
      <progress max={1} value={fraction} aria-label={`Progress of job ${job.id.slice(0, 8)}`} />
      <span class="help">{Math.floor(100 * fraction)} % {eta_s != null && `· ${seconds(eta_s)} to go`} {doing}</span>
    </span>
  );
}

function Details({ job, api }: { job: Job; api: Api }) {
  return (
    <div>
      <dl class="facts">
        <dt>Id</dt><dd class="mono">{job.id}</dd>
        <dt>Attempt</dt><dd>{job.attempt}</dd>
        <dt>Priority</dt><dd>{job.priority}</dd>
        {job.progress.rate_per_s != null && <><dt>Samples per second</dt><dd>{number(job.progress.rate_per_s, 3)}</dd></>}
      </dl>
      {job.error && <p class="problem">{job.error.title}: {job.error.detail}</p>}
      {job.warnings.map((each) => <p class="notice">{each.message}</p>)}
      {job.state === "succeeded" && <Files api={api} id={job.id} />}
    </div>
  );
}

/** The job's files, each to be downloaded: by fetch, since links carry no key. */
export function Files({ api, id }: { api: Api; id: string }) {
  const loaded = useLoaded(() => api.get<{ items: JobFile[] }>(`v1/jobs/${id}/artifacts`), [api, id]), [problem, setProblem] = useState("");
  const fetchIt = async (file: JobFile) => {
    try {
      download(await (await api.fetch(file.href)).blob(), file.name.split("/").pop()!);
    } catch (error) {
      setProblem(message(error));
    }
  };
  if (loaded.error) return <p class="problem">{message(loaded.error)}</p>;
  return (
    <>
      {problem && <p class="problem" role="alert">{problem}</p>}
      <ul class="files">{(loaded.value?.items ?? []).map((file) => <li><button class="link" onClick={() => fetchIt(file)}>{file.name}</button> <span class="help">{size(file.bytes)}</span></li>)}</ul>
    </>
  );
}
