/** A notebook's widget: everything by custom messages, since synced traits would land in the notebook's file. */

import { type Answer, type Manifest, type Request, type Source } from "../contract";
import { answerOf, replaced, type Reply } from "./answer";

/** What this module uses of anywidget's model. */
export interface WidgetModel {
  send(content: unknown): void;
  on(event: "msg:custom", listener: (content: any, buffers: DataView[]) => void): void;
  off(event: "msg:custom", listener: (content: any, buffers: DataView[]) => void): void;
}

type Question = Request | { ask: "manifest" } | { ask: "blob"; name: string };

/** A question `{id, ask, …}` is answered by `{id, answer | refused, blobs: [{name, bytes}]}`, the blobs as its buffers. */
export function widgetSource(model: WidgetModel): Source {
  const own = crypto.randomUUID(); // several views of one model hear each other's answers
  const waiting = new Map<string, { ask: string; resolve(answer: Answer): void; reject(error: Error): void }>();
  let next = 1;
  const hear = (reply: Reply, buffers: DataView[]) => {
    const asked = waiting.get(String(reply.id));
    if (!asked) return;
    waiting.delete(String(reply.id));
    const blobs = Object.fromEntries((reply.blobs ?? []).map(({ name }, i) => [name, bytesOf(buffers[i]!)]));
    try {
      asked.resolve(answerOf(reply, blobs));
    } catch (error) {
      asked.reject(error as Error);
    }
  };
  model.on("msg:custom", hear);
  const question = (content: Question) => new Promise<Answer>((resolve, reject) => {
    const id = `${own}:${next++}`;
    waiting.set(id, { ask: content.ask, resolve, reject });
    model.send({ id, ...content });
  });
  return {
    home: "widget",
    manifest: async () => (await question({ ask: "manifest" })).header as Manifest,
    blob: async (name) => Object.values((await question({ ask: "blob", name })).blobs)[0]!,
    ask: (request) => {
      for (const [id, other] of waiting) if (other.ask === request.ask && waiting.delete(id)) other.reject(replaced());
      return question(request);
    },
    close: () => model.off("msg:custom", hear),
  };
}

const bytesOf = (view: DataView) => view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength) as ArrayBuffer;
