/** Volumes on the graphics card, drawn by rays. */

import * as THREE from "three";
import type { Volume } from "../contract";
import type { VolumeSettings } from "../settings";
import type { ColorScale } from "./colors";
import type { Lattice } from "./data";
import * as glsl from "./shaders";
import { cloudOf, type Cloud } from "./splat";

const PAD = 2; // empty voxels around, so that blurred borders are closed
const NONE = -3e38; // no value, or no threshold

const word = new Float32Array(1), bits = new Uint32Array(word.buffer);
/** Float16 bits of a number in 0 … 1; below 6e-5 is 0. */
function half(v: number): number {
  if (v < 6.2e-5) return 0;
  word[0] = v;
  return (bits[0]! + 0x1000 - 0x38000000) >>> 13;
}

function texture3(data: ArrayBufferView<ArrayBuffer> & ArrayLike<number>, shape: number[], type: THREE.TextureDataType, format: THREE.PixelFormat, filter: THREE.MagnificationTextureFilter): THREE.Data3DTexture {
  const t = new THREE.Data3DTexture(data as never, shape[0], shape[1], shape[2]);
  t.type = type;
  t.format = format;
  t.minFilter = t.magFilter = filter;
  t.unpackAlignment = 1; // with three's 4, rows of an odd length are an INVALID_OPERATION and the volume is empty
  t.needsUpdate = true;
  return t;
}

/** Textures of one channel of one lattice. `exact`: float32, read voxel by voxel; else float16, interpolated. */
class Textures {
  readonly shape: number[];
  readonly soft: THREE.Data3DTexture;
  readonly coarse: THREE.Data3DTexture;
  raw: THREE.Data3DTexture;
  exact: boolean;
  /** What the texture holds of a value v: (v − zero) · unit, of its logarithm where `log`. */
  zero = 0; unit = 1; log = false;
  private groups: number[];

  constructor(lattice: Lattice, log: boolean, exact: boolean) {
    this.shape = lattice.shape.map((n) => n + 2 * PAD);
    this.groups = this.shape.map((n) => Math.ceil(n / 4));
    const n = this.shape.reduce((a, b) => a * b), m = this.groups.reduce((a, b) => a * b);
    this.exact = exact;
    this.raw = this.emptyRaw();
    this.soft = texture3(new Uint16Array(2 * n), this.shape, THREE.HalfFloatType, THREE.RGFormat, THREE.LinearFilter);
    this.coarse = texture3(new Uint8Array(2 * m), this.groups, THREE.UnsignedByteType, THREE.RGFormat, THREE.NearestFilter);
    this.set(lattice, log);
  }

  private emptyRaw(): THREE.Data3DTexture {
    const n = this.shape.reduce((a, b) => a * b);
    return this.exact ? texture3(new Float32Array(n), this.shape, THREE.FloatType, THREE.RedFormat, THREE.NearestFilter)
      : texture3(new Uint16Array(2 * n), this.shape, THREE.HalfFloatType, THREE.RGFormat, THREE.LinearFilter);
  }

  fits(lattice: Lattice): boolean { return lattice.shape.every((n, a) => n + 2 * PAD === this.shape[a]); }

