/** A view by itself: in a file, a tab of its own, a notebook. */

import type { Signal } from "@preact/signals";
import type { Source } from "../../contract";
import { ThemeChoice, type Theme } from "../app";
import { Viewer } from "./viewer";

export function Alone({ source, theme }: { source: Source; theme: Signal<Theme> }) {
  const linked = source.home === "file" || source.home === "local"; // a notebook's address is not the view's
  const view = linked ? (new URLSearchParams(location.hash.slice(1)).get("view") ?? undefined) : undefined;
  const linkOf = (packed: string) => {
    const link = new URL(location.href);
    link.hash = `view=${packed}`;
    return link.href;
  };
  return <Viewer source={source} theme={theme} view={view} actions={<ThemeChoice theme={theme} />} {...(linked ? { linkOf } : {})} {...(source.home === "local" ? { onView: (packed: string) => history.replaceState(null, "", linkOf(packed)) } : {})} />;
}
