/** Everything that is drawn in 3-D: opaque things with depth, then rays through the volumes at a share of the resolution, then all in one picture. */

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Front, type Moved } from "./front";
import type { Manifest, Vector, Volume } from "../contract";
import { defaultSettings, type Settings, type VolumeSettings } from "../settings";
import { AxesBox, INKS, write, type Ink } from "./annotations";
import { scaleOf, type ColorScale } from "./colors";
import type { Blob_ } from "./data";
import { curves, glyphs, MeshLayer, PaintedMap, segmentsOf, skeleton, type Drawn } from "./layers";
import { LINES, lines } from "./lines";
import { free } from "./glb";
import { RobotBody } from "./robot";
import * as glsl from "./shaders";
import { PointLayer, Splats, type Cloud } from "./splat";
import { VolumeBody } from "./volume";
import { VolumeData } from "./volume_data";

THREE.ColorManagement.enabled = false; // what a shader writes is what the screen shows, so that colours can be compared with values

/** The browser offers no WebGL 2: show pictures instead. */
export class NoGraphics extends Error {
  constructor() { super("This browser shows no 3-D graphics (WebGL 2)."); }
}

export type Pick =
  | { kind: "volume"; name: string; cell: Vector; center_m: Vector; point_m: Vector; value: number; unit: string }
  | { kind: "robot"; robot: number; link: string; point_m: Vector }
  | { kind: "map"; name: string; cell: [number, number]; point_m: Vector; value: number; unit: string }
  | { kind: "points"; name: string; number: number; point_m: Vector }
  | { kind: "mesh"; name: string; patch: string; point_m: Vector };

/** The way of a joint while the tip stands. */
export interface Motion { points: Vector[]; closed: boolean; chosen: boolean }

export type Camera = NonNullable<Settings["camera"]>;
export interface Events {
  pick: Pick | null;
  camera: Camera; // moved by hand
  gizmo: Moved; // dragged by hand
  drawn: "coarse" | "fine" | "finished";
  lost: "lost" | "back"; // the graphics of the page
  problem: string; // something could not be shown
}

/** Pixels x … x + width of a whole picture; ratio: pixels of a CSS pixel. */
interface Part { x: number; y: number; width: number; height: number; of: { width: number; height: number }; ratio: number }

const MOST_PIXELS = 8192, TILE = 1024;
const LEAST_TILE = 100_000; // pixels: smaller ones would wait for the page longer than they draw
const PASSES = 4, BUDGET_MS = 45, REST_MS = 180, FOV = 32;
const QUICK_MS = 55, LEAST_SHARE = 0.2, LONGEST_STRIDE = 5; // while something moves: a frame; of the resolution; voxels between two looks
const STRIDE = 1.3;
const SHIFTS = [[0.125, 0.375], [-0.375, 0.125], [0.375, -0.125], [-0.125, -0.375]] as const; // of a pixel, rotated grid

const vector = (v: THREE.Vector3): Vector => [v.x, v.y, v.z];

export class Stage {
  readonly canvas = document.createElement("canvas");
  private overlay = document.createElement("canvas");
  private renderer: THREE.WebGLRenderer;
  private gl: WebGL2RenderingContext;
  private scene = new THREE.Scene();
  private eye = new THREE.PerspectiveCamera(FOV, 1, 0.01, 100); // what the hand moves
  private flat = new THREE.OrthographicCamera(); // looks from the same place
  private controls: OrbitControls;
  private sun = new THREE.DirectionalLight(0xffffff, 2.3);
  private axes = new AxesBox();
  private sheets = new THREE.Group();
  private motions = new THREE.Group();
  private screen = new THREE.Mesh(new THREE.PlaneGeometry(2, 2));
  private screenScene = new THREE.Scene();
  private screenCamera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
  private opaque = new THREE.WebGLRenderTarget(1, 1, { samples: 4, depthTexture: new THREE.DepthTexture(1, 1, THREE.UnsignedIntType) });
  private solid = new THREE.WebGLRenderTarget(1, 1, { depthTexture: new THREE.DepthTexture(1, 1, THREE.UnsignedIntType) });
  private cloud = new THREE.WebGLRenderTarget(1, 1, { depthBuffer: false });
  private sum = new THREE.WebGLRenderTarget(1, 1, { depthBuffer: false, type: THREE.HalfFloatType });
  private frontal = new THREE.WebGLRenderTarget(1, 1, { samples: 4 });
  private front!: Front;
  private nothing = new THREE.DataTexture(new Uint8Array(4), 1, 1);
  private farthest = new THREE.DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
  private composeMaterial = material(glsl.compose, { scene: { value: null }, solid: { value: null }, cloud: { value: null }, front: { value: this.nothing }, weight: { value: 1 } });
  private copyMaterial = material(glsl.copy, { picture: { value: null }, front: { value: this.nothing } });

  private manifest: Manifest | null = null;
  private settings: Settings | null = null;
  private drawn = ""; // that was asked to be drawn
  private volumes = new Map<string, VolumeData>();
  private robots: RobotBody[] = [];
  private layers: Drawn[] = [];
  private points: PointLayer[] = [];
  private splats = new Splats();
  private bounds = new THREE.Box3();
  private bars: ColorScale[] = [];
  private ink: Ink = INKS.light;

  private listeners = new Map<keyof Events, Set<(value: never) => void>>();
  private undo: (() => void)[] = [];
  private disposed = false;
  private loads = 0;

  private asked = false;
  private dirty = true;
  private frontDirty = false;
  private exporting = 0;
  private later = 0;
  private pass = 0;
  private row = 0; // of the fine picture, 0 … 1
  private tiles = 1;
  private fence: WebGLSync | null = null;
  private timed: "quick" | "tile" | null = null;
  private sent = 0;
  private effort = 0.25; // while something moves: work of the rays, of that for every pixel; followed by what frames take
  private count = { frames: 0, milliseconds: 0 };

