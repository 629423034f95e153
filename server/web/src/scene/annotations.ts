/** What is written over the picture: ticks and titles of the axes, the scale bar, colour bars, measures. On a page and in an image alike. */

import * as THREE from "three";
import { roundStep, text, type ColorScale } from "./colors";

export interface Ink { text: string; faint: string; paper: string; panel: string; accent: string }

export const INKS: Record<"light" | "dark", Ink> = {
  light: { text: "#1d2733", faint: "#c3ccd6", paper: "#ffffff", panel: "rgba(255,255,255,.86)", accent: "#c2185b" },
  dark: { text: "#e6ebf1", faint: "#3b4653", paper: "#12171d", panel: "rgba(18,23,29,.84)", accent: "#ff6f9f" },
};

interface Label { at: THREE.Vector3[]; text: string; bold: boolean; outward: THREE.Vector3 } // at: where it may stand, the best first
type Box = [left: number, top: number, right: number, bottom: number]; // CSS pixels

const ALONG = [0.5, 0.38, 0.62, 0.26, 0.74, 0.14, 0.86]; // an axis, where its title may stand

/** The three far walls of a box with a grid; made again when the eye passes to another octant. */
export class AxesBox extends THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial> {
  labels: Label[] = [];
  step = 1;
  private key = "";
  readonly low = new THREE.Vector3();
  readonly high = new THREE.Vector3();
  constructor() { super(new THREE.BufferGeometry(), new THREE.LineBasicMaterial()); }

  fit(box: THREE.Box3): void {
    const size = box.getSize(new THREE.Vector3()), span = Math.max(size.x, size.y, size.z, 1e-3);
    this.step = roundStep(span / 6);
    this.low.copy(box.min); this.high.copy(box.max);
    for (let k = 0; k < 3; k++) { // to whole half steps, never flat
      const h = this.step / 2;
      this.low.setComponent(k, Math.floor(box.min.getComponent(k) / h - 1e-6) * h);
      this.high.setComponent(k, Math.ceil(box.max.getComponent(k) / h + 1e-6) * h);
    }
    this.key = "";
  }

  update(eye: THREE.Vector3, ink: Ink): void {
    const { low, high } = this, middle = low.clone().add(high).multiplyScalar(0.5);
    const far = [0, 1, 2].map((a) => (eye.getComponent(a) > middle.getComponent(a) ? low : high).getComponent(a)) as [number, number, number];
    const key = far.join() + ink.faint;
    if (key === this.key) return;
    this.key = key;
    const near = far.map((f, a) => low.getComponent(a) + high.getComponent(a) - f) as [number, number, number];
    const ticks = [0, 1, 2].map((a) => {
      const found: number[] = [];
      for (let k = Math.ceil(low.getComponent(a) / this.step - 1e-6); k * this.step <= high.getComponent(a) + 1e-6 * this.step; k++) found.push(k * this.step);
      return found;
    });
    const points: number[] = [];
    for (let wall = 0; wall < 3; wall++) for (const [along, other] of [[(wall + 1) % 3, (wall + 2) % 3], [(wall + 2) % 3, (wall + 1) % 3]] as [number, number][]) {
      for (const v of new Set([low.getComponent(along), ...ticks[along]!, high.getComponent(along)])) for (const end of [low, high]) {
        const p = [0, 0, 0];
        p[wall] = far[wall]!; p[along] = v; p[other] = end.getComponent(other);
        points.push(...p);
      }
    }
    this.geometry.dispose();
    this.geometry = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
    this.material.color.set(ink.faint);
    this.labels = [];
    for (let a = 0; a < 3; a++) { // x and y along the near edges of the floor, z upright at the side
      const b = a === 2 ? 0 : 1 - a, outward = new THREE.Vector3().setComponent(b, Math.sign(near[b]! - far[b]!));
      const place = (v: number): THREE.Vector3 => {
        const p = a === 2 ? [near[0], far[1], 0] : [near[0], near[1], far[2]];
        p[a] = v;
        return new THREE.Vector3(...(p as [number, number, number]));
      };
      for (const v of ticks[a]!) this.labels.push({ at: [place(v)], text: text(v, this.step), bold: false, outward });
      this.labels.push({ at: ALONG.map((share) => place(low.getComponent(a) + share * (high.getComponent(a) - low.getComponent(a)))), text: `${"xyz"[a]} [m]`, bold: true, outward });
    }
  }

  dispose(): void { this.geometry.dispose(); this.material.dispose(); }
}

export interface Written {
  width: number; height: number; // CSS pixels
  ink: Ink;
  project: (p: THREE.Vector3) => { x: number; y: number; front: boolean };
  axes: AxesBox | null;
  bars: ColorScale[];
  metre: number | null; // CSS pixels of a metre at the target, for the scale bar
  measure: THREE.Vector3[];
  title?: string;
}

const FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif";

export function write(g: CanvasRenderingContext2D, w: Written): void {
  const { ink } = w;
  g.lineJoin = "round";
  const halo = (shown: string, x: number, y: number) => {
    g.strokeStyle = ink.paper; g.lineWidth = 3; g.globalAlpha = 0.85; g.strokeText(shown, x, y);
    g.globalAlpha = 1; g.fillStyle = ink.text; g.fillText(shown, x, y);
  };
  const taken: Box[] = []; // where no label of the axes may stand
  if (w.metre) taken.push(writeScale(g, w, w.metre));
  let right = w.width - 22;
  for (const bar of w.bars) {
    const box = writeBar(g, w, bar, right, halo);
    taken.push(box);
    right = box[0] - 10;
  }
  g.textAlign = "left"; g.textBaseline = "top";
  if (w.title) {
    g.font = `600 17px ${FONT}`;
    const title = shortened(g, w.title, Math.max(120, right - 18));
    halo(title, 18, 16);
    taken.push([18, 16, 18 + g.measureText(title).width, 36]);
  }
  if (w.axes) writeAxes(g, w, w.axes, taken, halo);
  if (w.measure.length) writeMeasure(g, w);
}

/** A text that is no wider than so many pixels, in the font that is set. */
function shortened(g: CanvasRenderingContext2D, whole: string, width: number): string {
  let shown = whole;
  while (shown.length > 4 && g.measureText(shown).width > width) shown = `${shown.slice(0, -2)}…`;
  return shown;
}

function writeAxes(g: CanvasRenderingContext2D, w: Written, axes: AxesBox, taken: Box[], halo: (t: string, x: number, y: number) => void): void {
  g.textAlign = "center"; g.textBaseline = "middle";
  for (const label of [...axes.labels].sort((a, b) => +b.bold - +a.bold)) {
    g.font = label.bold ? `600 13px ${FONT}` : `12px ${FONT}`;
    const half = g.measureText(label.text).width / 2 + 2;
    for (const at of label.at) {
      const p = w.project(at), o = w.project(at.clone().addScaledVector(label.outward, axes.step));
      if (!p.front) continue;
      const d = Math.hypot(o.x - p.x, o.y - p.y) || 1, out = label.bold ? 44 : 17;
      const beside = [p.x + ((o.x - p.x) / d) * out, p.y + ((o.y - p.y) / d) * out] as const, inside = p.x >= 0 && p.x <= w.width && p.y >= 0 && p.y <= w.height; // then its label too
      const [x, y] = inside ? [clamped(beside[0], half, w.width), clamped(beside[1], 9, w.height)] : beside;
      const box: Box = [x - half, y - 8, x + half, y + 8];
      if (taken.some((t) => box[0] < t[2] && t[0] < box[2] && box[1] < t[3] && t[1] < box[3])) continue;
      taken.push(box);
      halo(label.text, x, y);
      break;
    }
  }
}

const clamped = (value: number, half: number, whole: number): number => Math.max(half, Math.min(whole - half, value));

function writeScale(g: CanvasRenderingContext2D, w: Written, metre: number): Box {
  const most = Math.min(150, w.width / 5), exact = most / metre, power = 10 ** Math.floor(Math.log10(exact));
  const length = [5, 2, 1].map((k) => k * power).find((l) => l <= exact) ?? power, px = length * metre, x = 20, y = w.height - 22;
  const name = length >= 1 ? `${text(length)} m` : length >= 0.01 ? `${text(+(length * 100).toPrecision(3))} cm` : `${text(+(length * 1000).toPrecision(3))} mm`;
  g.font = `12px ${FONT}`;
  const wide = Math.max(px, g.measureText(name).width) + 16;
  g.fillStyle = w.ink.panel;
  g.beginPath(); g.roundRect(x - 8, y - 24, wide, 36, 5); g.fill();
  g.strokeStyle = g.fillStyle = w.ink.text; g.lineWidth = 2;
  g.beginPath(); g.moveTo(x, y - 4); g.lineTo(x, y + 3); g.lineTo(x + px, y + 3); g.lineTo(x + px, y - 4); g.stroke();
  g.textAlign = "left"; g.textBaseline = "bottom";
  g.fillText(name, x, y - 6);
  return [x - 8, y - 24, x - 8 + wide, y + 12];
}

