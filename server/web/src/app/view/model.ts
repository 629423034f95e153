/** What a viewer knows: the manifest, the settings as one value, and what the engine has answered. */

import { batch, effect, signal, untracked } from "@preact/signals";
import { Refused, type IndicesAnswer, type InverseAnswer, type Manifest, type PlacementAnswer, type PosturesAnswer, type Request, type Robot, type SelfMotion, type Source, type Vector, type Volume, type VolumeAnswer, type VoxelAnswer } from "../../contract";
import { channelKey, defaultSettings, volumeSettings, type Settings, type VolumeSettings } from "../../settings";
import { values as numbersOf } from "../../scene/data";
import { frames, quaternion, tip } from "../../scene/kinematics";
import { Stage, type Camera, type Motion } from "../../scene/stage";
import { message } from "../parts";
import { toolOf } from "./changed_job";
import { restored } from "./restored";

export type Pose = { position_m: Vector; quat_wxyz: [number, number, number, number] };
export interface Live { busy: boolean; said: string; wrong: boolean; volume_m3?: number }

const SAMPLES = 1 << 20; // of a volume that is made while one drags
const STATISTICS = ["maximum", "mean", "minimum"]; // which it may have, beside its count
const COARSE_CELLS = 48; // along its longest edge
const FINE_AFTER_MS = 350;
const INDICES_AFTER_MS = 120;
const STANDS = 1e-3; // of the longest way that a joint goes along a self-motion: it stands still

export class ViewModel {
  readonly manifest = signal<Manifest | null>(null);
  readonly settings = signal<Settings | null>(null);
  readonly camera = signal<Camera | null>(null); // apart from the settings, whose panels need not follow it
  readonly failed = signal(""); // why there is nothing to be seen
  readonly undrawn = signal(""); // why there is nothing in 3-D
  readonly lost = signal(false);
  readonly unanswered = signal(""); // why no question is answered any more
  readonly ready = signal(false); // the volume is there
  readonly voxel = signal<(VoxelAnswer & { rounded?: boolean }) | null>(null);
  readonly said = signal(""); // told to who can't see
  readonly indices = signal<(IndicesAnswer & { robot: number }) | null>(null);
  readonly postures = signal<(PosturesAnswer & { at: number; along: number; robot: number }) | null>(null);
  readonly reach = signal<InverseAnswer | null>(null);
  readonly gizmo = signal<number | null>(null);
  readonly turning = signal(false); // the gizmo turns the tool instead of moving it
  readonly placed = signal<PlacementAnswer["values"] | null>(null); // what a map says where the robot stands
  readonly live = signal<Live | null>(null);
  readonly measuring = signal(false);
  stage: Stage | null = null;
  private added = new Map<string, Volume>(); // beside the manifest's
  private wanted = new Map<number, boolean>(); // robots whose volume is to be computed, and whether in fine voxels
  private followed = new Map<number, { size: number; longest: number } | null>(); // robots of views without a volume that have one now: its fine voxels and longest edge [m]; null: not yet
  private computing = false;
  private fineTimer = 0;
  private indicesTimer = 0;
  private readonly stops: (() => void)[] = [];

  constructor(public source: Source) {}

  get canAsk(): boolean { return Boolean(this.source.ask); }

  /** Reads the manifest, then draws into a host. `link` holds settings other than those that a view begins with. */
  async open(host: HTMLElement, link: unknown): Promise<void> {
    let manifest: Manifest;
    try {
      manifest = await this.source.manifest();
    } catch (error) {
      this.failed.value = message(error);
      return;
    }
    const settings = restored(defaultSettings(manifest), link, manifest);
    batch(() => {
      this.manifest.value = manifest;
      this.settings.value = { ...settings, camera: null };
      this.camera.value = settings.camera;
    });
    try {
      this.stage = new Stage(host);
      await this.stage.load(manifest, (name) => this.source.blob(name));
    } catch (error) {
      this.undrawn.value = message(error);
      return;
    }
    if (!this.stage) return; // closed meanwhile
    this.stage.on("drawn", (how) => { host.dataset.drawn = how; }); // for tests: coarse, fine, finished
    this.follow(this.stage);
    this.ready.value = true;
    const { robots, skeletons, volumes, meshes, points, glyphs, curves, maps } = manifest;
    if (![robots, skeletons, volumes, meshes, points, glyphs, curves, maps].some((each) => each.length)) this.undrawn.value = "This result holds nothing that stands in space.";
    if (settings.selected) void this.select(settings.selected.volume, settings.selected.cell, false);
    manifest.robots.forEach((_, robot) => {
      if (!manifest.volumes.length && settings.volumes[`live_${robot}`]?.visible) this.followVolume(robot);
      else if (this.isComputed(robot)) this.recompute(robot, true);
    });
  }

