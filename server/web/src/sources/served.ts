/** A job's result, and robots that are edited, from `wsrender serve`. */

import { Refused, type Manifest, type Source } from "../contract";
import { parse } from "../json";
import { readReply } from "./answer";
import type { Api } from "./api";
import { Session } from "./session";

/** A session under the page's key, which is asked for anew where the server takes it no more. */
function sessionOf(api: Api, path: string, first?: string): Session {
  const session = new Session(new URL(path, api.base), () => api.key.value, first);
  session.onState((state) => { if (state instanceof Refused && state.code === "unauthorized") api.askForKey(); });
  return session;
}

export function jobSource(api: Api, id: string): Source {
  const path = `v1/jobs/${id}/view`;
  let session: Session | null = null;
  const opened = () => session ??= sessionOf(api, `${path}/session`);
  return {
    home: "served",
    manifest: async () => parse(await (await api.fetch(path)).text()),
    blob: async (name) => (await api.fetch(`${path}/blobs/${encodeURIComponent(name)}`)).arrayBuffer(),
    ask: (request) => opened().ask(request),
    onState: (listener) => opened().onState(listener),
    close: () => session?.close(),
  };
}

/** What is edited in a form: `parts` as `POST /v1/robots:view` takes them, of which the view is one message. */
export function editedSource(api: Api, parts: Record<string, unknown>): Source {
  const text = JSON.stringify(parts);
  let session: Session | null = null, blobs: Record<string, ArrayBuffer> = {};
  const opened = () => session ??= sessionOf(api, "v1/robots:view/session", text);
  return {
    home: "served",
    manifest: async () => {
      const response = await api.fetch("v1/robots:view", { method: "POST", body: text, headers: { "Content-Type": "application/json" } });
      const read = readReply(await response.arrayBuffer());
      blobs = read.blobs;
      return { ...(read.reply as unknown as { manifest: Manifest }).manifest, job: parts };
    },
    blob: async (name) => blobs[name]!,
    ask: (request) => opened().ask(request),
    onState: (listener) => opened().onState(listener),
    close: () => session?.close(),
  };
}