  set(lattice: Lattice, log: boolean): void {
    const [nx, ny, nz] = lattice.shape, [px, py] = this.shape as [number, number, number], { occupied, values } = lattice;
    const shown = log ? (v: number) => (v > 0 ? Math.log10(v) : -Infinity) : (v: number) => v;
    let low = Infinity, high = -Infinity;
    if (values) for (let i = 0; i < values.length; i++) {
      const v = shown(values[i]!);
      if (occupied[i] && v > -Infinity && v < Infinity) { if (v < low) low = v; if (v > high) high = v; }
    }
    this.log = log;
    this.zero = low <= high ? low : 0;
    this.unit = high > low ? 1 / (high - low) : 1;
    const n = px * py * this.shape[2]!, raw = this.raw.image.data as unknown as Uint16Array | Float32Array;
    const words = new Uint32Array(n), most = new Uint8Array(this.groups.reduce((a, b) => a * b)), filled = new Uint8Array(most.length), [gx, gy] = this.groups as [number, number];
    if (this.exact) raw.fill(2 * NONE); else raw.fill(0);
    for (let z = 0, i = 0; z < nz; z++) for (let y = 0; y < ny; y++) {
      let j = PAD + px * (y + PAD + py * (z + PAD));
      const line = gx * (((y + PAD) >> 2) + gy * ((z + PAD) >> 2));
      for (let x = 0; x < nx; x++, i++, j++) {
        if (!occupied[i]) continue;
        let v = 1;
        if (values) {
          v = shown(values[i]!);
          if (Number.isNaN(v)) continue; // occupied, but without this value
          v = Math.min(1, Math.max(0, (v - this.zero) * this.unit)); // infinite ones are at the ends
        }
        if (this.exact) raw[j] = values ? Math.min(3e37, Math.max(-3e37, shown(values[i]!))) : 0;
        else { raw[2 * j] = half(v); raw[2 * j + 1] = 0x3c00; }
        words[j] = (Math.round(v * 4095) << 14) | 255; // 12 bits of value, 8 of occupancy, each with 6 to grow
        const g = line + ((x + PAD) >> 2), level = 1 + Math.ceil(v * 254);
        if (level > most[g]!) most[g] = level;
        filled[g]!++;
      }
    }
    this.blur(words);
    this.group(most, filled);
    for (const t of [this.raw, this.soft, this.coarse]) t.needsUpdate = true;
  }

  /** Twice (1 2 1)/4 along each axis, value and occupancy in one word. Empty borders make the ends of rows harmless. */
  private blur(words: Uint32Array<ArrayBuffer>): void {
    const n = words.length, [px, py] = this.shape as [number, number], soft = this.soft.image.data as unknown as Uint16Array;
    let a = words, b = new Uint32Array(n);
    for (const s of [1, px, px * py, 0, 1, px, px * py]) {
      if (!s) { for (let i = 0; i < n; i++) { const w = a[i]!; a[i] = ((w >>> 20) << 14) | ((w >>> 6) & 255); } continue; }
      for (let i = s; i < n - s; i++) b[i] = a[i - s]! + 2 * a[i]! + a[i + s]!;
      b.fill(0, 0, s); b.fill(0, n - s);
      [a, b] = [b, a];
    }
    for (let i = 0; i < n; i++) {
      const w = a[i]!;
      if (!w) { soft[2 * i] = soft[2 * i + 1] = 0; continue; }
      soft[2 * i] = half((w >>> 14) / (4095 * 64));
      soft[2 * i + 1] = half((w & 0x3fff) / (255 * 64));
    }
  }

  /** The largest value of 4³ voxels, and whether there is any (above 0) and all (1). A group counts with its 26 neighbours: filtering and blur carry values over its border. */
  private group(most: Uint8Array, filled: Uint8Array): void {
    const [gx, gy, gz] = this.groups as [number, number, number], coarse = this.coarse.image.data as unknown as Uint8Array;
    for (let z = 0, i = 0; z < gz; z++) for (let y = 0; y < gy; y++) for (let x = 0; x < gx; x++, i++) {
      let best = 0, full = x > 0 && y > 0 && z > 0 && x < gx - 1 && y < gy - 1 && z < gz - 1;
      for (let k = Math.max(z - 1, 0); k <= Math.min(z + 1, gz - 1); k++)
        for (let j = Math.max(y - 1, 0); j <= Math.min(y + 1, gy - 1); j++)
          for (let h = Math.max(x - 1, 0); h <= Math.min(x + 1, gx - 1); h++) {
            const g = h + gx * (j + gy * k);
            best = Math.max(best, most[g]!);
            full &&= filled[g] === 64;
          }
      coarse[2 * i] = best;
      coarse[2 * i + 1] = best ? (full ? 255 : 128) : 0;
    }
  }

  /** What the shaders compare and colour: of float16 textures scaled to 0 … 1. */
  level(v: number): number {
    const shown = this.log ? (v > 0 ? Math.log10(v) : -1e30) : v;
    return this.exact ? shown : (shown - this.zero) * this.unit;
  }

  dispose(): void { for (const t of [this.raw, this.soft, this.coarse]) t.dispose(); }
}

const STYLES: Record<string, number> = { surface: 0, translucent: 1, isosurface: 2, cells: 3 };
const ghost = { light: new THREE.Color(0x5b6b7c), dark: new THREE.Color(0xb4c3d4) };

