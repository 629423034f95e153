/** From blobs to numbers. */

import type { Channel, Data, Volume, Vector } from "../contract";

export type Blob_ = (name: string) => Promise<ArrayBuffer>;
export type Numbers = Uint8Array | Uint16Array | Uint32Array | Float32Array;

async function inflate(bytes: ArrayBuffer): Promise<ArrayBuffer> {
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}

/** The bytes of a blob, inflated, checked for their length. */
export async function bytes(data: Data, blob: Blob_): Promise<ArrayBuffer> {
  const found = await blob(data.blob), plain = data.compression === "deflate" ? await inflate(found) : found;
  const width = { uint8: 1, glb: 1, uint16: 2, float16: 2, uint32: 4, float32: 4 }[data.type];
  if (plain.byteLength !== width * data.length) throw new Error(`blob "${data.blob}" has ${plain.byteLength} bytes, not ${width * data.length}`);
  return plain;
}

let halves: Float32Array | null = null;
function ofHalf(h: number): number {
  const e = (h >> 10) & 31, m = h & 1023, s = h & 0x8000 ? -1 : 1;
  return e === 31 ? (m ? NaN : s * Infinity) : e ? s * (1 + m / 1024) * 2 ** (e - 15) : s * m * 2 ** -24;
}

/** Float16 as float32, exactly. */
export function fromHalf(found: Uint16Array): Float32Array {
  halves ??= Float32Array.from({ length: 65536 }, (_, h) => ofHalf(h));
  const out = new Float32Array(found.length);
  for (let i = 0; i < found.length; i++) out[i] = halves[found[i]!]!;
  return out;
}

export async function numbers(data: Data, blob: Blob_): Promise<Numbers> {
  const plain = await bytes(data, blob);
  switch (data.type) {
    case "uint8": case "glb": return new Uint8Array(plain);
    case "uint16": return new Uint16Array(plain);
    case "uint32": return new Uint32Array(plain);
    case "float16": return fromHalf(new Uint16Array(plain));
    case "float32": return new Float32Array(plain);
  }
}

/** The values of a channel, NaN where there is none. */
export async function values(channel: Channel, blob: Blob_): Promise<Float32Array> {
  const found = await numbers(channel.data, blob);
  if (found instanceof Float32Array) return found;
  const out = new Float32Array(found.length), step = (channel.maximum - channel.minimum) / 254;
  const of = channel.data.type === "uint8" ? (v: number) => (v ? channel.minimum + (v - 1) * step : NaN) : (v: number) => v;
  for (let i = 0; i < found.length; i++) out[i] = of(found[i]!);
  return out;
}

/** One channel of a volume on its lattice; `values` null: occupancy alone. */
export interface Lattice {
  shape: Vector;
  first: Vector; // index of its voxel (0, 0, 0) on the world's lattice
  size: number; // of a voxel [m]
  occupied: Uint8Array;
  values: Float32Array | null;
}

export async function occupancy(volume: Volume, blob: Blob_): Promise<Lattice> {
  const occupied = (await numbers(volume.occupancy, blob)) as Uint8Array, [x, y, z] = volume.shape;
  if (occupied.length !== x * y * z) throw new Error(`the occupancy of volume "${volume.name}" has ${occupied.length} voxels, not ${x * y * z}`);
  return { shape: volume.shape, first: volume.first_voxel, size: volume.voxel_size_m, occupied, values: null };
}

/** a − b, voxel by voxel, where both have a value; they must stand on one lattice. */
export function difference(a: Lattice, b: Lattice): Lattice {
  if (!a.values || !b.values) throw new Error("a difference needs a channel of both volumes");
  if (Math.abs(a.size - b.size) > 1e-9 * a.size) throw new Error(`a difference needs equal voxels: ${a.size} m and ${b.size} m`);
  const [nx, ny, nz] = a.shape, [mx, my, mz] = b.shape, [ox, oy, oz] = a.first.map((f, k) => f - b.first[k]!) as Vector;
  const out = new Float32Array(a.values.length).fill(NaN), occupied = new Uint8Array(a.occupied.length);
  for (let z = 0, i = 0; z < nz; z++) for (let y = 0; y < ny; y++) for (let x = 0; x < nx; x++, i++) {
    const u = x + ox, v = y + oy, w = z + oz;
    if (!a.occupied[i] || u < 0 || v < 0 || w < 0 || u >= mx || v >= my || w >= mz) continue;
    const j = u + mx * (v + my * w), d = a.values[i]! - b.values[j]!;
    if (b.occupied[j] && !Number.isNaN(d)) { out[i] = d; occupied[i] = 1; }
  }
  return { ...a, occupied, values: out };
}

/** The least and the largest finite one, null where there is none. */
export function extent(found: ArrayLike<number>): [number, number] | null {
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < found.length; i++) {
    const v = found[i]!;
    if (v < low && v > -Infinity) low = v;
    if (v > high && v < Infinity) high = v;
  }
  return low <= high ? [low, high] : null;
}

/** The least and the largest value that is no outlier: no further from the middle 96 % than these are wide, as in the pictures. */
export function withoutOutliers(found: ArrayLike<number>): [number, number] | null {
  const whole = extent(found);
  if (!whole || whole[0] === whole[1]) return whole;
  const most = 200_000, known: number[] = [], step = Math.max(1, Math.floor(found.length / most)); // what decides is told from some of many
  for (let i = 0; i < found.length; i += step) if (Number.isFinite(found[i]!)) known.push(found[i]!);
  if (known.length < 10) return whole;
  const sorted = Float64Array.from(known).sort(), n = sorted.length - 1;
  const a = sorted[Math.ceil(0.02 * n)]!, b = sorted[Math.floor(0.98 * n)]!, span = b - a;
  if (span <= 0) return whole;
  let [high, low] = whole;
  for (let i = 0; i < found.length; i++) {
    const v = found[i]!;
    if (v < low && v >= a - span) low = v;
    if (v > high && v <= b + span) high = v;
  }
  return [low, high];
}

/** Values with their extents, which settings ask for again and again. */
export interface Measured { values: Float32Array; whole: [number, number] | null; inner: [number, number] | null }

export const measured = (found: Float32Array): Measured => ({ values: found, whole: extent(found), inner: withoutOutliers(found) });