  /** Shows what another source has, where this one's was: what is edited in a form. */
  async replace(source: Source): Promise<void> {
    const number = ++this.replaced, manifest = await source.manifest();
    if (number !== this.replaced || !this.stage) return;
    await this.stage.load(manifest, (name) => source.blob(name));
    if (number !== this.replaced || !this.stage) return source.close?.();
    this.source.close?.();
    this.source = source;
    clearTimeout(this.fineTimer);
    clearTimeout(this.indicesTimer);
    this.added.clear();
    this.wanted.clear();
    this.followed.clear();
    batch(() => {
      this.live.value = this.voxel.value = this.postures.value = this.indices.value = this.placed.value = null;
      this.lost.value = false;
      this.unanswered.value = "";
      this.manifest.value = manifest;
      this.settings.value = { ...defaultSettings(manifest), theme: this.settings.value!.theme };
      this.camera.value = null;
      this.setGizmo(null);
    });
    this.watchSource();
  }
  private replaced = 0;

  private follow(stage: Stage): void {
    this.stops.push(
      stage.on("pick", (pick) => {
        if (!pick) return;
        if (this.measuring.value) this.measure(pick.point_m);
        else if (pick.kind === "map") void this.place(pick.name, pick.cell);
        else if (pick.kind === "mesh") this.said.value = pick.patch; // what its faces are called
        else if (pick.kind === "volume") void this.select(pick.name, pick.cell, true);
      }),
      stage.on("camera", (camera) => { this.camera.value = camera; }),
      stage.on("lost", (state) => { this.undrawn.value = state === "lost" ? "The browser has taken the 3-D graphics away." : ""; }),
      stage.on("problem", (problem) => { this.said.value = problem; }),
      stage.on("gizmo", ({ robot, T }) => void this.reachFor(robot, { position_m: [T[3]!, T[7]!, T[11]!], quat_wxyz: quaternion(T) })),
      effect(() => {
        const settings = this.settings.value;
        if (settings) untracked(() => stage.apply({ ...settings, camera: this.camera.value }));
      }),
    );
    let drawn: unknown[] = [];
    this.stops.push(effect(() => {
      const found = this.postures.value, now = [found?.postures, found?.at];
      if (now.every((each, i) => each === drawn[i])) return;
      drawn = now;
      untracked(() => stage.setMotions(found ? this.motions(found.robot, found.postures.map((each) => each.curve), found.at) : []));
    }));
    this.watchSource();
  }

  private watchSource(): void {
    if (this.canAsk && this.source.onState) this.stops.push(this.source.onState((state) => batch(() => {
      this.lost.value = state === "lost";
      if (state !== "lost") this.unanswered.value = state === "back" ? "" : state.message;
    })));
  }

  close(): void {
    for (const stop of this.stops) stop();
    clearTimeout(this.fineTimer);
    clearTimeout(this.indicesTimer);
    this.stage?.dispose();
    this.stage = null;
    this.source.close?.();
  }

  // ---- settings

  update(patch: Partial<Settings>): void {
    if (this.settings.value) this.settings.value = { ...this.settings.value, ...patch };
  }

  setVolume(name: string, patch: Partial<VolumeSettings>): void {
    const { volumes } = this.settings.value!;
    this.update({ volumes: { ...volumes, [name]: { ...volumes[name]!, ...patch } } });
  }

  reset(): void {
    const manifest = this.manifest.value!;
    batch(() => {
      this.settings.value = { ...defaultSettings(manifest), theme: this.settings.value!.theme };
      this.stage?.fit();
      this.live.value = this.voxel.value = this.postures.value = null;
      this.followed.clear();
      this.setGizmo(null);
    });
  }

