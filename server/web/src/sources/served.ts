/** A job's result, and robots that are edited, from `wsrender serve`. */

import type { Source } from "../contract";
import { parse } from "../json";
import type { Api } from "./api";
import { Session } from "./session";

export function jobSource(api: Api, id: string): Source {
  const path = `v1/jobs/${id}/view`;
  let session: Session | null = null;
  const opened = () => session ??= new Session(new URL(`${path}/session`, api.base), () => api.key.value);
  return {
    home: "served",
    manifest: async () => parse(await (await api.fetch(path)).text()),
    blob: async (name) => (await api.fetch(`${path}/blobs/${encodeURIComponent(name)}`)).arrayBuffer(),
    ask: (request) => opened().ask(request),
    onState: (listener) => opened().onState(listener),
    close: () => session?.close(),
  };
}
