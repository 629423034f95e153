/** An answer on the wire: uint32 little-endian length of a JSON header, the header padded to 4 bytes, then its blobs. */

import { Refused, type Answer } from "../contract";

export interface Reply { id: number | string | null; answer?: unknown; refused?: { message: string; field?: string; code?: string }; blobs?: { name: string; bytes: number }[] }

export function readReply(message: ArrayBuffer): { reply: Reply; blobs: Record<string, ArrayBuffer> } {
  const length = new DataView(message).getUint32(0, true);
  const reply: Reply = JSON.parse(new TextDecoder().decode(new Uint8Array(message, 4, length)));
  const blobs: Record<string, ArrayBuffer> = {};
  let at = 4 + length;
  for (const { name, bytes } of reply.blobs ?? []) {
    blobs[name] = message.slice(at, at + bytes);
    at += bytes;
  }
  return { reply, blobs };
}

export function answerOf(reply: Reply, blobs: Record<string, ArrayBuffer>): Answer {
  if (reply.refused?.code === "replaced") throw replaced();
  if (reply.refused) throw new Refused(reply.refused.message, reply.refused.field ?? "", reply.refused.code ?? "");
  return { header: reply.answer, blobs };
}

export const replaced = () => new DOMException("A later request has replaced this one.", "AbortError");