/** One volume as it is drawn. */
export class VolumeBody {
  lattice!: Lattice;
  settings!: VolumeSettings;
  scale: ColorScale | null = null;
  /** From the volume's world to the world; another than 1 for mappings. */
  readonly place = new THREE.Matrix4();
  private textures: Textures | null = null;
  private materials = new Map<number, THREE.ShaderMaterial>();
  private sheets = new Map<boolean, THREE.ShaderMaterial>();
  private uniforms: Record<string, THREE.IUniform> = {
    raw: { value: null }, soft: { value: null }, coarse: { value: null }, lut: { value: null }, shape: { value: new THREE.Vector3() },
    range: { value: new THREE.Vector2(0, 1) }, threshold: { value: NONE }, low: { value: new THREE.Vector3() }, high: { value: new THREE.Vector3() },
    opacity: { value: 1 }, density: { value: 1 }, stride: { value: 1 }, seed: { value: 0 }, sceneDepth: { value: null }, solidDepth: { value: null }, ghost: { value: ghost.light },
    clipToCells: { value: new THREE.Matrix4() }, cellsToClip: { value: new THREE.Matrix4() }, toWorldNormal: { value: new THREE.Matrix3() },
    sun: { value: new THREE.Vector3() }, toCells: { value: new THREE.Matrix4() },
    other: { value: null }, toOther: { value: new THREE.Matrix4() }, otherShape: { value: new THREE.Vector3(1, 1, 1) },
  };
  private lut = new THREE.DataTexture(new Uint8Array(1024), 256, 1);
  private mapped: VolumeBody | null = null;
  private drawn = "";
  private boxed: { lattice: Lattice; box: THREE.Box3 } | null = null;

  constructor(readonly volume: Volume) {
    this.uniforms.lut!.value = this.lut;
  }

  /** Shows a lattice under settings; textures are made again only where the values changed. */
  set(lattice: Lattice, settings: VolumeSettings, scale: ColorScale | null): void {
    const exact = settings.style === "cells", log = scale?.log ?? false;
    if (lattice !== this.lattice || !this.textures || this.textures.exact !== exact || this.textures.log !== log) {
      if (this.textures?.fits(lattice) && this.textures.exact === exact) this.textures.set(lattice, log);
      else { this.textures?.dispose(); this.textures = new Textures(lattice, log, exact); }
    }
    this.lattice = lattice; this.settings = settings; this.scale = scale;
    const t = this.textures, u = this.uniforms;
    u.raw!.value = t.raw; u.soft!.value = t.soft; u.coarse!.value = t.coarse;
    (u.shape!.value as THREE.Vector3).fromArray(t.shape);
    const a = scale ? t.level(scale.low) : 0, b = scale ? t.level(scale.high) : 1;
    (u.range!.value as THREE.Vector2).set(b > a ? a : a - 0.35, b > a ? 1 / (b - a) : 1);
    u.threshold!.value = lattice.values && this.threshold !== null ? t.level(this.threshold) : NONE;
    u.opacity!.value = settings.opacity;
    u.density!.value = 5 / Math.max(...lattice.shape);
    const colors = scale?.colors.join() ?? "";
    if (colors !== this.drawn) {
      this.drawn = colors;
      (this.lut.image.data as Uint8Array).set(scale?.colors ?? new Uint8Array(1024).fill(170));
      this.lut.needsUpdate = true;
    }
    const low = u.low!.value as THREE.Vector3, high = u.high!.value as THREE.Vector3;
    low.set(0.5, 0.5, 0.5); high.fromArray(t.shape).subScalar(0.5);
    for (const cut of settings.cut) {
      const k = "xyz".indexOf(cut.axis), of = (m: number) => m / lattice.size - lattice.first[k]! + PAD;
      if (cut.from_m !== null) low.setComponent(k, Math.max(low.getComponent(k), of(cut.from_m)));
      if (cut.to_m !== null) high.setComponent(k, Math.min(high.getComponent(k), of(cut.to_m)));
    }
  }

  /** The value that must be reached to be seen; of an iso-surface without one, half of its range. */
  get threshold(): number | null {
    if (this.settings.threshold !== null) return this.settings.threshold;
    return this.settings.style === "isosurface" && this.scale ? this.scale.value(0.5) : null;
  }

  /** Green where the mapped volume lies inside another, red elsewhere; null: by values. */
  within(other: VolumeBody | null): void {
    if ((other === null) !== (this.mapped === null)) { this.forget(); }
    this.mapped = other;
  }