  /** All that a link holds. */
  whole(): Settings { return { ...this.settings.value!, camera: this.camera.value }; }

  look(camera: Camera): void {
    this.camera.value = camera;
    this.stage?.apply(this.whole());
  }

  volume(name: string): Volume | undefined { return this.added.get(name) ?? this.manifest.value?.volumes.find((each) => each.name === name); }

  get volumes(): Volume[] { return [...(this.manifest.value?.volumes ?? []).filter((each) => !this.added.has(each.name)), ...this.added.values()]; }

  /** The volume that the panel is about: the first that is seen. */
  get shown(): Volume | undefined {
    const settings = this.settings.value;
    return this.volumes.findLast((each) => settings?.volumes[each.name]?.visible) ?? this.volumes[0];
  }

  /** Draws another volume beside those of the manifest, or in the place of one of its name. */
  async add(volume: Volume, blobs: Record<string, ArrayBuffer>, settings: Partial<VolumeSettings>): Promise<void> {
    this.added.set(volume.name, volume);
    await this.stage?.replaceVolume(volume, blobs);
    this.setVolume(volume.name, settings);
  }

  // ---- voxels

  async select(name: string, cell: Vector, moves: boolean): Promise<void> {
    this.update({ selected: { volume: name, cell } });
    this.postures.value = null;
    try {
      const found = this.source.ask ? await this.exact(name, cell) : await this.held(name, cell);
      this.voxel.value = found;
      this.said.value = `Voxel at ${found.center_m.map((each) => each.toFixed(3)).join(", ")} metres.`;
      if (moves && found.q && this.manifest.value!.robots.length) this.setConfiguration(0, found.q);
    } catch (error) {
      if ((error as Error).name !== "AbortError") this.voxel.value = null;
      this.tell(error);
    }
  }

  /** The file's own values; where nothing answers, or does any more, those of the picture, which is said. */
  private async exact(name: string, cell: Vector): Promise<VoxelAnswer> {
    try {
      return (await this.ask({ ask: "voxel", volume: name, cell, voxel_size_m: this.volume(name)?.voxel_size_m } as Request)) as VoxelAnswer;
    } catch (error) {
      if (!(error instanceof Refused) || !(error.code === "lost" || this.unanswered.value) || this.added.has(name)) throw error;
      return this.held(name, cell, this.stage?.valuesAt(name, cell));
    }
  }

  /** What a file, or the picture, holds of a voxel: its channels, rounded as they are there. */
  private async held(name: string, [i, j, k]: Vector, here?: Map<string, number>): Promise<VoxelAnswer & { rounded: boolean }> {
    const volume = this.volume(name)!, [nx, ny] = volume.shape, at = i + nx * (j + ny * k);
    const found = [];
    for (const channel of volume.channels) {
      const value = here ? here.get(channelKey(channel)) : (await numbersOf(channel, (blob) => this.source.blob(blob)))[at]!;
      if (value !== undefined) found.push({ name: channel.name, statistic: channel.statistic, label: channel.label, unit: channel.unit, value: Number.isFinite(value) ? value : null });
    }
    const center = [i, j, k].map((each, axis) => (volume.first_voxel[axis]! + each + 0.5) * volume.voxel_size_m) as Vector;
    return { center_m: center, count: found.find((each) => each.statistic === "count")?.value ?? NaN, values: found, q: null, sample: null, rounded: !volume.exact };
  }

  /** The voxel of the shown volume that holds a point. */
  async selectAt(point: Vector): Promise<void> {
    const volume = this.shown;
    if (!volume) return;
    const cell = point.map((each, k) => Math.floor(each / volume.voxel_size_m) - volume.first_voxel[k]!) as Vector;
    if (cell.every((each, k) => each >= 0 && each < volume.shape[k]!)) await this.select(volume.name, cell, true);
    else this.said.value = "This place is outside the volume.";
  }

  private measure(point: Vector): void {
    const { measure } = this.settings.value!;
    this.update({ measure: measure.length === 2 ? [point] : [...measure, point] });
  }

  // ---- robots

  robot(number: number): Robot { return this.manifest.value!.robots[number]!; }

