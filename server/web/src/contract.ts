/**
 * What a view is made of, as `wsrender.results.view` writes it, and what a home of the page must offer.
 *
 * A manifest is JSON; bulk data are blobs, fetched by name. Lengths in metres, angles in radians, right-handed world frame
 * with z up, quaternions w-x-y-z, matrices row-major. Voxel arrays are x-fastest: cell (i, j, k) at i + nx (j + ny k).
 */

export type Vector = [number, number, number];
export type Number = number | null; // null: not finite, or not known

/** Numbers in a blob; "deflate" is a zlib stream. float16 as IEEE half, all little-endian. */
export interface Data {
  blob: string;
  type: "uint8" | "uint16" | "uint32" | "float16" | "float32" | "glb";
  length: number; // numbers of it; of a glb its bytes
  compression: null | "deflate";
}

/** One kinematic chain, as `wsrender.robots.chain.Chain` says it. */
export interface Chain {
  joints: string[]; // n coordinates
  angle: boolean[]; // n: [rad], else [m]
  lower: Number[]; // n; null: no limit
  upper: Number[];
  periodic: boolean[];
  revolute: boolean[]; // L joints
  source: number[];
  scale: number[];
  offset: number[];
  T_joint: number[][]; // L of 16
  T_tip: number[]; // 16, tool included
  T_tool: number[]; // 16, the tool alone, in the frame of the tip
  T_base: number[]; // 16
}

/** Bodies in one frame: 0 is the base, k + 1 the frame of joint k after its motion. */
/** GLB files hold coordinates as they are, not turned: of a link in its frame, of meshes in the world, z up. */
export interface Link { name: string; frame: number; geometry: Data; kind: "visual" | "collision" }

export interface Robot {
  name: string;
  chain: Chain;
  links: Link[]; // none: drawn as sticks
  home: number[]; // the configuration that is shown first
  samples?: { configurations: number[][]; said: string }; // such as one per reason of rejection
}

/** A closed mechanism or legs whose motion the page can't compute: lines through points, by configuration. */
export interface Skeleton { name: string; points: Vector[][]; closed: boolean }

export interface Channel {
  name: string; // such as "manipulability"
  statistic: string; // maximum, mean, minimum, count, share, label …
  label: string; // for people, without the unit
  unit: string;
  minimum: number; // of occupied voxels
  maximum: number;
  data: Data; // one number a voxel, of `type`; uint8: 1 … 255 from minimum to maximum, 0 where there is none; float: NaN there
  categories?: { value: number; name: string; color: string }[]; // values that are names
  signed?: boolean; // colours by the distance from 0
  whole?: boolean; // all values are whole numbers, such as counts: so are the ticks of their bar
}

export interface Volume {
  name: string;
  label: string;
  shape: Vector; // voxels
  first_voxel: Vector; // index of voxel (0, 0, 0) on the world lattice: its corner is first_voxel * voxel_size_m
  voxel_size_m: number;
  occupancy: Data; // uint8, 1 where the voxel holds something: a sample, or a value
  channels: Channel[];
  coarser?: Volume[]; // the same, in larger voxels, to be shown first
  reduced?: string; // why and how much it is coarser than the file's
  exact: boolean; // whether channels hold the file's numbers, not float16
  best_sample?: { index: string }; // samples are kept per voxel: `voxel` answers with a configuration
}

/** Triangles: a surface, a boundary with patches (by colours in the glb), an intersection. */
export interface Mesh { name: string; label: string; geometry: Data; role: "surface" | "refined" | "boundary" | "shared" | "exclusive" | "environment"; color?: string }

/** Points, quantised to the box: uint16 triples from lower to upper. Channel values as of volumes. */
export interface Points { name: string; label: string; count: number; lower: Vector; upper: Vector; positions: Data; channels: Channel[] }

/** Arrows: forces, approach directions. */
export interface Glyphs { name: string; label: string; unit: string; origins: Data; vectors: Data } // float32 triples

export interface Curves { name: string; label: string; closed: boolean; points: Vector[][] }

/** A plane map, such as of placements: painted at z. Axes along world x and y. A click asks `placement`. */
export interface FloorMap { name: string; label: string; T_world: number[]; shape: [number, number]; cell_m: [number, number]; origin_m: [number, number]; channels: Channel[] }