  get solid(): boolean { return this.settings.style !== "translucent" && this.settings.opacity >= 1; }

  /** From the cells of the padded textures to the world. */
  toWorld(): THREE.Matrix4 {
    const { first, size } = this.lattice;
    const m = new THREE.Matrix4().makeScale(size, size, size);
    m.setPosition(...(first.map((f) => (f - PAD) * size) as [number, number, number]));
    return m.premultiply(this.place);
  }

  /** Corners of the occupied voxels in the world. */
  box(): THREE.Box3 {
    if (this.boxed?.lattice !== this.lattice) this.boxed = { lattice: this.lattice, box: this.ownBox() };
    return this.boxed.box.clone().applyMatrix4(this.place);
  }

  private ownBox(): THREE.Box3 {
    const { shape: [nx, ny, nz], first, size, occupied } = this.lattice, low = [nx, ny, nz], high = [-1, -1, -1];
    for (let z = 0, i = 0; z < nz; z++) for (let y = 0; y < ny; y++) for (let x = 0; x < nx; x++, i++) {
      if (!occupied[i]) continue;
      if (x < low[0]!) low[0] = x; if (x > high[0]!) high[0] = x;
      if (y < low[1]!) low[1] = y; if (y > high[1]!) high[1] = y;
      low[2] = Math.min(low[2]!, z); high[2] = z;
    }
    if (high[0]! < 0) return new THREE.Box3();
    const of = (c: number[], more: number) => new THREE.Vector3(...(c.map((v, a) => (v + more + first[a]!) * size) as [number, number, number]));
    return new THREE.Box3(of(low, 0), of(high, 1));
  }

  private defines(exact: boolean): Record<string, string> { return { ...(exact ? { EXACT: "" } : {}), ...(this.mapped ? { MAPPED: "" } : {}) }; }