  /** `same`: of the postures that are listed, or along one's self-motion; of another the list is of no use. */
  setConfiguration(robot: number, q: number[], same = false): void {
    if (!same) this.postures.value = null;
    const configurations = this.settings.value!.configurations.slice();
    configurations[robot] = q;
    this.update({ configurations });
    clearTimeout(this.indicesTimer);
    if (this.source.ask) this.indicesTimer = window.setTimeout(() => void this.askIndices(robot), INDICES_AFTER_MS);
  }

  /** What was said before is of another configuration. */
  moveByHand(robot: number, q: number[]): void {
    batch(() => {
      this.said.value = "";
      this.setConfiguration(robot, q);
    });
  }

  /** Limits, tool and placement as they have been dragged; the tool in the tip's frame, as the engine has it. */
  changes(robot: number): { limits: Record<string, [number, number]>; tool?: number[]; placement?: number[] } {
    const settings = this.settings.value!, tip = settings.tools[robot], placement = settings.placements[robot];
    const tool = tip ? toolOf(this.robot(robot).chain, tip) : null;
    return { limits: settings.limits[robot] ?? {}, ...(tool ? { tool } : {}), ...(placement ? { placement } : {}) };
  }

  isChanged(robot: number): boolean {
    const { limits, tool, placement } = this.changes(robot);
    return Object.keys(limits).length > 0 || Boolean(tool ?? placement);
  }

  /** Whether its volume is another than the file's. */
  private isComputed(robot: number): boolean { return this.isChanged(robot) || this.settings.value!.samples[robot] != null; }

  private async askIndices(robot: number): Promise<void> {
    try {
      const found = (await this.ask({ ask: "indices_at", robot, q: this.settings.value!.configurations[robot]!, ...this.changes(robot) } as Request)) as IndicesAnswer;
      this.indices.value = { ...found, robot };
    } catch (error) {
      if ((error as Error).name !== "AbortError") this.indices.value = null;
    }
  }

  /** In the world, 16 numbers. */
  frameOfTip(robot: number): Float64Array {
    const { configurations, placements, tools } = this.settings.value!, { chain, home } = this.robot(robot);
    return tip(chain, configurations[robot] ?? home, { T_base: placements[robot] ?? null, T_tip: tools[robot] ?? null });
  }

  tip(robot: number): Pose {
    const T = this.frameOfTip(robot);
    return { position_m: [T[3]!, T[7]!, T[11]!], quat_wxyz: quaternion(T) };
  }

  setGizmo(robot: number | null): void {
    this.gizmo.value = robot;
    this.setReach(null);
    this.stage?.setGizmo(robot, this.turning.value ? "rotate" : "translate");
  }

  private setReach(found: InverseAnswer | null): void {
    this.reach.value = found;
    this.stage?.setReach(found?.label ?? null);
  }

  /** The nearest configuration of a pose, or why there is none: asked one at a time, the last one wins. */
  private pending: { robot: number; pose: Pose } | null = null;
  private asking = false;
  async reachFor(robot: number, pose: Pose): Promise<void> {
    this.pending = { robot, pose };
    if (this.asking) return;
    this.asking = true;
    while (this.pending) {
      const { robot: number, pose: wanted } = this.pending;
      this.pending = null;
      try {
        const near = this.settings.value!.configurations[number]!;
        const found = (await this.ask({ ask: "inverse", robot: number, ...wanted, near, ...this.changes(number) } as Request)) as InverseAnswer;
        batch(() => {
          if (found.q) this.setConfiguration(number, found.q);
          this.setReach(found);
          this.said.value = found.label === "reachable" ? "Reachable." : `${found.label}: ${found.reason}`;
        });
      } catch (error) {
        this.tell(error);
      }
    }
    this.asking = false;
  }

  async askPostures(robot: number): Promise<void> {
    try {
      const found = (await this.ask({ ask: "postures", robot, ...this.tip(robot), ...this.changes(robot) } as Request)) as PosturesAnswer;
      this.postures.value = { ...found, at: -1, along: 0, robot };
      if (found.postures.length) this.stepPosture(1);
    } catch (error) {
      this.tell(error);
    }
  }

