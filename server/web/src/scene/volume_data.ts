/** A volume's numbers: fetched channel by channel, coarse first, kept while they are likely to be shown again. */

import type { Channel, Vector, Volume } from "../contract";
import { channelKey, type VolumeSettings } from "../settings";
import { difference, extent, occupancy, values, withoutOutliers, type Blob_, type Lattice } from "./data";
import type { Cloud } from "./splat";
import { VolumeBody } from "./volume";

export interface Shown { lattice: Lattice; channel: Pick<Channel, "label" | "unit" | "signed" | "whole" | "categories"> | null; whole: [number, number] | null; inner: [number, number] | null }

const KEPT = 4; // channels

export class VolumeData {
  readonly body: VolumeBody;
  /** What is shown until the channel that is wanted is here. */
  preview: Shown | null;
  cloud: { lattice: Lattice; look: string; cloud: Cloud } | null = null; // as it is drawn as points
  private grid: Promise<Lattice> | null = null;
  private channels = new Map<string, Promise<Shown>>();
  private here = new Map<string, Shown>();

  constructor(readonly volume: Volume, private blob: Blob_, before: VolumeData | null = null) {
    this.body = before?.body ?? new VolumeBody(volume);
    this.preview = before?.preview ?? null;
  }

  private key(wanted: VolumeSettings, minus: VolumeData | null): string { return this.keyOf(wanted.channel, minus); }

  private keyOf(channel: string, minus: VolumeData | null): string { return `${channel} − ${minus?.volume.name ?? ""}`; }

  has(wanted: VolumeSettings, minus: VolumeData | null): Shown | null { return this.here.get(this.key(wanted, minus)) ?? null; }

  /** Fetches what is wanted; `early` is called when a coarser one can be shown meanwhile. */
  async get(wanted: VolumeSettings, minus: VolumeData | null, early?: () => void): Promise<Shown> {
    const key = this.key(wanted, minus);
    let found = this.channels.get(key);
    if (!found) {
      found = this.fetch(wanted.channel, minus, early);
      this.channels.set(key, found);
      found.catch(() => this.channels.delete(key));
    }
    const shown = await found;
    this.here.delete(key);
    this.here.set(key, shown);
    this.preview = shown;
    for (const old of this.here.keys()) if (this.here.size > KEPT) { this.here.delete(old); this.channels.delete(old); }
    return shown;
  }

  private async fetch(channel: string, minus: VolumeData | null, early?: () => void): Promise<Shown> {
    const coarse = this.volume.coarser?.at(-1);
    if (coarse && early && !this.preview && !minus) {
      this.preview = await shown(coarse, occupancy(coarse, this.blob), channel, this.blob);
      early();
    }
    this.grid ??= occupancy(this.volume, this.blob);
    const own = await shown(this.volume, this.grid, channel, this.blob);
    if (!minus) return own;
    const other = await minus.get({ channel } as VolumeSettings, null), lattice = difference(own.lattice, other.lattice);
    const about = own.channel && { label: `Δ ${own.channel.label}`, unit: own.channel.unit, signed: true, whole: own.channel.whole };
    return { lattice, channel: about, whole: extent(lattice.values!), inner: withoutOutliers(lattice.values!) };
  }

  /** Values of a cell, by channel, of those that are here. */
  valuesAt(cell: Vector): Map<string, number> {
    const [nx, ny] = this.volume.shape, at = cell[0] + nx * (cell[1] + ny * cell[2]), found = new Map<string, number>();
    for (const channel of this.volume.channels) {
      const own = this.here.get(this.keyOf(channelKey(channel), null))?.lattice.values?.[at];
      if (own !== undefined) found.set(channelKey(channel), own);
    }
    return found;
  }

  dispose(): void { this.body.dispose(); }
}

async function shown(volume: Volume, grid: Promise<Lattice>, key: string, blob: Blob_): Promise<Shown> {
  const channel = volume.channels.find((c) => channelKey(c) === key) ?? null;
  if (!channel) return { lattice: await grid, channel: null, whole: null, inner: null };
  const [lattice, found] = await Promise.all([grid, values(channel, blob)]);
  if (found.length !== lattice.occupied.length) throw new Error(`channel "${key}" of volume "${volume.name}" has ${found.length} voxels, not ${lattice.occupied.length}`);
  for (let i = 0; i < found.length; i++) if (!lattice.occupied[i]) found[i] = NaN;
  return { lattice: { ...lattice, values: found }, channel, whole: extent(found), inner: withoutOutliers(found) };
}
