/** A root element becomes a page of its own: in a shadow root, so that styles of a report or notebook do not mix in. */

import { signal, effect, type Signal } from "@preact/signals";
import { render, type ComponentChild } from "preact";
import uplot from "uplot/dist/uPlot.min.css?inline";
import type { Source } from "../contract";
import type { Api } from "../sources/api";
import { App, type Theme } from "./app";
import style from "./style.css?inline";
import { Alone } from "./view/alone";

const THEME = "wsrender.theme";

export function mountApp(root: HTMLElement, api: Api): () => void {
  for (const element of [document.documentElement, document.body]) Object.assign(element.style, { margin: "0", height: "100%" });
  Object.assign(root.style, { height: "100%" });
  return mount(root, (theme) => <App api={api} theme={theme} />);
}

export function mountViewer(root: HTMLElement, source: Source): () => void {
  const alone = source.home === "local";
  if (alone) for (const element of [document.documentElement, document.body]) Object.assign(element.style, { margin: "0", height: "100%" });
  Object.assign(root.style, alone ? { height: "100vh" } : { display: "block", height: "min(720px, 90vh)", minHeight: "420px" });
  const unmount = mount(root, (theme) => <Alone source={source} theme={theme} />);
  return () => {
    unmount();
    source.close?.();
  };
}

function mount(root: HTMLElement, content: (theme: Signal<Theme>) => ComponentChild): () => void {
  const shadow = root.shadowRoot ?? root.attachShadow({ mode: "open" });
  shadow.adoptedStyleSheets = [uplot, style].map((text) => {
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(text);
    return sheet;
  });
  const page = document.createElement("div");
  page.className = "page-root";
  shadow.replaceChildren(page);
  const theme = signal((read(THEME) as Theme | null) ?? "system"), system = matchMedia("(prefers-color-scheme: dark)");
  const dark = signal(system.matches), follow = () => { dark.value = system.matches; };
  system.addEventListener("change", follow);
  const stop = effect(() => {
    page.dataset.theme = theme.value === "system" ? (dark.value ? "dark" : "light") : theme.value;
    write(THEME, theme.value);
  });
  render(content(theme), page);
  return () => {
    render(null, page);
    stop();
    system.removeEventListener("change", follow);
  };
}

function read(name: string): string | null { // from file:// or in a sandbox there may be no storage
  try {
    return localStorage.getItem(name);
  } catch {
    return null;
  }
}

function write(name: string, value: string): void {
  try {
    localStorage.setItem(name, value);
  } catch { /* not kept, then */ }
}