  stepPosture(by: number): void {
    const found = this.postures.value;
    if (!found?.postures.length) return;
    const at = (found.at + by + found.postures.length) % found.postures.length;
    const { q, curve } = found.postures[at]!, apart = (curve?.configurations ?? []).map((each) => Math.hypot(...each.map((value, k) => value - q[k]!)));
    this.postures.value = { ...found, at, along: apart.indexOf(Math.min(...apart)) };
    this.setConfiguration(found.robot, q, true);
    this.said.value = `Posture ${at + 1} of ${found.postures.length}.`;
  }

  /** To a point of the self-motion of the posture that is shown. */
  stepAlong(along: number): void {
    const found = this.postures.value, q = found?.postures[found.at]?.curve?.configurations[along];
    if (!found || !q) return;
    this.postures.value = { ...found, along };
    this.setConfiguration(found.robot, q, true);
  }

  /** The ways of the joints along self-motions while the tip stands: of each those that move. */
  private motions(robot: number, curves: (SelfMotion | null)[], chosen: number): Motion[] {
    const { placements, tools } = this.settings.value!, { chain } = this.robot(robot);
    return curves.flatMap((curve, i) => {
      if (!curve) return [];
      const at = curve.configurations.map((q) => frames(chain, q, { T_base: placements[robot] ?? null, T_tip: tools[robot] ?? null }).slice(1, -1).map((T): Vector => [T[3]!, T[7]!, T[11]!]));
      const ways = at[0]!.map((_, joint) => at.map((each) => each[joint]!));
      const long = ways.map((way) => Math.max(...[0, 1, 2].map((k) => Math.max(...way.map((p) => p[k]!)) - Math.min(...way.map((p) => p[k]!)))));
      return ways.filter((_, joint) => long[joint]! > STANDS * Math.max(...long)).map((points) => ({ points, closed: curve.closed, chosen: i === chosen }));
    });
  }

  /** A robot stands where a cell of a map says. */
  async place(map: string, cell: number[]): Promise<void> {
    try {
      const found = (await this.ask({ ask: "placement", map, cell } as Request)) as PlacementAnswer;
      const placements = this.settings.value!.placements.slice();
      placements[0] = found.T_world_base;
      this.update({ placements });
      this.postures.value = null;
      this.placed.value = found.values;
      this.said.value = "The robot stands there.";
    } catch (error) {
      this.tell(error);
    }
  }

  // ---- what is dragged

  setLimits(robot: number, joint: string, range: [number, number] | null): void {
    const limits = this.settings.value!.limits.slice(), own = { ...(limits[robot] ?? {}) };
    if (range) own[joint] = range;
    else delete own[joint];
    limits[robot] = own;
    this.dragged(robot, { limits });
  }

  private dragged(robot: number, patch: Partial<Settings>): void {
    this.update(patch);
    this.postures.value = null;
    this.recompute(robot, false);
  }

  setTool(robot: number, tool: number[] | null): void {
    const tools = this.settings.value!.tools.slice();
    tools[robot] = tool;
    this.dragged(robot, { tools });
  }

  setPlacement(robot: number, placement: number[] | null): void {
    const placements = this.settings.value!.placements.slice();
    placements[robot] = placement;
    this.dragged(robot, { placements });
  }

  /** The volume of so many samples; null: as the file has it. */
  setSamples(robot: number, count: number | null): void {
    this.update({ samples: this.settings.value!.samples.map((each, i) => (i === robot ? count : each)) });
    this.recompute(robot, true);
  }

  /** Whether the volume of a robot is there, to follow what is dragged. */
  isFollowed(robot: number): boolean { return this.followed.has(robot) || Boolean(this.manifest.value?.volumes.length); }

  /** Shows the volume of a robot whose view has none. */
  followVolume(robot: number): void {
    this.followed.set(robot, null);
    this.recompute(robot, true);
  }

  /** The volume of what was dragged: in large voxels while one drags, then in those of the file. */
  recompute(robot: number, fine: boolean): void {
    if (!this.source.ask || !this.isFollowed(robot)) return;
    if (!this.isComputed(robot) && !this.followed.has(robot)) return this.unchanged(robot);
    clearTimeout(this.fineTimer);
    if (!fine) this.fineTimer = window.setTimeout(() => this.recompute(robot, true), FINE_AFTER_MS);
    this.wanted.set(robot, fine);
    if (!this.computing) void this.pump();
  }

