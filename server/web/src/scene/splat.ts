/** Points drawn on the CPU into colours and depths, a z-buffer of its own: software GL takes 30 times as long for a million. */

import * as THREE from "three";
import type { Points } from "../contract";
import { channelKey, type Settings } from "../settings";
import { ColorScale, scaleOf } from "./colors";
import { measured, numbers, values, type Blob_, type Lattice, type Measured } from "./data";
import * as glsl from "./shaders";

export interface Cloud { positions: Float32Array; colors: Uint32Array; count: number; radius_m: number }

export class Splats {
  readonly object: THREE.Mesh<THREE.PlaneGeometry, THREE.ShaderMaterial>;
  private colours = new THREE.DataTexture(new Uint8Array(4), 1, 1);
  private depths = new THREE.DataTexture(new Float32Array(1), 1, 1, THREE.RedFormat, THREE.FloatType);
  constructor() {
    this.object = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: glsl.quad, fragmentShader: glsl.splat, uniforms: { colours: { value: this.colours }, depths: { value: this.depths } },
    }));
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  /** Every `thin`-th point, into width × height pixels. */
  draw(clouds: Cloud[], camera: THREE.Camera, width: number, height: number, thin: number): void {
    this.object.visible = clouds.length > 0;
    if (!clouds.length) return;
    if (this.colours.image.width !== width || this.colours.image.height !== height) {
      this.colours.dispose(); this.depths.dispose();
      this.colours.image = { data: new Uint8Array(4 * width * height), width, height };
      this.depths.image = { data: new Float32Array(width * height), width, height };
    }
    const depth = this.depths.image.data as Float32Array, color = new Uint32Array((this.colours.image.data as Uint8Array).buffer);
    depth.fill(1);
    const m = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements as number[];
    const [a, b, c, d, e, f, g, h, i, j, k, l, o, p, q, r] = [m[0]!, m[4]!, m[8]!, m[12]!, m[1]!, m[5]!, m[9]!, m[13]!, m[2]!, m[6]!, m[10]!, m[14]!, m[3]!, m[7]!, m[11]!, m[15]!];
    const pixels = (camera.projectionMatrix.elements[5]! * height) / 2; // of a metre at w = 1
    for (const cloud of clouds) {
      const at = cloud.positions, colors = cloud.colors, n = cloud.count;
      for (let s = 0; s < n; s += thin) {
        const x = at[3 * s]!, y = at[3 * s + 1]!, z = at[3 * s + 2]!, w = o * x + p * y + q * z + r;
        if (w <= 0) continue;
        const u = (((a * x + b * y + c * z + d) / w + 1) * width) / 2, v = (((e * x + f * y + g * z + h) / w + 1) * height) / 2, t = ((i * x + j * y + k * z + l) / w + 1) / 2;
        const size = (cloud.radius_m * pixels) / w;
        if (size <= 0.75) {
          const X = u | 0, Y = v | 0;
          if (u < 0 || v < 0 || X >= width || Y >= height) continue;
          const n_ = X + width * Y;
          if (t < depth[n_]!) { depth[n_] = t; color[n_] = colors[s]!; }
          continue;
        }
        const R = Math.min(size, 12), x0 = Math.max(0, Math.ceil(u - R - 0.5)), x1 = Math.min(width - 1, Math.floor(u + R - 0.5)), y0 = Math.max(0, Math.ceil(v - R - 0.5)), y1 = Math.min(height - 1, Math.floor(v + R - 0.5));
        for (let Y = y0; Y <= y1; Y++) for (let X = x0; X <= x1; X++) {
          const dx = X + 0.5 - u, dy = Y + 0.5 - v, n_ = X + width * Y;
          if (t < depth[n_]! && (R < 2 || dx * dx + dy * dy <= R * R)) { depth[n_] = t; color[n_] = colors[s]!; }
        }
      }
    }
    this.colours.needsUpdate = this.depths.needsUpdate = true;
  }

  dispose(): void { this.colours.dispose(); this.depths.dispose(); this.object.geometry.dispose(); this.object.material.dispose(); }
}

const packed = ([r, g, b]: [number, number, number]): number => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;

