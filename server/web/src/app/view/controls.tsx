/** Parts of the panels: a section that folds, a slider with its number, a choice. */

import type { ComponentChildren } from "preact";
import { useEffect, useId, useState } from "preact/hooks";
import { number } from "../parts";

export function Section({ title, open = false, children }: { title: string; open?: boolean; children: ComponentChildren }) {
  const [shown, setShown] = useState(open), id = useId();
  return (
    <section aria-label={title}>
      <h2><button aria-expanded={shown} aria-controls={id} onClick={() => setShown(!shown)}>{title}</button></h2>
      <div class="inside" id={id} hidden={!shown}>{shown && children}</div>
    </section>
  );
}

interface SlideProps { label: string; name?: string; value: number; low: number; high: number; step?: number; unit?: string; onChange(value: number): void; onDone?(): void }

/** A slider and the same value as a number; both can be reached by keyboard. `name` is for who can't see its place. */
export function Slide({ label, name, value, low, high, step, unit, onChange, onDone }: SlideProps) {
  const [text, setText] = useState<string | null>(null);
  const said = `${name ?? label}${unit ? ` [${unit}]` : ""}`;
  const enter = (typed: string) => {
    setText(null);
    const parsed = Number(typed.replace(",", ".").replace("−", "-"));
    if (typed.trim() === "" || !Number.isFinite(parsed)) return;
    onChange(parsed);
    onDone?.();
  };
  return (
    <div class="slide">
      <span title={said}>{label}{unit && <span class="unit">{unit}</span>}</span>
      <input type="range" aria-label={said} min={low} max={high} step={step ?? ((high - low) / 500 || 1)} value={value} onInput={(e) => onChange(Number(e.currentTarget.value))} onChange={() => onDone?.()} />
      <input type="text" inputMode="decimal" aria-label={`${said}, as a number`} value={text ?? number(value, 4)} onInput={(e) => setText(e.currentTarget.value)} onBlur={(e) => { if (text !== null) enter(e.currentTarget.value); }} onKeyDown={(e) => { if (e.key === "Enter") enter(e.currentTarget.value); }} />
    </div>
  );
}

export function Select<T extends string>({ label, value, options, onChange }: { label: string; value: T; options: { value: T; label: string }[]; onChange(value: T): void }) {
  return (
    <label class="line"><span>{label}</span>
      <select value={value} onChange={(e) => onChange(e.currentTarget.value as T)}>{options.map((each) => <option value={each.value}>{each.label}</option>)}</select>
    </label>
  );
}

/** A number or nothing. */
export function Value({ label, value, placeholder, onChange }: { label: string; value: number | null; placeholder: string; onChange(value: number | null): void }) {
  const [text, setText] = useState(value === null ? "" : number(value));
  useEffect(() => setText(value === null ? "" : number(value)), [value]);
  return <input type="text" inputMode="decimal" aria-label={label} placeholder={placeholder} value={text}
    onInput={(e) => {
      const typed = e.currentTarget.value;
      setText(typed);
      if (typed.trim() === "") onChange(null);
      else if (Number.isFinite(Number(typed))) onChange(Number(typed));
    }} />;
}

export function Tick({ label, value, onChange }: { label: string; value: boolean; onChange(value: boolean): void }) {
  return <label class="tick"><input type="checkbox" checked={value} onChange={(e) => onChange(e.currentTarget.checked)} />{label}</label>;
}