  private async pump(): Promise<void> { // one at a time: one that is replaced at every event would never be seen
    this.computing = true;
    for (const [robot, fine] of this.wanted) { // what is set meanwhile comes at the end
      this.wanted.delete(robot);
      await this.compute(robot, fine);
    }
    this.computing = false;
  }

  private async compute(robot: number, fine: boolean): Promise<void> {
    const manifest = this.manifest.value!, file = manifest.volumes[0], settings = this.settings.value!, name = `live_${robot}`;
    const own = settings.volumes[name] ?? (file && settings.volumes[file.name]!), channels = [own?.channel ?? "", ...(file?.channels ?? []).map(channelKey), "maximum:manipulability"];
    const [statistic = "", index = ""] = channels.map((each) => each.split(/:(.*)/s)).find(([each]) => STATISTICS.includes(each!))!;
    const sized = (volume: Volume) => ({ size: volume.voxel_size_m, longest: Math.max(...volume.shape) * volume.voxel_size_m });
    const known = file ? sized(file) : this.followed.get(robot);
    this.live.value = { busy: true, said: this.live.value?.said ?? "", wrong: false };
    try {
      const { header, blobs } = await this.source.ask!({
        ask: "volume", robot, index, statistic, samples: settings.samples[robot] ?? SAMPLES,
        voxel_size_m: !known ? null : fine ? known.size : Math.max(known.size, known.longest / COARSE_CELLS), ...this.changes(robot),
      });
      if (manifest !== this.manifest.value) return;
      const found = header as VolumeAnswer, first = !this.added.has(found.volume.name);
      if (file && !this.isComputed(robot)) return;
      if (!file && !known) this.followed.set(robot, sized(found.volume));
      const channel = found.volume.channels[0], label = !this.isChanged(robot) ? (settings.samples[robot] ? `Of ${found.samples.toLocaleString("en")} samples` : "Workspace") : manifest.robots.length > 1 ? `${this.robot(robot).name}, as it was changed` : "As it was changed";
      const shown = { ...(own ?? volumeSettings(found.volume, manifest)), visible: true, channel: channel ? channelKey(channel) : "", minus: "" };
      batch(() => {
        void this.add({ ...found.volume, label }, blobs, first ? shown : { channel: shown.channel }).then(() => { if (first && !file && !this.camera.value) this.stage?.fit(); });
        if (file && first && !settings.volumes[name]?.visible) this.setVolume(file.name, { visible: false });
        this.live.value = { busy: false, wrong: false, volume_m3: found.volume_m3, said: `${found.volume_m3.toPrecision(4)} m³ of ${found.samples.toLocaleString("en")} samples, ${Math.round(1000 * found.elapsed_s)} ms` };
      });
    } catch (error) {
      if ((error as Error).name !== "AbortError") this.live.value = { busy: false, said: message(error), wrong: true };
    }
  }

  /** Back to what the file has. */
  private unchanged(robot: number): void {
    clearTimeout(this.fineTimer);
    this.wanted.delete(robot);
    const name = `live_${robot}`, file = this.manifest.value!.volumes[0]!;
    if (this.settings.value!.volumes[name]) this.setVolume(name, { visible: false });
    this.setVolume(file.name, { visible: true });
    this.added.delete(name);
    this.live.value = null;
  }

  forget(robot: number): void {
    const settings = this.settings.value!;
    const without = <T>(list: T[], none: T) => list.map((each, i) => (i === robot ? none : each));
    this.update({ limits: without(settings.limits, {}), tools: without(settings.tools, null), placements: without(settings.placements, null), samples: without(settings.samples, null) });
    this.postures.value = null;
    this.recompute(robot, true);
  }

  // ---- asking

  private async ask(request: Request): Promise<unknown> {
    if (!this.source.ask) throw new Refused("There is no engine behind a file.");
    return (await this.source.ask(request)).header;
  }

  private tell(error: unknown): void {
    if ((error as Error).name !== "AbortError") this.said.value = message(error);
  }
}