/** Numbers for the plots beside the view; of a histogram x are the middles of its classes. `sets`: what a point's x is of the view, the samples of a robot's volume or the scale of the mapping. */
export interface Plot { name: string; label: string; kind: "histogram" | "curve"; x: { label: string; unit: string; values: Number[] }; y: { label: string; unit: string; values: Number[] }[]; channel?: { volume: string; name: string }; sets?: "samples" | "scale"; robot?: number }

/** A slave's workspace in its master's world: p' = S R p_slave + offset, S the scales along the master's axes. */
export interface Mapping { master: string; slave: string; scale: number | Vector; offset_m: Vector; R: number[]; volumes: { master: string; slave: string } }

export interface Manifest {
  format: 1;
  title: string;
  analysis: string;
  headline: { label: string; value: string }[];
  warnings: string[];
  job: unknown; // the job document
  robots: Robot[];
  skeletons: Skeleton[];
  volumes: Volume[];
  meshes: Mesh[];
  points: Points[];
  glyphs: Glyphs[];
  curves: Curves[];
  maps: FloorMap[];
  plots: Plot[];
  mapping: Mapping | null;
  pictures: { name: string; label: string; url: string }[]; // static ones, shown where WebGL fails
  omitted: string[]; // what was left out, and why
}

/** A robot of the view, as it stands there or as it has been changed since: limits by joint, tool and base as 16 numbers. */
export interface Changed { robot: number; limits?: Record<string, [number, number]>; tool?: number[] | null; placement?: number[] | null }

/** What can be asked of the engine while looking (`wsrender.documents.view_requests`). Answers hold a `header` and, for volumes, blobs. */
export type Request =
  | { ask: "voxel"; volume: string; cell: Vector; voxel_size_m?: number | null } // its exact values and, where kept, the best sampled configuration; the edge that is shown, where it is larger than the file's
  | ({ ask: "indices_at"; q: number[] } & Changed)
  | ({ ask: "inverse"; position_m: Vector; quat_wxyz: number[]; near: number[] } & Changed)
  | ({ ask: "postures"; position_m: Vector; quat_wxyz: number[] } & Changed)
  | { ask: "placement"; map: string; cell: number[] } // where a robot stands for a cell of a map
  | ({ ask: "volume"; index: string; statistic: string; samples: number; voxel_size_m: number | null } & Changed); // null: as of a job that does not say; it is called `live_<robot>` from then on

type Value = { name: string; label: string; unit: string; value: Number };
export interface VoxelAnswer { center_m: Vector; count: number; values: (Value & { statistic: string })[]; q: number[] | null; sample: string | null }
/** Of a pose that is not reached, `q` comes nearest to it (`distance_m`, `angle_rad` are left), or reaches it and is blocked. */
export interface InverseAnswer { label: "reachable" | "unreachable" | "undecided" | "blocked"; reason: string; q: number[]; distance_m: number; angle_rad: number }
/** The configurations of a self-motion in their order, and what blocks each, "" of free ones. */
export interface SelfMotion { closed: boolean; configurations: number[][]; reasons: string[] }
export interface PosturesAnswer { postures: { q: number[]; said: string; curve: SelfMotion | null }[]; families: number; reason: string }
export interface IndicesAnswer { values: Value[]; position_m: Vector; quat_wxyz: number[]; reason: string } // what rejects the configuration, "" if nothing
export interface PlacementAnswer { T_world_base: number[]; at: Record<string, number>; values: Value[] } // coordinates [m, deg]
export interface VolumeAnswer { volume: Volume; samples: number; volume_m3: number; elapsed_s: number } // blobs come with it

export interface Answer { header: unknown; blobs: Record<string, ArrayBuffer> }

export class Refused extends Error {
  constructor(message: string, readonly field = "", readonly code = "") { super(message); }
}

/** Where a view comes from. `ask` of a request that is replaced by a later one of the same kind rejects with AbortError. */
export interface Source {
  readonly home: "served" | "file" | "local" | "widget";
  manifest(): Promise<Manifest>;
  blob(name: string): Promise<ArrayBuffer>;
  /** Absent where there is no engine behind the page: a file. */
  ask?(request: Request): Promise<Answer>;
  /** "lost" and "back": of the server or kernel behind it. */
  onState?(listener: (state: "lost" | "back" | Refused) => void): () => void; // Refused: no question is answered any more, and why
  close?(): void;
}
