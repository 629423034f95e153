/** A tab of `wsrender view` or `result.view()`: from the page's own origin, whose link has let this browser in. */

import { Refused, type Manifest, type Request, type Source } from "../contract";
import { answerOf, readReply, replaced } from "./answer";

export function localSource(): Source {
  const listeners = new Set<Parameters<NonNullable<Source["onState"]>>[0]>();
  const running = new Map<Request["ask"], AbortController>();
  let lost = false;
  const say = (state: boolean) => {
    if (state === lost) return;
    lost = state;
    for (const listener of listeners) listener(lost ? "lost" : "back");
  };
  const get = async (path: string, init: RequestInit = {}) => {
    const response = await fetch(new URL(path, document.baseURI), init).catch((error) => {
      if (!init.signal?.aborted) say(true);
      throw error;
    });
    say(false);
    if (!response.ok) throw new Refused(response.status === 403 ? "Open the link that wsrender has printed; it opens the view once." : `The program behind this page answers ${response.status}.`);
    return response;
  };
  return {
    home: "local",
    manifest: async () => (await get("manifest")).json() as Promise<Manifest>,
    blob: async (name) => (await get(`blobs/${encodeURIComponent(name)}`)).arrayBuffer(),
    ask: async (request) => {
      running.get(request.ask)?.abort(replaced());
      const controller = new AbortController();
      running.set(request.ask, controller);
      const response = await get("ask", { method: "POST", body: JSON.stringify(request), signal: controller.signal, headers: { "Content-Type": "application/json" } });
      const { reply, blobs } = readReply(await response.arrayBuffer());
      return answerOf(reply, blobs);
    },
    onState: (listener) => {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
  };
}