/** The occupied voxels' centres as points. */
export function cloudOf(lattice: Lattice, scale: ColorScale | null, shown: (cell: number) => boolean, within: (x: number, y: number, z: number) => boolean): Cloud {
  const [nx, ny, nz] = lattice.shape, { occupied, values: v, size, first } = lattice, at: number[] = [], colors: number[] = [], grey = packed([150, 150, 150]);
  const of = table(scale);
  for (let z = 0, i = 0; z < nz; z++) for (let y = 0; y < ny; y++) for (let x = 0; x < nx; x++, i++) {
    if (!occupied[i] || (v && Number.isNaN(v[i]!)) || !shown(i)) continue;
    const px = (first[0] + x + 0.5) * size, py = (first[1] + y + 0.5) * size, pz = (first[2] + z + 0.5) * size;
    if (!within(px, py, pz)) continue;
    at.push(px, py, pz);
    colors.push(v && scale ? of(v[i]!) : grey);
  }
  return { positions: Float32Array.from(at), colors: Uint32Array.from(colors), count: colors.length, radius_m: size * 0.3 };
}

function table(scale: ColorScale | null): (v: number) => number {
  if (!scale) return () => 0;
  const colors = Uint32Array.from({ length: 256 }, (_, i) => packed([scale.colors[4 * i]!, scale.colors[4 * i + 1]!, scale.colors[4 * i + 2]!]));
  return (v) => colors[Math.min(255, Math.floor(256 * scale.at(v)))]!;
}

/** Sampled points of a view. */
export class PointLayer {
  readonly key: string;
  scale: ColorScale | null = null;
  cloud: Cloud | null = null;
  readonly box: THREE.Box3;
  private found = new Map<string, Measured>();
  private asked = new Set<string>();
  private positions: Float32Array | null = null;
  private drawn = "";

  constructor(readonly points: Points, private blob: Blob_, private again: () => void) {
    this.key = points.name;
    this.box = new THREE.Box3(new THREE.Vector3(...points.lower), new THREE.Vector3(...points.upper));
  }

  set(settings: Settings, leads: boolean, span: number): void {
    const layer = settings.layers[this.key];
    if (layer?.visible === false) { this.cloud = null; return; }
    const channel = this.points.channels.find((c) => channelKey(c) === settings.channels?.[this.key]) ?? this.points.channels[0];
    if (!this.positions) return this.fetch("positions", async () => {
      const { lower, upper, positions } = this.points, q = (await numbers(positions, this.blob)) as Uint16Array;
      this.positions = Float32Array.from(q, (v, i) => lower[i % 3]! + (v / 65535) * (upper[i % 3]! - lower[i % 3]!));
    });
    if (channel && !this.found.has(channelKey(channel))) return this.fetch(channelKey(channel), async () => { this.found.set(channelKey(channel), measured(await values(channel, this.blob))); });
    const known = channel ? this.found.get(channelKey(channel))! : null, v = known?.values ?? null;
    this.scale = channel && known ? scaleOf(channel, known.whole, known.inner, leads ? settings.range : null, settings.colors) : null;
    const look = `${channel ? channelKey(channel) : ""} ${this.scale?.low} ${this.scale?.high} ${this.scale?.log} ${settings.colors}`;
    if (this.cloud && look === this.drawn) return;
    this.drawn = look;
    const of = table(this.scale), grey = packed([120, 130, 140]), n = this.points.count, colors = new Uint32Array(n);
    for (let i = 0; i < n; i++) colors[i] = v && !Number.isNaN(v[i]!) ? of(v[i]!) : grey;
    this.cloud = { positions: this.positions, colors, count: n, radius_m: span * Math.min(0.012, Math.max(0.0009, 0.12 / Math.sqrt(n))) };
  }

  private fetch(key: string, get: () => Promise<void>): void {
    if (this.asked.has(key)) return;
    this.asked.add(key);
    get().then(this.again, () => this.asked.delete(key));
  }

  /** The point nearest to a ray among those that it nearly meets. */
  pick(ray: THREE.Ray, radius: number): { distance: number; point: THREE.Vector3; number: number } | null {
    const cloud = this.cloud, p = new THREE.Vector3(), v = new THREE.Vector3();
    if (!cloud) return null;
    let best = -1, nearest = Infinity;
    for (let i = 0; i < cloud.count; i++) {
      v.subVectors(p.fromArray(cloud.positions, 3 * i), ray.origin);
      const t = v.dot(ray.direction);
      if (t > 0 && t < nearest && v.lengthSq() - t * t < radius * radius) { nearest = t; best = i; }
    }
    return best < 0 ? null : { distance: nearest, point: new THREE.Vector3().fromArray(cloud.positions, 3 * best), number: best };
  }
}
