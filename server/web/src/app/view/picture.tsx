/** A picture of the view as a file. */

import { useEffect, useRef, useState } from "preact/hooks";
import { download, message } from "../parts";
import type { ViewModel } from "./model";

const LARGEST = 8192;

export function PictureDialog({ model, onDone }: { model: ViewModel; onDone(): void }) {
  const dialog = useRef<HTMLDialogElement>(null);
  const [width, setWidth] = useState(1920), [height, setHeight] = useState(1080), [title, setTitle] = useState(model.manifest.value!.title), [state, setState] = useState("");
  useEffect(() => { dialog.current!.showModal(); }, []);
  const good = [width, height].every((each) => Number.isInteger(each) && each >= 16 && each <= LARGEST);
  const save = async (event: Event) => {
    event.preventDefault();
    setState("Drawing …");
    try {
      download(await model.stage!.image({ width, height, title }), `${title.replace(/[^\w.-]+/g, "_") || "view"}.png`);
      dialog.current!.close();
    } catch (error) {
      setState(message(error));
    }
  };
  const side = (label: string, value: number, set: (value: number) => void) => <label class="line"><span>{label}</span><input type="number" min={16} max={LARGEST} value={value} aria-invalid={!(value >= 16 && value <= LARGEST)} onInput={(e) => set(Math.round(Number(e.currentTarget.value)))} /></label>;
  return (
    <dialog ref={dialog} onClose={onDone} aria-labelledby="picture-title">
      <form onSubmit={save}>
        <h2 id="picture-title">Picture (PNG)</h2>
        {side("Width", width, setWidth)}
        {side("Height", height, setHeight)}
        <label class="line"><span>Title</span><input type="text" value={title} onInput={(e) => setTitle(e.currentTarget.value)} /></label>
        <p class="help">Up to {LARGEST} pixels a side; with colour bar and axes as they are shown.</p>
        <p role="status" aria-live="polite">{state}</p>
        <div class="bar"><button class="primary" type="submit" disabled={!good}>Save</button><button type="button" onClick={() => dialog.current!.close()}>Close</button></div>
      </form>
    </dialog>
  );
}
