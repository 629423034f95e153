/** The module's doors: the served page, a report's file, a tab of `wsrender view`, a notebook's widget. */

import { mountApp, mountViewer } from "./app/mount";
import { Api } from "./sources/api";
import { fileSource } from "./sources/file";
import { localSource } from "./sources/local";
import { widgetSource, type WidgetModel } from "./sources/widget";

type Unmount = () => void;

/** The page of `wsrender serve`, relative to the document's address. */
export function mountServed(root: HTMLElement): Unmount { return mountApp(root, new Api(new URL(".", document.baseURI))); }

/** A view that a file holds, of the bytes of `View.to_file_bytes`. */
export function mountFile(root: HTMLElement, view: ArrayBuffer): Unmount { return mountViewer(root, fileSource(view)); }

/** A tab on a loopback port. */
export function mountLocal(root: HTMLElement): Unmount { return mountViewer(root, localSource()); }

/** A notebook's widget (anywidget), in an element of its own: Jupyter's loses its style where ipywidgets' layout is late. */
function render({ model, el }: { model: WidgetModel; el: HTMLElement }): Unmount {
  const root = el.appendChild(document.createElement("div")), unmount = mountViewer(root, widgetSource(model));
  return () => {
    unmount();
    root.remove();
  };
}

export default { render };

export * from "./scene"; // for tests, and pages that draw a view of their own
export { defaultSettings } from "./settings";
