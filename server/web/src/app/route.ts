/** Where a tab of the served page is, as its address's fragment says: a page, and what the view looks like. */

import type { JsonObject } from "./form/schema";

export type Place =
  | { page: "jobs" }
  | { page: "none" } // what the address says is no page
  | { page: "new"; start: JsonObject | null }
  | { page: "job"; id: string; view?: string }
  | { page: "compare"; first: string; second: string; view?: string; other?: string }; // other: the second one's view
export type Go = (place: Place) => void;

const ID = "([0-9a-f]{32})";
const MOST_UNPACKED = 2 ** 20; // characters of a view's settings

export function placeOf(hash: string): Place {
  const [path = "", query = ""] = hash.replace(/^#/, "").split("?");
  const [view, other] = ["view", "other"].map((name) => new URLSearchParams(query).get(name));
  const job = path.match(new RegExp(`^/job/${ID}$`)), both = path.match(new RegExp(`^/compare/${ID}/${ID}$`));
  if (job) return { page: "job", id: job[1]!, ...(view ? { view } : {}) };
  if (both) return { page: "compare", first: both[1]!, second: both[2]!, ...(view ? { view } : {}), ...(other ? { other } : {}) };
  if (path === "/new") return { page: "new", start: null };
  return { page: ["", "/", "/jobs"].includes(path) ? "jobs" : "none" };
}

export function hashOf(place: Place): string {
  const query = "view" in place && place.view ? `?view=${place.view}` : "";
  if (place.page === "job") return `#/job/${place.id}${query}`;
  if (place.page === "compare") return `#/compare/${place.first}/${place.second}${query}${place.other ? `&other=${place.other}` : ""}`;
  return place.page === "new" ? "#/new" : "#/jobs";
}

/** A plain value as text for an address, deflated. */
export async function packed(value: unknown): Promise<string> {
  const stream = new Blob([JSON.stringify(value)]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  return btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** What was packed; null for text that is nothing of it, or unfolds to more than a page would pack. */
export async function unpacked(text: string): Promise<unknown> {
  try {
    const bytes = Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (each) => each.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    let json = "";
    const decoder = new TextDecoder(), reader = stream.getReader();
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
      json += decoder.decode(part.value, { stream: true });
      if (json.length > MOST_UNPACKED) {
        await reader.cancel();
        return null;
      }
    }
    return JSON.parse(json);
  } catch {
    return null;
  }
}
