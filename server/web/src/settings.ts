/** All that decides what a view looks like, as one plain value: the panel edits it, the stage draws it, a link holds it. */

import type { Manifest, Vector, Volume } from "./contract";

export interface Range { low: number | null; high: number | null; scale: "linear" | "log"; clipped: boolean } // null: the data's; clipped: without outliers
export interface Layer { visible: boolean; opacity: number }
export interface Slice { axis: "x" | "y" | "z" | "oblique"; at_m: number; normal: Vector; visible: boolean }

export interface VolumeSettings extends Layer {
  style: "surface" | "translucent" | "isosurface" | "cells" | "points"; // cells: nearest, exact colours
  channel: string; // "statistic:name", "" for occupancy alone
  threshold: number | null; // smaller values are not drawn, in the channel's unit; of an iso-surface null is half of the range
  cut: { axis: "x" | "y" | "z"; from_m: number | null; to_m: number | null }[]; // cut open: what is kept
  minus: string; // name of the volume that is subtracted, voxel by voxel; "" for none
}

export interface Settings {
  theme: "light" | "dark" | "system";
  camera: { position: Vector; target: Vector; up: Vector; orthographic: boolean } | null; // null: fits what is shown
  volumes: Record<string, VolumeSettings>;
  slices: Slice[];
  layers: Record<string, Layer>; // meshes, points, glyphs, curves, maps, skeletons, "robot:0", "frames", "axes", "scale_bar"
  channels: Record<string, string>; // shown of points and maps, "statistic:name"; the first where not said
  range: Range; // of the channel of the first volume that is shown, else of the first points or map
  colors: string; // of the colour maps
  configurations: number[][]; // per robot
  placements: (number[] | null)[]; // per robot, 16: stands elsewhere than in the file
  limits: Record<string, [number, number]>[]; // per robot, dragged
  tools: (number[] | null)[]; // per robot, 16
  samples: (number | null)[]; // per robot, of the volume that is computed: as many as a point of a convergence curve has
  mapping: { scale: number | Vector; offset_m: Vector } | null;
  measure: Vector[]; // two points
  selected: { volume: string; cell: Vector } | null;
}

export const channelKey = (channel: { statistic: string; name: string }): string => `${channel.statistic}:${channel.name}`;

/** Too thin to be cut open, and for a smoothed border, which loses holes and rims: its robots are seen through it. */
const flat = ({ shape }: Volume): boolean => Math.min(...shape) < 4;

/** Cut open where it would hide the first robot: through its base, the half towards the eye (`Stage.fit`) away. */
function opened(volume: Volume, { robots, mapping }: Manifest): VolumeSettings["cut"] {
  const [x, y, z] = [3, 7, 11].map((k) => robots[0]?.chain.T_base[k]), { shape, first_voxel, voxel_size_m } = volume;
  if (mapping || flat(volume)) return [];
  const within = [x, y, z].every((at, k) => at !== undefined && at >= first_voxel[k]! * voxel_size_m && at <= (first_voxel[k]! + shape[k]!) * voxel_size_m);
  return within ? [{ axis: "y", from_m: y!, to_m: null }] : [];
}

/** How a volume is shown first where it is the only one. */
export function volumeSettings(volume: Volume, manifest: Manifest): VolumeSettings {
  return {
    visible: true, opacity: flat(volume) && manifest.robots.length ? 0.6 : 1, style: flat(volume) ? "cells" : "surface",
    channel: volume.channels[0] ? channelKey(volume.channels[0]) : "", threshold: null, cut: opened(volume, manifest), minus: "",
  };
}

const MANY_ARROWS = 3000; // behind so many nothing is seen

/** How a view is shown first. */
export function defaultSettings(manifest: Manifest): Settings {
  const mapped = manifest.mapping?.volumes;
  const volumes = manifest.volumes.map((volume, i): [string, VolumeSettings] => [volume.name, {
    ...volumeSettings(volume, manifest), visible: mapped ? Object.values(mapped).includes(volume.name) : i === 0,
    ...(volume.name === mapped?.master ? { style: "translucent" } : {}), ...(i === 0 ? {} : { cut: [] }),
  }]);
  const thicket = manifest.glyphs.filter((arrows) => arrows.origins.length / 3 > MANY_ARROWS);
  const covers = manifest.volumes.length ? [...manifest.meshes.filter((mesh) => mesh.role === "surface" || mesh.role === "refined"), ...manifest.points, ...thicket] : []; // hide the volume
  const hidden = ["frames", ...covers.map((each) => each.name)].map((key): [string, Layer] => [key, { visible: false, opacity: 1 }]);
  return {
    theme: "system", camera: null, volumes: Object.fromEntries(volumes), slices: [], layers: Object.fromEntries(hidden), channels: {},
    range: { low: null, high: null, scale: "linear", clipped: true }, colors: "viridis",
    configurations: manifest.robots.map((r) => [...r.home]), placements: manifest.robots.map(() => null), limits: manifest.robots.map(() => ({})), tools: manifest.robots.map(() => null), samples: manifest.robots.map(() => null),
    mapping: manifest.mapping ? { scale: manifest.mapping.scale, offset_m: [...manifest.mapping.offset_m] } : null, measure: [], selected: null,
  };
}
