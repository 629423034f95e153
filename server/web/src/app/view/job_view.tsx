/** The result of a job. */

import type { Signal } from "@preact/signals";
import { useMemo } from "preact/hooks";
import type { Api } from "../../sources/api";
import { jobSource } from "../../sources/served";
import type { Theme } from "../app";
import { hashOf, type Go } from "../route";
import { Viewer } from "./viewer";

/** What an img shows of a picture, whose address is relative to that of the job's view: links carry no key. */
export async function pictureOf(api: Api, id: string, url: string): Promise<string> {
  return URL.createObjectURL(await (await api.fetch(`v1/jobs/${id}/${url}`)).blob());
}

export function JobView({ api, id, view, theme, go }: { api: Api; id: string; view: string | undefined; theme: Signal<Theme>; go: Go }) {
  const source = useMemo(() => jobSource(api, id), [api, id]);
  const linkOf = (packed: string) => new URL(hashOf({ page: "job", id, view: packed }), location.href).href;
  return <Viewer source={source} theme={theme} view={view} linkOf={linkOf} onView={(packed) => history.replaceState(null, "", linkOf(packed))} onJob={(start) => go({ page: "new", start })} picture={(url) => pictureOf(api, id, url)} />;
}
