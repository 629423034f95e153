/** Which colour stands for which value: the same tables as the pictures of `wsrender.results.drawing`. */

import type { Channel } from "../contract";
import type { Range } from "../settings";
import { tables } from "./color_tables";

export const DIVERGING = "coolwarm";
export const MAPS = Object.keys(tables).filter((name) => name !== DIVERGING);
export type Color = [number, number, number]; // bytes

const decoded = new Map<string, Uint8Array<ArrayBuffer>>();

/** 256 colours, RGBA bytes. */
export function table(name: string): Uint8Array<ArrayBuffer> {
  let found = decoded.get(name);
  if (!found) {
    const text = atob(tables[name as keyof typeof tables] ?? tables.viridis);
    found = new Uint8Array(1024).fill(255);
    for (let i = 0; i < 256; i++) for (let k = 0; k < 3; k++) found[4 * i + k] = text.charCodeAt(3 * i + k);
    decoded.set(name, found);
  }
  return found;
}

function hex(color: string): Color {
  const n = parseInt(color.replace("#", ""), 16);
  return [n >> 16, (n >> 8) & 255, n & 255];
}

export class ColorScale {
  readonly colors: Uint8Array<ArrayBuffer>; // 256 RGBA
  constructor(
    readonly label: string, readonly unit: string, readonly low: number, readonly high: number, readonly log: boolean, colors: string,
    readonly data: [number, number], readonly categories: { value: number; name: string; color: string }[] | null = null,
    readonly whole = false,
  ) {
    this.colors = table(colors);
    if (categories?.length) {
      this.colors = new Uint8Array(1024).fill(255);
      for (let i = 0; i < 256; i++) {
        const v = low + ((i + 0.5) / 256) * (high - low);
        const near = categories.reduce((a, b) => (Math.abs(b.value - v) < Math.abs(a.value - v) ? b : a));
        this.colors.set(hex(near.color), 4 * i);
      }
    }
  }
  /** What is shown of a value before it is scaled to the range: itself or its logarithm. */
  shown(v: number): number { return this.log ? (v > 0 ? Math.log10(v) : -Infinity) : v; }
  /** Place along the colours, 0 … 1; beyond the range the ends. */
  at(v: number): number {
    const a = this.shown(this.low), b = this.shown(this.high);
    return a === b ? 0.35 : Math.min(1, Math.max(0, (this.shown(v) - a) / (b - a)));
  }
  /** As matplotlib: the colour of number ⌊256 t⌋. */
  color(v: number): Color {
    const i = 4 * Math.min(255, Math.floor(256 * this.at(v)));
    return [this.colors[i]!, this.colors[i + 1]!, this.colors[i + 2]!];
  }
  value(t: number): number { return this.log ? 10 ** (Math.log10(this.low) + t * Math.log10(this.high / this.low)) : this.low + t * (this.high - this.low); }
  get below(): boolean { return this.data[0] < this.low - 1e-9 * (this.high - this.low); }
  get above(): boolean { return this.data[1] > this.high + 1e-9 * (this.high - this.low); }
  get title(): string { return titled(this); }
  /** Round values within the range, about `count`, two at least; of whole values whole ones, one at least. */
  ticks(count = 5): number[] {
    if (this.low === this.high) return [this.low];
    let kept: number[] = [];
    for (let n = count; kept.length < 2 && n <= 4 * count; n++) {
      const found = this.rounded(n);
      kept = this.whole ? found.filter((v) => Math.abs(v - Math.round(v)) < 1e-9) : found;
    }
    return kept.length ? kept : [this.low, this.high];
  }
  private rounded(count: number): number[] {
    if (!this.log) return round(this.low, this.high, count, this.whole);
    const decades = Math.log10(this.high / this.low), found: number[] = [];
    for (let e = Math.floor(Math.log10(this.low)); e <= Math.log10(this.high); e++) {
      for (const m of decades > 3 ? [1] : decades > 1.5 ? [1, 3] : [1, 2, 5]) {
        const v = m * 10 ** e;
        if (v >= this.low * (1 - 1e-9) && v <= this.high * (1 + 1e-9)) found.push(v);
      }
    }
    return found.length > 1 ? found : [this.low, this.high];
  }
}

/** A label with its unit. */
export const titled = ({ label, unit }: { label: string; unit: string }): string => (unit && unit !== "1" ? `${label} [${unit}]` : label);

function round(low: number, high: number, count: number, whole: boolean): number[] {
  const step = roundStep((high - low) / count, whole), found: number[] = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(k * step);
  return found;
}

/** A step that people count in, at least so large; a whole one where `whole`. */
export function roundStep(least: number, whole = false): number {
  const power = whole ? Math.max(1, 10 ** Math.floor(Math.log10(least) + 1e-9)) : 10 ** Math.floor(Math.log10(least) + 1e-9);
  return ([1, 2, ...(whole && power === 1 ? [] : [2.5]), 5, 10].find((k) => k * power >= least * (1 - 1e-9)) ?? 10) * power;
}

/** A number as people read it; a true minus. */
export function text(v: number, step = 0): string {
  const size = Math.abs(v);
  if (step > 0 && size < 1e5 && step >= 1e-4) {
    const digits = [0, 1, 2, 3, 4, 5].find((d) => Math.abs(step * 10 ** d - Math.round(step * 10 ** d)) < 1e-6) ?? 5;
    return v.toFixed(digits).replace("-", "−");
  }
  if (v === 0) return "0";
  const shown = size >= 1e5 || size < 1e-3 ? v.toExponential(2).replace(/\.?0+e/, "e").replace("e+", "e") : `${+v.toPrecision(4)}`;
  return shown.replaceAll("-", "−");
}

/** The scale of a channel: `data` and `inner` are its values' extent, with and without outliers. */
export function scaleOf(channel: Pick<Channel, "label" | "unit" | "signed" | "whole" | "categories">, data: [number, number] | null, inner: [number, number] | null, range: Range | null, colors: string): ColorScale {
  const whole = data ?? [0, 1];
  if (channel.categories?.length) {
    const of = channel.categories.map((c) => c.value), low = Math.min(...of) - 0.5, high = Math.max(...of) + 0.5;
    return new ColorScale(channel.label, channel.unit, low, high, false, colors, [low, high], channel.categories);
  }
  let [low, high] = (range?.clipped ?? true) && inner ? inner : whole;
  const given = range !== null && (range.low !== null || range.high !== null);
  const [least, most] = whole; // an outlier of the other sign is one of both signs, too, as in the pictures
  const diverging = (channel.signed || (least < -1e-9 * most && most > -1e-9 * least)) && range?.scale !== "log";
  if (diverging && !given) { high = Math.max(-low, high); low = -high; }
  if (range?.low != null) low = range.low;
  if (range?.high != null) high = range.high;
  const log = range?.scale === "log" && high > 0;
  if (log && low <= 0) low = high * 1e-4;
  if (high < low) high = low;
  return new ColorScale(channel.label, channel.unit, low, high, log, diverging ? DIVERGING : colors, whole, null, channel.whole);
}
