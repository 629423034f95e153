/** Where a tab of the served page is, as its address's fragment says: a page, and what the view looks like. */

import type { JsonObject } from "./form/schema";

export type Place =
  | { page: "jobs" }
  | { page: "new"; start: JsonObject | null }
  | { page: "job"; id: string; view?: string }
  | { page: "compare"; first: string; second: string; view?: string; other?: string }; // other: the second one's view
export type Go = (place: Place) => void;

const ID = "([0-9a-f]{32})";

export function placeOf(hash: string): Place {
  const [path = "", query = ""] = hash.replace(/^#/, "").split("?");
  const [view, other] = ["view", "other"].map((name) => new URLSearchParams(query).get(name));
  const job = path.match(new RegExp(`^/job/${ID}$`)), both = path.match(new RegExp(`^/compare/${ID}/${ID}$`));
  if (job) return { page: "job", id: job[1]!, ...(view ? { view } : {}) };
  if (both) return { page: "compare", first: both[1]!, second: both[2]!, ...(view ? { view } : {}), ...(other ? { other } : {}) };
  return path === "/new" ? { page: "new", start: null } : { page: "jobs" };
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

/** What was packed; null for text that is nothing of it. */
export async function unpacked<T>(text: string): Promise<T | null> {
  try {
    const bytes = Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (each) => each.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return JSON.parse(await new Response(stream).text()) as T;
  } catch {
    return null;
  }
}