function writeMeasure(g: CanvasRenderingContext2D, w: Written): void {
  const at = w.measure.map(w.project);
  g.strokeStyle = w.ink.paper; g.lineWidth = 5;
  for (const color of [w.ink.paper, w.ink.accent]) {
    g.strokeStyle = g.fillStyle = color; g.lineWidth = color === w.ink.accent ? 2.2 : 5;
    if (at.length > 1) { g.beginPath(); g.moveTo(at[0]!.x, at[0]!.y); g.lineTo(at[1]!.x, at[1]!.y); g.stroke(); }
    for (const p of at) { g.beginPath(); g.arc(p.x, p.y, color === w.ink.accent ? 4 : 6, 0, 7); g.fill(); }
  }
  if (at.length < 2) return;
  const [a, b] = w.measure as [THREE.Vector3, THREE.Vector3], d = b.clone().sub(a);
  const shown = `${text(+d.length().toPrecision(4))} m  (Δx ${text(d.x, 0.001)}, Δy ${text(d.y, 0.001)}, Δz ${text(d.z, 0.001)})`;
  g.font = `600 13px ${FONT}`; g.textAlign = "center"; g.textBaseline = "middle";
  const width = g.measureText(shown).width + 16;
  const x = Math.min(w.width - width / 2 - 6, Math.max(width / 2 + 6, (at[0]!.x + at[1]!.x) / 2)), y = Math.max(20, (at[0]!.y + at[1]!.y) / 2 - 22);
  g.fillStyle = w.ink.panel; g.beginPath(); g.roundRect(x - width / 2, y - 13, width, 26, 5); g.fill();
  g.fillStyle = w.ink.text; g.fillText(shown, x, y);
}

/** A bar whose right end stands at x, pointed where values lie beyond, or a list of names. Returns the box of its panel. */
function writeBar(g: CanvasRenderingContext2D, w: Written, scale: ColorScale, right: number, halo: (t: string, x: number, y: number) => void): Box {
  const wide = Math.round(Math.min(260, Math.max(100, 0.28 * w.width)));
  g.font = `600 13px ${FONT}`;
  const title = shortened(g, scale.title, Math.max(wide, w.width * (w.bars.length > 1 ? 0.42 : 0.8)));
  const titled = g.measureText(title).width, panel = (width: number, height: number): Box => {
    const box: Box = [right - width - 14, 6, right + 14, 6 + height];
    g.fillStyle = w.ink.panel;
    g.beginPath(); g.roundRect(box[0], box[1], width + 28, height, 6); g.fill();
    g.font = `600 13px ${FONT}`; g.textAlign = "right"; g.textBaseline = "top";
    halo(title, right, 12);
    g.font = `12px ${FONT}`; g.textBaseline = "middle"; g.fillStyle = g.strokeStyle = w.ink.text; g.lineWidth = 1;
    return box;
  };
  if (scale.categories) {
    const shown = scale.categories.slice(0, Math.max(1, Math.floor((w.height - 60) / 18)));
    g.font = `12px ${FONT}`;
    const width = Math.max(titled, ...shown.map((c) => g.measureText(c.name).width + 20));
    const box = panel(width, 34 + 18 * shown.length);
    shown.forEach((c, i) => {
      g.fillStyle = w.ink.text; g.fillText(c.name, right - 20, 42 + 18 * i);
      g.fillStyle = c.color; g.fillRect(right - 12, 36 + 18 * i, 12, 12);
    });
    return box;
  }
  const x = Math.round(right - wide), y = 34, high = 12, ticks = scale.ticks(Math.max(3, Math.round(wide / 45))), step = !scale.log && ticks.length > 1 ? ticks[1]! - ticks[0]! : 0;
  const box = panel(Math.max(titled, wide), 62);
  const color = (i: number) => `rgb(${scale.colors.subarray(4 * i, 4 * i + 3).join()})`;
  for (let k = 0; k < wide; k++) { g.fillStyle = color(Math.floor((255.99 * (k + 0.5)) / wide)); g.fillRect(x + k, y, 1, high); }
  const tip = (at: number, to: number, i: number) => { g.fillStyle = color(i); g.beginPath(); g.moveTo(at, y); g.lineTo(at, y + high); g.lineTo(to, y + high / 2); g.fill(); };
  if (scale.above) tip(right - 0.5, right + 10, 255);
  if (scale.below) tip(x + 0.5, x - 10, 0);
  g.textAlign = "center"; g.textBaseline = "top"; g.fillStyle = g.strokeStyle = w.ink.text;
  let free = -Infinity;
  for (const v of ticks) {
    const at = scale.low === scale.high ? x + wide / 2 : x + scale.at(v) * wide, shown = text(v, step), half = g.measureText(shown).width / 2;
    g.beginPath(); g.moveTo(at, y + high); g.lineTo(at, y + high + 4); g.stroke();
    if (at - half < free) continue;
    g.fillText(shown, at, y + high + 6);
    free = at + half + 6;
  }
  return box;
}
