/** The server's HTTP API: its key, its problems (RFC 9457), its events. */

import { signal } from "@preact/signals";

export interface Problem { title: string; status: number; detail: string; code: string; retryable: boolean; errors?: { pointer: string; detail: string }[]; choices?: string[] }

export class ApiError extends Error {
  constructor(readonly problem: Problem) { super(problem.detail); }
}

export interface Event { id: string; event: string; data: any }

const KEY = "wsrender.key"; // of the tab's storage: gone with the tab, never in a link
const LOOK_AGAIN_MS = 1500;

/** Requests relative to the page, so that it works behind a prefix. Throws ApiError; a server that is gone is `lost`. */
export class Api {
  readonly key = signal(sessionStorage.getItem(KEY) ?? "");
  readonly refused = signal<string | null>(null); // why a key is asked for
  readonly lost = signal(false);

  private openapi: Promise<any> | null = null;

  constructor(readonly base: URL) {}

  setKey(key: string): void {
    this.key.value = key.trim();
    if (this.key.value) sessionStorage.setItem(KEY, this.key.value);
    else sessionStorage.removeItem(KEY);
    this.refused.value = null;
  }

  /** The server takes no such key, or none. */
  askForKey(): void { this.refused.value = this.key.value ? "The server does not know this key." : "This server asks for an API key."; }

  async fetch(path: string, init: RequestInit = {}): Promise<Response> {
    const headers = new Headers(init.headers);
    if (this.key.value) headers.set("Authorization", `Bearer ${this.key.value}`);
    let response: Response;
    try {
      response = await fetch(new URL(path.replace(/^\//, ""), this.base), { ...init, headers, cache: "no-cache" });
    } catch (error) {
      if (!init.signal?.aborted) this.watch();
      throw error;
    }
    if (response.ok) return response;
    const problem = await problemOf(response);
    if (response.status === 401) this.askForKey();
    throw new ApiError(problem);
  }

  /** The OpenAPI document, read once. */
  description(): Promise<any> { return this.openapi ??= this.get("openapi.json").catch((error) => { this.openapi = null; throw error; }); }

  async get<T>(path: string, signal?: AbortSignal): Promise<T> { return (await this.fetch(path, signal ? { signal } : {})).json(); }

  async post<T>(path: string, body?: unknown, signal?: AbortSignal): Promise<T> {
    const json = body === undefined ? {} : { body: JSON.stringify(body), headers: { "Content-Type": "application/json" } };
    return (await this.fetch(path, { method: "POST", ...json, ...(signal ? { signal } : {}) })).json();
  }

  /** Server-sent events after one, by fetch: EventSource sends no Authorization. Goes on where it broke off until it is left, aborted or refused. */
  async *events(path: string, after: number, signal: AbortSignal): AsyncGenerator<Event> {
    let last = String(after);
    while (!signal.aborted) {
      try {
        const response = await this.fetch(path, { signal, headers: { "Last-Event-ID": last } });
        for await (const event of eventsOf(response.body!)) {
          last = event.id || last;
          yield event;
        }
      } catch (error) {
        if (signal.aborted || error instanceof ApiError) return;
      }
      await new Promise((done) => setTimeout(done, LOOK_AGAIN_MS)); // a stream ends with its job, but also with the server
    }
  }

  private async watch(): Promise<void> {
    if (this.lost.value) return;
    this.lost.value = true;
    while (this.lost.value) {
      await new Promise((done) => setTimeout(done, LOOK_AGAIN_MS));
      const answer = await fetch(new URL("healthz", this.base)).catch(() => null);
      if (answer?.ok) this.lost.value = false;
    }
  }
}

async function problemOf(response: Response): Promise<Problem> {
  try {
    return await response.json();
  } catch {
    return { title: response.statusText, status: response.status, detail: `the server answers ${response.status}`, code: "", retryable: false };
  }
}

async function* eventsOf(body: ReadableStream<Uint8Array>): AsyncGenerator<Event> {
  const reader = body.pipeThrough(new TextDecoderStream() as any).getReader() as ReadableStreamDefaultReader<string>;
  let rest = "";
  try {
    for (;;) {
      const { value, done } = await reader.read();
      if (done) return;
      const parts = (rest + value).split(/\r?\n\r?\n/);
      rest = parts.pop()!;
      for (const part of parts) {
        const fields: Record<string, string> = {};
        for (const line of part.split(/\r?\n/)) {
          const at = line.indexOf(":");
          if (at > 0) fields[line.slice(0, at)] = (fields[line.slice(0, at)] ?? "") + line.slice(at + 1).trimStart();
        }
        if (fields.data) yield { id: fields.id ?? "", event: fields.event ?? "message", data: JSON.parse(fields.data) };
      }
    }
  } finally {
    void reader.cancel().catch(() => undefined);
  }
}
