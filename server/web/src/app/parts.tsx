/** Small parts that several pages use. */

import { useEffect, useState } from "preact/hooks";
import { ApiError } from "../sources/api";

export function useLoaded<T>(load: () => Promise<T>, on: unknown[]): { value: T | null; error: Error | null } {
  const [state, setState] = useState<{ value: T | null; error: Error | null }>({ value: null, error: null });
  useEffect(() => {
    let current = true;
    load().then((value) => current && setState({ value, error: null }), (error) => current && setState({ value: null, error }));
    return () => { current = false; };
  }, on);
  return state;
}

export function message(error: unknown): string {
  if (error instanceof ApiError) return error.problem.detail;
  return error instanceof TypeError ? "The server does not answer." : (error as Error).message;
}

export function Failure({ error }: { error: Error }) { return <p class="problem page" role="alert">{message(error)}</p>; }

export function seconds(value: number): string {
  if (value < 1) return "below 1 s";
  if (value < 90) return `${Math.round(value)} s`;
  if (value < 5400) return `${Math.round(value / 60)} min`;
  return value < 172800 ? `${(value / 3600).toFixed(1)} h` : `${Math.round(value / 86400)} days`;
}

export function size(bytes: number): string {
  const units = ["B", "kB", "MB", "GB", "TB"], step = Math.min(units.length - 1, Math.max(0, Math.floor(Math.log10(Math.max(bytes, 1)) / 3)));
  return `${(bytes / 1000 ** step).toPrecision(step ? 3 : 4).replace(/\.?0+$/, "")} ${units[step]}`;
}

/** A number for people; what is no number is said. */
export function number(value: number | null | undefined, digits = 5): string {
  if (value == null || !Number.isFinite(value)) return "–";
  return value === 0 ? "0" : Math.abs(value) >= 1e6 || Math.abs(value) < 1e-4 ? value.toExponential(digits - 2) : String(Number(value.toPrecision(digits)));
}

export function download(content: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