  /** The material of the rays, made ready for a camera and the depths of the scene. */
  rays(camera: THREE.Camera, depths: [THREE.Texture, THREE.Texture], sun: THREE.Vector3, dark: boolean, stride: number, seed: number): THREE.ShaderMaterial {
    const style = STYLES[this.settings.style] ?? 0, u = this.uniforms, toWorld = this.toWorld();
    let material = this.materials.get(style);
    if (!material) {
      material = new THREE.ShaderMaterial({
        glslVersion: THREE.GLSL3, vertexShader: glsl.quad, fragmentShader: glsl.march, uniforms: u, defines: { STYLE: style, ...this.defines(style === 3) },
        transparent: true, blending: THREE.CustomBlending, blendSrc: THREE.OneFactor, blendDst: THREE.OneMinusSrcAlphaFactor,
      });
      this.materials.set(style, material);
    }
    material.depthTest = material.depthWrite = this.solid;
    material.blending = this.solid && style !== 2 ? THREE.NoBlending : THREE.CustomBlending;
    (u.cellsToClip!.value as THREE.Matrix4).multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).multiply(toWorld);
    (u.clipToCells!.value as THREE.Matrix4).copy(u.cellsToClip!.value as THREE.Matrix4).invert();
    (u.toWorldNormal!.value as THREE.Matrix3).getNormalMatrix(toWorld);
    (u.sun!.value as THREE.Vector3).copy(sun);
    [u.sceneDepth!.value, u.solidDepth!.value] = depths; u.stride!.value = stride; u.seed!.value = seed; u.ghost!.value = dark ? ghost.dark : ghost.light;
    this.look();
    return material;
  }

  /** The material of planes through it. */
  sheet(): THREE.ShaderMaterial {
    const exact = this.settings.style === "cells";
    let material = this.sheets.get(exact);
    if (!material) {
      material = new THREE.ShaderMaterial({
        glslVersion: THREE.GLSL3, vertexShader: glsl.sheetVertex, fragmentShader: glsl.sheet, side: THREE.DoubleSide,
        uniforms: { ...this.uniforms, low: { value: new THREE.Vector3(0.5, 0.5, 0.5) }, high: { value: new THREE.Vector3() }, opacity: { value: 1 } }, defines: this.defines(exact),
      });
      this.sheets.set(exact, material);
    }
    material.uniforms.high!.value.fromArray(this.textures!.shape).subScalar(0.5);
    (this.uniforms.toCells!.value as THREE.Matrix4).copy(this.toWorld()).invert();
    this.look();
    return material;
  }

  private look(): void {
    const other = this.mapped;
    if (!other?.textures) return;
    this.uniforms.other!.value = other.textures.soft;
    (this.uniforms.otherShape!.value as THREE.Vector3).fromArray(other.textures.shape);
    (this.uniforms.toOther!.value as THREE.Matrix4).copy(other.toWorld()).invert().multiply(this.toWorld());
  }

  /** The first shown voxel that a ray in the world meets: a walk through the numbers themselves. */
  pick(ray: THREE.Ray): { cell: [number, number, number]; point: THREE.Vector3; distance: number } | null {
    const { shape, occupied, values } = this.lattice, toCells = this.toWorld().invert(), least = this.threshold;
    const origin = ray.origin.clone().applyMatrix4(toCells).subScalar(PAD);
    const d = ray.origin.clone().add(ray.direction).applyMatrix4(toCells).subScalar(PAD).sub(origin); // t stays metres
    const low = (this.uniforms.low!.value as THREE.Vector3).clone().subScalar(PAD), high = (this.uniforms.high!.value as THREE.Vector3).clone().subScalar(PAD);
    let t0 = 0, t1 = Infinity;
    for (let k = 0; k < 3; k++) {
      const a = (Math.max(0, low.getComponent(k)) - origin.getComponent(k)) / d.getComponent(k), b = (Math.min(shape[k]!, high.getComponent(k)) - origin.getComponent(k)) / d.getComponent(k);
      if (Number.isNaN(a) || Number.isNaN(b)) continue;
      t0 = Math.max(t0, Math.min(a, b)); t1 = Math.min(t1, Math.max(a, b));
    }
    if (t0 >= t1) return null;
    const at = origin.clone().addScaledVector(d, t0 + 1e-9 * (t1 - t0)), c = [0, 1, 2].map((k) => Math.min(shape[k]! - 1, Math.max(0, Math.floor(at.getComponent(k))))) as [number, number, number];
    const step = d.toArray().map(Math.sign), next = c.map((v, k) => (v + (step[k]! > 0 ? 1 : 0) - origin.getComponent(k)) / d.getComponent(k)).map((v) => (Number.isFinite(v) ? v : Infinity));
    for (let t = t0; t < t1;) {
      const i = c[0] + shape[0] * (c[1] + shape[1] * c[2]);
      if (occupied[i] && (!values || (!Number.isNaN(values[i]!) && (least === null || values[i]! >= least)))) {
        return { cell: c, point: ray.at(t, new THREE.Vector3()), distance: t };
      }
      const k = next[0]! <= next[1]! ? (next[0]! <= next[2]! ? 0 : 2) : next[1]! <= next[2]! ? 1 : 2;
      t = next[k]!;
      c[k]! += step[k]!;
      next[k]! += Math.abs(1 / d.getComponent(k));
      if (c[k]! < 0 || c[k]! >= shape[k]!) return null;
    }
    return null;
  }

  /** Its shown voxels as points. */
  points(): Cloud {
    const { values } = this.lattice, least = this.threshold, { cut } = this.settings;
    const cloud = cloudOf(this.lattice, this.scale, (i) => least === null || !values || values[i]! >= least, (...p) => cut.every((c) => {
      const v = p["xyz".indexOf(c.axis)]!;
      return v >= (c.from_m ?? -Infinity) && v <= (c.to_m ?? Infinity);
    }));
    const at = new THREE.BufferAttribute(cloud.positions, 3).applyMatrix4(this.place);
    return { ...cloud, positions: at.array as Float32Array };
  }

  /** Centre of a voxel in the world. */
  center(cell: ArrayLike<number>): THREE.Vector3 {
    const { first, size } = this.lattice;
    return new THREE.Vector3(...([0, 1, 2].map((k) => (first[k]! + cell[k]! + 0.5) * size) as [number, number, number])).applyMatrix4(this.place);
  }

  value(cell: ArrayLike<number>): number {
    const { shape, values } = this.lattice;
    return values?.[cell[0]! + shape[0] * (cell[1]! + shape[1] * cell[2]!)] ?? NaN;
  }

  private forget(): void {
    for (const m of [...this.materials.values(), ...this.sheets.values()]) m.dispose();
    this.materials.clear(); this.sheets.clear();
  }

  dispose(): void { this.forget(); this.textures?.dispose(); this.lut.dispose(); }
}
