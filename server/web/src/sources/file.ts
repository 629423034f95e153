/** A view inside a file: one message, whose header holds the manifest (`View.to_file_bytes`). */

import { Refused, type Manifest, type Source } from "../contract";
import { readReply } from "./answer";

export function fileSource(bytes: ArrayBuffer): Source {
  const { reply, blobs } = readReply(bytes);
  return {
    home: "file",
    manifest: async () => (reply as unknown as { manifest: Manifest }).manifest,
    blob: async (name) => {
      const blob = blobs[name];
      if (!blob) throw new Refused(`This file does not hold ${name}.`);
      return blob;
    },
  };
}