  constructor(readonly host: HTMLElement) {
    const gl = this.canvas.getContext("webgl2", { antialias: false, alpha: false, powerPreference: "high-performance" });
    if (!gl) throw new NoGraphics();
    this.gl = gl;
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, context: gl });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.autoClear = false;
    for (const canvas of [this.canvas, this.overlay]) Object.assign(canvas.style, { position: "absolute", inset: "0", width: "100%", height: "100%", display: "block" });
    if (getComputedStyle(host).position === "static") host.style.position = "relative";
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "application");
    this.canvas.setAttribute("aria-label", "3-D view: arrow keys turn, shift and arrow keys shift, plus and minus zoom, Home shows all");
    this.canvas.style.touchAction = "none";
    this.overlay.style.pointerEvents = "none";
    this.overlay.setAttribute("aria-hidden", "true");
    host.append(this.canvas, this.overlay);

    for (const t of [this.nothing, this.farthest]) t.needsUpdate = true;
    this.screen.frustumCulled = false;
    this.screenScene.add(this.screen);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x949fab, 2.2), this.sun, this.sun.target, this.axes, this.sheets, this.motions, this.splats.object);
    this.eye.up.set(0, 0, 1);
    this.eye.position.set(2, -3, 1.5);
    this.controls = new OrbitControls(this.eye, this.canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("start", () => { this.fits = null; });
    this.controls.addEventListener("change", () => { this.ask(); this.emit("camera", this.camera); });
    this.front = new Front(this.canvas, this.controls, () => this.askFront(), (moved) => this.emit("gizmo", moved));
    this.listen(this.canvas, "webglcontextlost", (e) => { e.preventDefault(); this.fence = null; this.emit("lost", "lost"); });
    this.listen(this.canvas, "webglcontextrestored", () => { this.fence = null; this.emit("lost", "back"); this.ask(); });
    this.listen(this.canvas, "keydown", (e) => this.key(e as KeyboardEvent));
    this.clicks();
    const dark = matchMedia("(prefers-color-scheme: dark)"), theme = () => { this.theme(); this.ask(); };
    dark.addEventListener("change", theme);
    this.undo.push(() => dark.removeEventListener("change", theme));
    const observer = new ResizeObserver(() => this.resize());
    observer.observe(host);
    this.undo.push(() => observer.disconnect());
    this.resize();
  }

  // ---- what is shown

  async load(manifest: Manifest, blob: Blob_): Promise<void> {
    const load = ++this.loads;
    this.clear();
    this.manifest = manifest;
    for (const volume of manifest.volumes) this.volumes.set(volume.name, new VolumeData(volume, blob));
    this.robots = manifest.robots.map((robot, i) => new RobotBody(robot, i));
    const robots = this.robots, again = () => { this.rescale(); this.ask(); };
    this.points = manifest.points.map((points) => new PointLayer(points, blob, again));
    const meshes = manifest.meshes.map((each) => new MeshLayer(each, blob, (problem) => this.shownLater(problem))), hidden = defaultSettings(manifest).layers;
    const layers = await Promise.all([
      ...robots.map(async (robot) => { await robot.load(blob); }),
      ...meshes.map(async (each) => { if (hidden[each.key]?.visible ?? true) await each.load(); return each; }),
      ...manifest.maps.map((map) => new PaintedMap(map, blob, again)),
      ...manifest.skeletons.map(skeleton),
      ...manifest.curves.map(curves),
    ]).then((all) => all.filter((each): each is Drawn => !!each));
    if (load !== this.loads || this.disposed) { for (const each of [...robots, ...layers]) each.dispose(); return; }
    this.layers = layers;
    for (const object of [...robots, ...layers.map((layer) => layer.object)]) this.scene.add(object);
    this.settings = null;
    this.drawn = "";
    this.measureBounds();
    const span = this.bounds.getSize(new THREE.Vector3()).length() / Math.sqrt(3);
    for (const each of manifest.glyphs) {
      const arrows = await glyphs(each, blob, span);
      if (load !== this.loads || this.disposed) { arrows.dispose(); return; }
      this.layers.push(arrows);
      this.scene.add(arrows.object);
    }
    this.measureBounds();
    this.fit();
  }

  /** Draws settings; what they need and is not here yet is fetched, and drawn when it comes. */
  apply(settings: Settings): void {
    this.settings = settings;
    this.theme();
    for (const robot of this.robots) {
      const layer = settings.layers[`robot:${robot.index}`];
      robot.changed = this.changed(robot.index, settings);
      robot.pose(settings.configurations[robot.index] ?? robot.q);
      robot.show(layer?.visible ?? true, layer?.opacity ?? 1);
      robot.frames.visible = settings.layers.frames?.visible ?? false;
    }
    this.followTip();
    for (const [name, data] of this.volumes) {
      const wanted = settings.volumes[name];
      const mapped = Object.values(this.manifest?.mapping?.volumes ?? {}).includes(name);
      if (wanted && (wanted.visible || mapped || settings.slices.some((s) => s.visible))) this.need(data, wanted);
    }
    this.rescale();
    if (settings.camera && !same(settings.camera, this.camera)) this.look(settings.camera);
    this.select();
    const look = JSON.stringify({ ...settings, limits: null, samples: null }); // of them nothing is drawn: the volume that follows needs the cores
    if (look !== this.drawn) this.ask();
    this.drawn = look;
  }

  private select(): void {
    const selected = this.settings?.selected, body = selected && this.volumes.get(selected.volume)?.body;
    this.front.mark(selected && body?.lattice ? { at: body.center(selected.cell), size: body.lattice.size, place: body.place } : null, this.ink.accent);
  }

  /** A volume in place of the one of its name, such as one computed with other limits. */
  async replaceVolume(volume: Volume, blobs: Record<string, ArrayBuffer>): Promise<void> {
    const blob: Blob_ = async (name) => blobs[name] ?? Promise.reject(new Error(`the answer lacks blob "${name}"`));
    const old = this.volumes.get(volume.name), data = new VolumeData(volume, blob, old);
    this.volumes.set(volume.name, data);
    const wanted = this.settings?.volumes[volume.name];
    if (!wanted) return;
    await data.get(wanted, this.minus(wanted));
    if (this.volumes.get(volume.name) === data) this.ready(data);
  }

  /** A gizmo at a robot's tip, to be dragged and turned by hand: event "gizmo"; null: none. */
  setGizmo(robot: number | null, mode: "translate" | "rotate" = "translate"): void {
    const body = robot === null ? null : this.robots[robot];
    this.front.attach(body ? { robot: body.index, T: body.tip(), size: body.size } : null, mode);
    this.askFront();
  }

  /** What is known of the place where the gizmo stands. */
  setReach(state: "reachable" | "unreachable" | "undecided" | "blocked" | null): void {
    this.front.tell(state);
    this.askFront();
  }

  /** Draws the ways of joints, of one self-motion more strongly; in place of those before. */
  setMotions(motions: readonly Motion[]): void {
    if (!motions.length && !this.motions.children.length) return;
    this.freeMotions();
    for (const chosen of [false, true]) {
      const segments = motions.filter((each) => each.chosen === chosen).flatMap((each) => segmentsOf(each.points, each.closed));
      if (!segments.length) continue;
      const drawn = lines(segments, chosen ? 0xd55e00 : 0x8a96a3, chosen ? 3 : 1.2);
      drawn.material.depthTest = !chosen; // the robot's bodies would hide it
      drawn.renderOrder = chosen ? 1 : 0;
      this.motions.add(drawn);
    }
    this.ask();
  }

  private freeMotions(): void {
    for (const each of [...this.motions.children]) free(each);
  }

  /** The gizmo goes with the tip, but while it is dragged. */
  private followTip(): void {
    const body = this.front.robot === null ? null : this.robots[this.front.robot];
    if (body) this.front.follow(body.tip());
  }

  /** A mesh that was hidden at first is there, or could not be had. */
  private shownLater(problem?: unknown): void {
    if (this.disposed) return;
    if (problem) return this.emit("problem", problem instanceof Error ? problem.message : `${problem}`);
    this.rescale();
    this.measureBounds();
    this.ask();
  }

  private changed(robot: number, settings: Settings) {
    return { T_base: settings.placements[robot] ?? null, T_tip: settings.tools[robot] ?? null };
  }

  /** What is here of a volume's voxel: values by channel. */
  valuesAt(name: string, cell: Vector): Map<string, number> { return this.volumes.get(name)?.valuesAt(cell) ?? new Map(); }

  private minus(wanted: VolumeSettings): VolumeData | null { return (wanted.minus && this.volumes.get(wanted.minus)) || null; }

  private need(data: VolumeData, wanted: VolumeSettings): void {
    const minus = this.minus(wanted);
    if (data.has(wanted, minus)) return;
    data.get(wanted, minus, () => this.ready(data, true)).then(() => this.ready(data, true), (e: unknown) => this.emit("problem", e instanceof Error ? e.message : `${e}`));
  }

  /** `wider`: all is shown again where the volume goes beyond what was shown, and the eye has not been moved. */
  private ready(data: VolumeData, wider = false): void {
    if (this.disposed || !this.settings || this.volumes.get(data.volume.name) !== data) return;
    const first = this.bounds.isEmpty() || !this.fitted, before = this.bounds.clone();
    this.rescale();
    this.measureBounds();
    if ((first || (wider && this.fits && !before.containsBox(this.bounds))) && !this.settings.camera) this.fit(this.fits ?? undefined);
    this.select();
    this.ask();
  }

  /** Bodies and colour bars as the settings say, of what is here. */
  private rescale(): void {
    const settings = this.settings;
    if (!settings) return;
    this.bars = [];
    let first = true;
    const addBar = (scale: ColorScale) => { if (!this.bars.some((bar) => bar.title === scale.title)) this.bars.push(scale); };
    for (const [name, data] of this.volumes) {
      const wanted = settings.volumes[name];
      if (!wanted) continue;
      const found = data.has(wanted, this.minus(wanted)) ?? data.preview;
      if (!found) continue;
      const { lattice, channel, whole, inner } = found;
      const scale = channel ? scaleOf(channel, whole, inner, first && this.isSeen(name) ? settings.range : null, settings.colors) : null;
      data.body.set(lattice, wanted, scale);
      if (this.manifest?.mapping?.volumes.slave === name) this.placeSlave(data.body, this.manifest.mapping);
      if (this.isSeen(name) && scale && !Object.values(this.manifest?.mapping?.volumes ?? {}).includes(name)) { // which are green and red
        first = false;
        addBar(scale);
      }
    }
    const span = this.bounds.getSize(new THREE.Vector3()).length() / Math.sqrt(3);
    for (const points of this.points) {
      points.set(settings, first, span);
      if (points.cloud && points.scale) { first &&= Boolean(points.scale.categories); addBar(points.scale); }
    }
    for (const layer of this.layers) {
      layer.object.visible = settings.layers[layer.key]?.visible ?? layer.shown;
      layer.set?.(settings, first);
      if (layer.object.visible && layer.scale) { first &&= Boolean(layer.scale.categories); addBar(layer.scale); }
    }
  }

  /** slave' = S R slave + offset in the master's world: green where it lies inside the master's volume, red elsewhere. */
  private placeSlave(slave: VolumeBody, { volumes, R, scale, offset_m }: NonNullable<Manifest["mapping"]>): void {
    const live = this.settings?.mapping, [sx, sy, sz] = axes(live?.scale ?? scale), master = this.volumes.get(volumes.master)?.body;
    const turn = new THREE.Matrix4().set(R[0]!, R[1]!, R[2]!, 0, R[3]!, R[4]!, R[5]!, 0, R[6]!, R[7]!, R[8]!, 0, 0, 0, 0, 1);
    slave.place.makeScale(sx, sy, sz).multiply(turn).setPosition(...(live?.offset_m ?? offset_m));
    slave.within(master?.lattice ? master : null);
  }

  private get bodies(): VolumeBody[] {
    return this.shownBodies.filter((body) => body.settings.style !== "points");
  }
  private get shownBodies(): VolumeBody[] {
    return [...this.volumes].filter(([name, data]) => this.settings?.volumes[name]?.visible && data.body.lattice).map(([, data]) => data.body);
  }

  /** Itself, or its slices: where no volume is shown those of the first are. */
  private isSeen(name: string): boolean {
    const { volumes, slices } = this.settings!, shown = (each: string) => volumes[each]?.visible ?? true;
    return shown(name) || (slices.some((s) => s.visible) && ![...this.volumes.keys()].some(shown) && name === this.volumes.keys().next().value);
  }

  private fitted = false;
  private fits: Vector | null = null; // the direction from which all is shown, until the eye is moved
  private measureBounds(): void {
    this.bounds.makeEmpty();
    for (const [name, data] of this.volumes) if (data.body.lattice && (!this.settings || this.isSeen(name))) this.bounds.union(data.body.box());
    for (const robot of this.robots) {
      robot.updateMatrixWorld();
      this.bounds.union(robot.box());
    }
    for (const points of this.points) if (this.settings?.layers[points.key]?.visible ?? true) this.bounds.union(points.box);
    for (const layer of this.layers) if (layer.object.visible) this.bounds.expandByObject(layer.object);
    if (this.bounds.isEmpty()) this.bounds.set(new THREE.Vector3(-0.5, -0.5, 0), new THREE.Vector3(0.5, 0.5, 1));
    const thin = this.bounds.getSize(new THREE.Vector3()), least = 0.2 * Math.max(thin.x, thin.y, thin.z, 0.05);
    for (let k = 0; k < 3; k++) if (thin.getComponent(k) < least) this.bounds.expandByVector(new THREE.Vector3().setComponent(k, (least - thin.getComponent(k)) / 2));
    this.axes.fit(this.bounds);
  }

  // ---- looking

  get camera(): Camera {
    return { position: vector(this.eye.position), target: vector(this.controls.target), up: vector(this.eye.up), orthographic: this.orthographic };
  }
  private orthographic = false;

  private look(camera: Camera): void {
    this.fits = null;
    this.orthographic = camera.orthographic;
    this.eye.up.fromArray(camera.up);
    this.eye.position.fromArray(camera.position);
    this.controls.target.fromArray(camera.target);
    this.eye.lookAt(this.controls.target);
    this.eye.updateMatrixWorld();
    this.fitted = true;
  }

  /** Shows everything, from a direction. */
  fit(direction: Vector = [0.62, -0.95, 0.45]): void {
    const { low, high } = this.axes, target = low.clone().add(high).multiplyScalar(0.5), back = new THREE.Vector3(...direction).normalize();
    const turned = new THREE.Matrix4().lookAt(back, new THREE.Vector3(), this.eye.up).transpose(), half = 1 / Math.tan((FOV / 2) * (Math.PI / 180));
    const across = 0.78, along = this.volumes.size + this.points.length || this.layers.some((layer) => "scale" in layer) ? 0.8 : 0.88; // colour bars are above
    let away = 0;
    for (let c = 0; c < 8; c++) { // far enough for every corner, with room for what is written
      const p = new THREE.Vector3(c & 1 ? high.x : low.x, c & 2 ? high.y : low.y, c & 4 ? high.z : low.z).sub(target).applyMatrix4(turned);
      away = Math.max(away, p.z + (Math.abs(p.y) * half) / along, p.z + (Math.abs(p.x) * half) / this.aspect / across);
    }
    this.fits = direction;
    this.controls.target.copy(target);
    this.eye.position.copy(target).addScaledVector(back, away);
    this.controls.update();
    this.fitted = this.volumes.size === 0 || [...this.volumes.values()].some((v) => v.body.lattice);
    this.ask();
  }

  private get aspect(): number { return this.canvas.width / this.canvas.height; }

  /** The camera of the picture, ready to draw. */
  private aim(width: number, height: number): THREE.PerspectiveCamera | THREE.OrthographicCamera {
    const distance = this.eye.position.distanceTo(this.controls.target), radius = this.bounds.getBoundingSphere(new THREE.Sphere());
    const middle = this.eye.position.distanceTo(radius.center), reach = Math.max(radius.radius * 2, 1e-3);
    this.eye.near = Math.max(middle - reach, reach * 0.004);
    this.eye.far = middle + reach * 1.5;
    this.eye.aspect = width / height;
    this.eye.updateProjectionMatrix();
    this.eye.updateMatrixWorld();
    if (!this.orthographic) return this.eye;
    const half = distance * Math.tan((FOV / 2) * (Math.PI / 180));
    Object.assign(this.flat, { left: (-half * width) / height, right: (half * width) / height, top: half, bottom: -half, near: middle - reach * 1.5, far: middle + reach * 1.5 });
    this.flat.position.copy(this.eye.position);
    this.flat.quaternion.copy(this.eye.quaternion);
    this.flat.updateProjectionMatrix();
    this.flat.updateMatrixWorld();
    return this.flat;
  }

  private key(e: KeyboardEvent): void {
    const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[e.key], { target } = this.controls;
    const offset = this.eye.position.clone().sub(target);
    if (turn && e.shiftKey) {
      const by = new THREE.Vector3(turn[0], turn[1], 0).applyQuaternion(this.eye.quaternion).multiplyScalar(-0.04 * offset.length());
      target.add(by);
      this.eye.position.add(by);
    } else if (turn) {
      const up = this.eye.up, side = up.clone().cross(offset).normalize(), high = offset.angleTo(up);
      offset.applyAxisAngle(side, -Math.max(0.05 - high + 1e-6, Math.min(turn[1]! * 0.1, high - 0.05))).applyAxisAngle(up, turn[0]! * 0.1);
      this.eye.position.copy(target).add(offset);
    } else if (e.key === "+" || e.key === "=" || e.key === "-") this.eye.position.copy(target).add(offset.multiplyScalar(e.key === "-" ? 1.12 : 1 / 1.12));
    else if (e.key === "Home") this.fit();
    else return;
    e.preventDefault();
    if (e.key !== "Home") this.fits = null;
    this.controls.update();
    this.ask();
    this.emit("camera", this.camera);
  }

  private theme(): void {
    const chosen = this.settings?.theme ?? "system", dark = chosen === "dark" || (chosen === "system" && matchMedia("(prefers-color-scheme: dark)").matches);
    this.ink = dark ? INKS.dark : INKS.light;
  }

  private resize(): void {
    const w = Math.max(1, this.host.clientWidth), h = Math.max(1, this.host.clientHeight), ratio = Math.min(devicePixelRatio || 1, 2);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(w, h, false);
    this.overlay.width = Math.round(w * ratio);
    this.overlay.height = Math.round(h * ratio);
    if (this.fits) this.fit(this.fits);
    this.ask();
  }

  // ---- drawing, on demand: coarse while something moves, the fine picture in tiles, then smoothed by three more; at rest nothing

  private ask(changed = true): void {
    if (this.disposed) return;
    if (changed) {
      this.dirty = true;
      this.pass = 0; this.row = 0;
      clearTimeout(this.later);
      this.later = window.setTimeout(() => { this.later = 0; this.ask(false); }, REST_MS);
    }
    if (!this.asked) { this.asked = true; requestAnimationFrame(() => this.frame()); }
  }

  /** Only what stands before the picture has changed. */
  private askFront(): void {
    this.frontDirty = true;
    this.ask(false);
  }

  private frame(): void {
    this.asked = false;
    if (this.disposed || this.exporting || this.gl.isContextLost()) return;
    if (this.fence) { // nothing is queued behind a picture that is still worked on
      if (this.gl.getSyncParameter(this.fence, this.gl.SYNC_STATUS) !== this.gl.SIGNALED) return this.ask(false);
      this.gl.deleteSync(this.fence);
      this.fence = null;
      const took = performance.now() - this.sent;
      this.count.milliseconds = took;
      if (this.timed === "tile") this.tiles = Math.max(1, Math.min(Math.floor((this.canvas.width * this.canvas.height) / LEAST_TILE), Math.ceil((took * this.tiles) / BUDGET_MS)));
      if (this.timed === "quick") this.effort = Math.max(LEAST_SHARE ** 2 * (STRIDE / LONGEST_STRIDE), Math.min(1, this.effort * Math.min(1.6, Math.max(0.4, QUICK_MS / Math.max(took, 1)))));
      this.timed = null;
    }
    const { width, height } = this.canvas;
    this.sent = performance.now();
    if (this.frontDirty && !this.dirty) {
      this.frontDirty = false;
      this.count.frames++;
      this.drawFront();
      if (this.pass === PASSES) this.showSum();
      else this.show();
      if (this.pass === PASSES) return;
    } else if (this.dirty) {
      this.dirty = this.frontDirty = false;
      this.drawScene(this.whole());
      this.drawRays(this.share, this.stride, 0, 1, 0);
      this.show();
      this.timed = "quick";
      this.done("coarse");
    } else if (!this.later && this.pass < PASSES) this.fine(width, height);
    else return;
    if (this.pass === PASSES) { this.timed = null; return; } // at rest
    this.fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.gl.flush();
    if (!this.later || this.timed) this.ask(false);
  }

  /** Fewer pixels first; where the fewest take too long still, longer steps along their rays. */
  private get share(): number { return Math.max(LEAST_SHARE, Math.sqrt(this.effort)); }
  private get stride(): number { return STRIDE * Math.max(1, LEAST_SHARE ** 2 / this.effort); }

  private fine(width: number, height: number): void {
    if (this.row === 0) this.drawScene(this.whole(), SHIFTS[this.pass]);
    const to = this.row + 1 / this.tiles > 1 - 1e-6 || !this.bodies.length ? 1 : this.row + 1 / this.tiles;
    this.drawRays(1, 0.7, this.row, to, this.pass);
    this.row = to;
    this.timed = this.bodies.length ? "tile" : null;
    if (to < 1) return;
    this.row = 0;
    this.sum.setSize(width, height);
    this.renderer.setRenderTarget(this.sum);
    if (this.pass === 0) { this.renderer.setClearColor(0, 0); this.renderer.clear(); }
    this.compose(1 / PASSES);
    this.pass++;
    if (this.pass === 1) this.show();
    if (this.pass === PASSES) this.showSum();
    if (this.pass === 1 || this.pass === PASSES) this.done(this.pass === 1 ? "fine" : "finished");
  }

  /** The opaque things of a part of the picture. */
  private drawScene(part: Part, shift?: readonly [number, number]): void {
    this.count.frames++;
    const { width, height } = part, camera = this.aim(part.of.width, part.of.height), r = this.renderer, many = this.clouds().reduce((n, c) => n + c.count, 0);
    const splatted = shift ? { width, height, thin: 1 } : { width: Math.ceil(width / 2), height: Math.ceil(height / 2), thin: Math.max(1, Math.floor(many / 400_000)) };
    camera.setViewOffset(part.of.width, part.of.height, part.x + (shift?.[0] ?? 0), part.y + (shift?.[1] ?? 0), width, height);
    this.view = camera;
    this.axes.visible = this.settings?.layers.axes?.visible ?? true;
    this.axes.update(this.eye.position, this.ink);
    this.sun.position.copy(camera.localToWorld(new THREE.Vector3(-0.8, 1.1, 0.7)));
    this.sun.target.position.copy(camera.position);
    this.sun.target.updateMatrixWorld();
    LINES.resolution.set(width, height).divideScalar(part.ratio);
    this.placeSheets();
    this.splats.draw(this.clouds(), camera, splatted.width, splatted.height, splatted.thin);
    this.opaque.setSize(width, height);
    r.setRenderTarget(this.opaque);
    r.setClearColor(this.ink.paper, 1);
    r.clear();
    r.render(this.scene, camera);
    this.drawFront();
  }

  private drawFront(): void {
    const drawn = this.front.ready(this.view), u = drawn ? this.frontal.texture : this.nothing;
    this.composeMaterial.uniforms.front!.value = this.copyMaterial.uniforms.front!.value = u;
    if (!drawn) return;
    this.frontal.setSize(this.opaque.width, this.opaque.height);
    this.renderer.setRenderTarget(this.frontal);
    this.renderer.setClearColor(0, 0);
    this.renderer.clear();
    this.renderer.render(this.front.scene, this.view);
  }
  private view: THREE.PerspectiveCamera | THREE.OrthographicCamera = this.eye;

  /** Points of point layers and of volumes that are drawn as points. */
  private clouds(): Cloud[] {
    const found = this.points.flatMap((p) => (p.cloud ? [p.cloud] : []));
    for (const [name, data] of this.volumes) {
      const wanted = this.settings?.volumes[name], { body } = data;
      if (!wanted?.visible || wanted.style !== "points" || !body.lattice) continue;
      const look = JSON.stringify([wanted, body.scale?.low, body.scale?.high, body.scale?.log, this.settings?.colors]);
      if (data.cloud?.lattice !== body.lattice || data.cloud.look !== look) data.cloud = { lattice: body.lattice, look, cloud: body.points() };
      found.push(data.cloud.cloud);
    }
    return found;
  }

  /** Rows from … to, as shares, of the rays through all volumes. */
  private drawRays(scale: number, stride: number, from: number, to: number, seed: number): void {
    const w = Math.max(1, Math.round(this.opaque.width * scale)), h = Math.max(1, Math.round(this.opaque.height * scale)), r = this.renderer;
    const bodies = this.bodies, sun = this.sun.position.clone().sub(this.view.position).normalize();
    const away = (b: VolumeBody) => b.box().getCenter(new THREE.Vector3()).distanceTo(this.view.position);
    const order = bodies.length > 1 ? bodies.map((b) => ({ b, d: away(b) })).sort((a, b) => b.d - a.d).map(({ b }) => b) : bodies;
    for (const [target, drawn] of [[this.solid, order.filter((b) => b.solid).reverse()], [this.cloud, order.filter((b) => !b.solid)]] as const) {
      if (target.width !== w || target.height !== h) target.setSize(w, h);
      target.scissorTest = true;
      target.scissor.set(0, Math.floor(from * h), w, Math.ceil(to * h) - Math.floor(from * h));
      r.setRenderTarget(target);
      r.setClearColor(0, 0);
      r.clear();
      for (const body of drawn) {
        const solidDepth = target === this.cloud && order.some((b) => b.solid) ? this.solid.depthTexture! : this.farthest;
        this.screen.material = body.rays(this.view, [this.opaque.depthTexture!, solidDepth], sun, this.ink === INKS.dark, stride, seed);
        r.render(this.screenScene, this.screenCamera);
      }
    }
  }

  private compose(weight: number): void {
    const u = this.composeMaterial.uniforms, m = this.composeMaterial;
    u.scene!.value = this.opaque.texture; u.solid!.value = this.solid.texture; u.cloud!.value = this.cloud.texture; u.weight!.value = weight;
    m.blending = weight < 1 ? THREE.CustomBlending : THREE.NoBlending;
    m.blendSrc = THREE.OneFactor; m.blendDst = THREE.OneFactor;
    m.transparent = weight < 1;
    const front = u.front!.value as THREE.Texture;
    if (weight < 1) u.front!.value = this.nothing; // it is put over the sum
    this.screen.material = m;
    this.renderer.render(this.screenScene, this.screenCamera);
    u.front!.value = front;
  }

  private showSum(): void {
    this.copyMaterial.uniforms.picture!.value = this.sum.texture;
    this.renderer.setRenderTarget(null);
    this.screen.material = this.copyMaterial;
    this.renderer.render(this.screenScene, this.screenCamera);
  }

  private whole(): Part {
    const { width, height } = this.canvas;
    return { x: 0, y: 0, width, height, of: { width, height }, ratio: this.renderer.getPixelRatio() };
  }

  private show(): void {
    this.renderer.setRenderTarget(null);
    this.compose(1);
    const g = this.overlay.getContext("2d")!, ratio = this.renderer.getPixelRatio();
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, this.overlay.width, this.overlay.height);
    this.annotate(g, this.overlay.width / ratio, this.overlay.height / ratio);
  }

  private annotate(g: CanvasRenderingContext2D, width: number, height: number, title?: string): void {
    const layer = (name: string) => this.settings?.layers[name]?.visible ?? true, p = new THREE.Vector3();
    this.aim(width, height).clearViewOffset();
    const project = (at: THREE.Vector3) => {
      p.copy(at).project(this.view);
      return { x: ((p.x + 1) / 2) * width, y: ((1 - p.y) / 2) * height, front: p.z < 1 && p.z > -1 };
    };
    write(g, {
      width, height, ink: this.ink, project, axes: this.axes.visible ? this.axes : null, bars: this.bars.slice(0, 2), metre: layer("scale_bar") ? 1 / this.metresPerPixel(height) : null,
      measure: (this.settings?.measure ?? []).map((m) => new THREE.Vector3(...m)), title,
    });
  }

  private done(what: Events["drawn"]): void { this.emit("drawn", what); }

  /** Planes through the volumes, as the settings' slices say. */
  private placeSheets(): void {
    const wanted = this.settings?.slices.filter((s) => s.visible) ?? [], bodies = wanted.length ? [...this.volumes.values()].map((v) => v.body).filter((b) => b.lattice) : [];
    const shown = bodies.filter((b) => this.settings?.volumes[b.volume.name]?.visible), through = shown.length ? shown : bodies.slice(0, 1);
    const meshes = this.sheets.children as THREE.Mesh<THREE.PlaneGeometry, THREE.ShaderMaterial>[];
    while (meshes.length > wanted.length * through.length) { const m = meshes[meshes.length - 1]!; m.geometry.dispose(); m.removeFromParent(); }
    while (meshes.length < wanted.length * through.length) this.sheets.add(new THREE.Mesh(new THREE.PlaneGeometry(1, 1)));
    const span = this.bounds.getSize(new THREE.Vector3()).length() * 1.5, middle = this.bounds.getCenter(new THREE.Vector3());
    wanted.forEach((slice, i) => through.forEach((body, j) => {
      const mesh = meshes[i * through.length + j]!, k = "xyz".indexOf(slice.axis);
      const n = k < 0 ? new THREE.Vector3(...slice.normal).normalize() : new THREE.Vector3().setComponent(k, 1);
      const plane = new THREE.Plane(n, -slice.at_m);
      plane.projectPoint(middle, mesh.position);
      mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), n);
      mesh.scale.setScalar(span);
      mesh.material = body.sheet();
    }));
  }

  /** The picture as a PNG of up to 8192 pixels a side, drawn in parts, with its title, axes and colour bar. */
  async image(options: { width: number; height: number; title?: string }): Promise<Blob> {
    const { width, height } = options;
    if (![width, height].every((n) => Number.isInteger(n) && n >= 16 && n <= MOST_PIXELS)) throw new RangeError(`a picture has 16 … ${MOST_PIXELS} pixels a side, not ${width} × ${height}`);
    const picture = document.createElement("canvas"), ratio = Math.max(0.5, Math.min(width / this.host.clientWidth, height / this.host.clientHeight));
    Object.assign(picture, { width, height });
    const g = picture.getContext("2d");
    if (!g) throw new Error(`this browser has no room for a picture of ${width} × ${height} pixels`);
    const target = new THREE.WebGLRenderTarget(1, 1, { depthBuffer: false }), front = this.composeMaterial.uniforms.front!;
    this.exporting++;
    try {
      for (let y = 0; y < height; y += TILE) for (let x = 0; x < width; x += TILE) {
        const part: Part = { x, y, width: Math.min(TILE, width - x), height: Math.min(TILE, height - y), of: { width, height }, ratio };
        g.putImageData(this.part(part, target), x, y);
        await new Promise((resolve) => setTimeout(resolve)); // the page stays alive
        if (this.disposed) throw new DOMException("the view was closed", "AbortError");
      }
    } finally {
      target.dispose();
      front.value = this.nothing;
      this.exporting--;
      this.ask();
    }
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.annotate(g, width / ratio, height / ratio, options.title);
    return new Promise((resolve, reject) => picture.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("the picture could not be written"))), "image/png"));
  }

  private part(part: Part, target: THREE.WebGLRenderTarget): ImageData {
    const { width, height } = part, r = this.renderer;
    SHIFTS.forEach((shift, i) => {
      this.drawScene(part, shift);
      this.drawRays(1, 0.7, 0, 1, i);
      this.sum.setSize(width, height);
      r.setRenderTarget(this.sum);
      if (i === 0) { r.setClearColor(0, 0); r.clear(); }
      this.compose(1 / PASSES);
    });
    target.setSize(width, height);
    r.setRenderTarget(target);
    this.copyMaterial.uniforms.picture!.value = this.sum.texture;
    this.screen.material = this.copyMaterial;
    r.render(this.screenScene, this.screenCamera);
    const bottomUp = new Uint8Array(4 * width * height), image = new ImageData(width, height);
    r.readRenderTargetPixels(target, 0, 0, width, height, bottomUp);
    for (let row = 0; row < height; row++) image.data.set(bottomUp.subarray(4 * width * row, 4 * width * (row + 1)), 4 * width * (height - 1 - row));
    return image;
  }

  // ---- picking

  private clicks(): void {
    let pressed = [0, 0];
    this.listen(this.canvas, "pointerdown", (e) => { pressed = [(e as PointerEvent).clientX, (e as PointerEvent).clientY]; });
    this.listen(this.canvas, "pointerup", (e) => {
      const { clientX: x, clientY: y, button } = e as PointerEvent;
      if (button !== 0 || this.front.dragging || this.front.hovered || Math.hypot(x - pressed[0]!, y - pressed[1]!) > 4) return;
      const box = this.canvas.getBoundingClientRect();
      this.emit("pick", this.pick(x - box.left, y - box.top));
    });
  }

  /** What is met at a place of the view, in CSS pixels from its upper left. */
  pick(x: number, y: number): Pick | null {
    const caster = new THREE.Raycaster(), camera = this.aim(this.canvas.width, this.canvas.height);
    camera.clearViewOffset();
    caster.setFromCamera(new THREE.Vector2((x / this.host.clientWidth) * 2 - 1, 1 - (y / this.host.clientHeight) * 2), camera);
    let best: Pick | null = null, nearest = Infinity;
    const meet = (distance: number, pick: Pick) => { if (distance < nearest) { nearest = distance; best = pick; } };
    for (const body of this.shownBodies) {
      const hit = body.pick(caster.ray);
      if (hit) meet(hit.distance, { kind: "volume", name: body.volume.name, cell: hit.cell, center_m: vector(body.center(hit.cell)), point_m: vector(hit.point), value: body.value(hit.cell), unit: body.scale?.unit ?? "" });
    }
    for (const robot of this.robots) {
      const hit = robot.pick(caster);
      if (hit) meet(hit.distance, { kind: "robot", robot: robot.index, link: hit.link, point_m: vector(hit.point) });
    }
    for (const layer of this.layers) {
      if (!layer.object.visible) continue;
      if (layer instanceof PaintedMap) {
        const hit = layer.pick(caster.ray);
        if (hit) meet(hit.distance, { kind: "map", name: layer.key, cell: hit.cell, point_m: vector(hit.point), value: hit.value, unit: layer.scale?.unit ?? "" });
      } else if (layer.object instanceof THREE.Group) {
        const hit = caster.intersectObject(layer.object, true)[0];
        if (hit) meet(hit.distance, { kind: "mesh", name: layer.key, patch: String(hit.object.userData.name ?? ""), point_m: vector(hit.point) });
      }
    }
    const pixel = this.metresPerPixel();
    for (const points of this.points) {
      const hit = points.pick(caster.ray, Math.max(points.cloud?.radius_m ?? 0, 3 * pixel));
      if (hit) meet(hit.distance, { kind: "points", name: points.key, number: hit.number, point_m: vector(hit.point) });
    }
    return best;
  }

  /** Of CSS pixels, at the target. */
  private metresPerPixel(height = this.host.clientHeight): number {
    return (2 * this.eye.position.distanceTo(this.controls.target) * Math.tan((FOV / 2) * (Math.PI / 180))) / Math.max(height, 1);
  }

  // ---- events, numbers, the end

  on<K extends keyof Events>(event: K, listener: (value: Events[K]) => void): () => void {
    const found = this.listeners.get(event) ?? new Set();
    this.listeners.set(event, found);
    found.add(listener as (value: never) => void);
    return () => found.delete(listener as (value: never) => void);
  }

  private emit<K extends keyof Events>(event: K, value: Events[K]): void {
    for (const listener of this.listeners.get(event) ?? []) (listener as (value: Events[K]) => void)(value);
  }

  private listen(target: EventTarget, name: string, listener: (e: Event) => void): void {
    target.addEventListener(name, listener);
    this.undo.push(() => target.removeEventListener(name, listener));
  }

  get info() {
    const { geometries, textures } = this.renderer.info.memory;
    return {
      ...this.count, geometries, textures, programs: this.renderer.info.programs?.length ?? 0, scale: this.share, stride: this.stride,
      idle: !this.asked && !this.later && !this.dirty && !this.frontDirty && !this.fence && this.pass === PASSES,
    };
  }

  private clear(): void {
    for (const data of this.volumes.values()) data.dispose();
    this.volumes.clear();
    this.freeMotions();
    for (const robot of this.robots) robot.dispose();
    for (const layer of this.layers) layer.dispose();
    this.robots = []; this.layers = []; this.points = [];
    for (const m of [...this.sheets.children] as THREE.Mesh[]) { m.geometry.dispose(); m.removeFromParent(); }
    this.bars = [];
    this.fitted = false;
  }

  dispose(): void {
    if (this.disposed) return;
    this.disposed = true;
    this.clear();
    clearTimeout(this.later);
    for (const undo of this.undo) undo();
    this.controls.dispose();
    this.axes.dispose();
    this.splats.dispose();
    this.front.dispose();
    for (const t of [this.opaque, this.solid, this.cloud, this.sum, this.frontal]) { t.depthTexture?.dispose(); t.dispose(); }
    for (const t of [this.nothing, this.farthest, this.composeMaterial, this.copyMaterial, this.screen.geometry]) t.dispose();
    this.renderer.dispose();
    this.gl.getExtension("WEBGL_lose_context")?.loseContext();
    this.canvas.remove();
    this.overlay.remove();
    this.listeners.clear();
  }
}

function material(fragmentShader: string, uniforms: Record<string, THREE.IUniform>): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({ glslVersion: THREE.GLSL3, vertexShader: glsl.quad, fragmentShader, uniforms, depthTest: false, depthWrite: false });
}

/** Of x, y and z; one number stands for three. */
const axes = (scale: number | Vector): Vector => (typeof scale === "number" ? [scale, scale, scale] : scale);

function same(a: Camera, b: Camera): boolean {
  const near = (p: Vector, q: Vector) => p.every((v, k) => Math.abs(v - q[k]!) < 1e-9);
  return near(a.position, b.position) && near(a.target, b.target) && near(a.up, b.up) && a.orthographic === b.orthographic;
}
