/** What is drawn beside volumes and robots: meshes, arrows, curves, maps, skeletons. */

import * as THREE from "three";
import type { Curves, FloorMap, Glyphs, Mesh, Skeleton, Vector } from "../contract";
import { channelKey, type Settings } from "../settings";
import { ColorScale, scaleOf } from "./colors";
import { bytes, extent, measured, numbers, values, type Blob_, type Measured } from "./data";
import { body, fade, free, matrix } from "./glb";
import { lines } from "./lines";

/** One thing that a layer of the settings shows or hides. */
export interface Drawn {
  readonly key: string;
  readonly shown: boolean; // where the settings say nothing
  readonly object: THREE.Object3D;
  readonly scale?: ColorScale | null; // its colours have a bar
  set?(settings: Settings, leads: boolean): void; // leads: the settings' range is of its channel
  dispose(): void;
}

const ROLES: Record<Mesh["role"], string | null> = { surface: null, refined: null, boundary: null, shared: "#2e9d6a", exclusive: "#d98032", environment: "#9aa3ad" };

/** A mesh, which is fetched when it is first to be seen; `again` is called when it is there, or with why it is not. */
export class MeshLayer implements Drawn {
  readonly key: string;
  readonly shown = true;
  readonly object = new THREE.Group();
  private begun: Promise<void> | null = null;
  private gone = false;

  constructor(private of: Mesh, private blob: Blob_, private again: (problem?: unknown) => void) { this.key = this.object.name = of.name; }

  load(): Promise<void> { return this.begun ??= this.fetched(); }

  private async fetched(): Promise<void> {
    const found = await body(await bytes(this.of.geometry, this.blob)), color = this.of.color ?? ROLES[this.of.role];
    if (color && this.of.role !== "environment") found.traverse((node) => { if (node instanceof THREE.Mesh) (node.material as THREE.MeshPhongMaterial).color.set(color); });
    if (this.gone) free(found);
    else this.object.add(found);
  }

  set(settings: Settings): void {
    const layer = settings.layers[this.key];
    if (!this.begun && (layer?.visible ?? this.shown)) this.load().then(() => this.again(), this.again);
    fade(this.object, layer?.opacity ?? 1);
  }

  dispose(): void {
    this.gone = true;
    free(this.object);
  }
}

const COLORS_OF_LINES = [0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00, 0x56b4e9];

/** Ends of the pieces of a line, 6 numbers each. */
export function segmentsOf(points: Vector[], closed: boolean): number[] {
  const found: number[] = [], n = closed ? points.length : points.length - 1;
  for (let i = 0; i < n; i++) found.push(...points[i]!, ...points[(i + 1) % points.length]!);
  return found;
}

export function curves(of: Curves, number: number): Drawn {
  const object = lines(of.points.flatMap((line) => segmentsOf(line, of.closed)), COLORS_OF_LINES[number % COLORS_OF_LINES.length]!, 2.6);
  return { key: of.name, shown: true, object, dispose: () => free(object) };
}

/** The first configuration in tubes and balls, others in fine lines. */
export function skeleton(of: Skeleton, number: number): Drawn {
  const object = new THREE.Group(), first = of.points[0] ?? [];
  const size = Math.max(1e-3, ...first.map((p, i) => new THREE.Vector3(...p).distanceTo(new THREE.Vector3(...(first[(i + 1) % first.length] ?? p))))) * 0.035;
  const leg = new THREE.MeshPhongMaterial({ color: 0xcfd5dc, shininess: 50, specular: 0x333333 }), joint = new THREE.MeshPhongMaterial({ color: COLORS_OF_LINES[number % COLORS_OF_LINES.length]!, shininess: 60, specular: 0x333333 });
  const tube = new THREE.CylinderGeometry(size, size, 1, 20, 1, true).rotateX(Math.PI / 2), ball = new THREE.SphereGeometry(size * 1.5, 20, 14), unit = new THREE.Vector3(0, 0, 1);
  first.forEach((p, i) => {
    const a = new THREE.Vector3(...p), at = new THREE.Mesh(ball, joint);
    at.position.copy(a);
    object.add(at);
    const next = first[i + 1] ?? (of.closed ? first[0] : undefined);
    if (!next) return;
    const along = new THREE.Vector3(...next).sub(a), length = along.length(), piece = new THREE.Mesh(tube, leg);
    if (length < 1e-9) return;
    piece.position.copy(a).addScaledVector(along, 0.5);
    piece.quaternion.setFromUnitVectors(unit, along.divideScalar(length));
    piece.scale.set(1, 1, length);
    object.add(piece);
  });
  const others = of.points.slice(1, 60).flatMap((points) => segmentsOf(points, of.closed));
  if (others.length) object.add(lines(others, 0x8a96a3, 1));
  return { key: of.name, shown: true, object, dispose: () => { free(object); tube.dispose(); ball.dispose(); } };
}

/** Arrows from their origins; the longest is a share of the span, colours say how long they are in their unit. */
export async function glyphs(of: Glyphs, blob: Blob_, span: number): Promise<Drawn> {
  const [origins, vectors] = (await Promise.all([numbers(of.origins, blob), numbers(of.vectors, blob)])) as [Float32Array, Float32Array];
  const n = origins.length / 3, size = new Float32Array(n);
  for (let i = 0; i < n; i++) size[i] = Math.hypot(vectors[3 * i]!, vectors[3 * i + 1]!, vectors[3 * i + 2]!);
  const whole = extent(size) ?? [0, 1], equal = whole[1] - whole[0] < 1e-4 * whole[1], longest = whole[1] || 1;
  // A shaft and a head, one arrow long along z.
  const profile = [[0, 0], [0.022, 0], [0.022, 0.7], [0.07, 0.7], [0, 1]].map(([x, y]) => new THREE.Vector2(x, y));
  const arrow = new THREE.LatheGeometry(profile, 10).rotateX(Math.PI / 2);
  const material = new THREE.MeshPhongMaterial({ shininess: 30, specular: 0x222222, side: THREE.DoubleSide }), object = new THREE.InstancedMesh(arrow, material, n);
  const length = Math.min(0.12, 1.6 / Math.cbrt(Math.max(n, 1))) * span, unit = new THREE.Vector3(0, 0, 1), d = new THREE.Vector3(), M = new THREE.Matrix4(), turn = new THREE.Quaternion();
  for (let i = 0; i < n; i++) {
    d.fromArray(vectors, 3 * i);
    const s = length * (equal ? 1 : Math.max(0.15, size[i]! / longest));
    turn.setFromUnitVectors(unit, d.divideScalar(size[i] || 1));
    object.setMatrixAt(i, M.compose(new THREE.Vector3().fromArray(origins, 3 * i), turn, new THREE.Vector3(s, s, s)));
    object.setColorAt(i, new THREE.Color(0x2f74ad));
  }
  object.frustumCulled = false;
  let colored = "";
  const drawn = {
    key: of.name, shown: true, object, scale: null as ColorScale | null, dispose: () => { object.dispose(); free(object); },
    set(settings: Settings) {
      if (equal || settings.colors === colored) return;
      colored = settings.colors;
      drawn.scale = scaleOf({ label: of.label, unit: of.unit }, whole, whole, null, settings.colors);
      const c = new THREE.Color();
      for (let i = 0; i < n; i++) { const [r, g, b] = drawn.scale.color(size[i]!); object.setColorAt(i, c.setRGB(r / 255, g / 255, b / 255)); }
      object.instanceColor!.needsUpdate = true;
    },
  };
  return drawn;
}

/** A map painted on its plane, cell by cell. */
export class PaintedMap implements Drawn {
  readonly key: string;
  readonly shown = true;
  readonly object: THREE.Mesh<THREE.PlaneGeometry, THREE.MeshBasicMaterial>;
  scale: ColorScale | null = null;
  values: Float32Array | null = null;
  private texture: THREE.DataTexture;
  private found = new Map<string, Measured>();
  private painted = "";
  private place: THREE.Matrix4;

  constructor(readonly map: FloorMap, private blob: Blob_, private again: () => void) {
    this.key = map.name;
    const [nx, ny] = map.shape, [w, h] = [nx * map.cell_m[0], ny * map.cell_m[1]];
    this.texture = new THREE.DataTexture(new Uint8Array(4 * nx * ny), nx, ny);
    this.texture.minFilter = this.texture.magFilter = THREE.NearestFilter;
    this.object = new THREE.Mesh(new THREE.PlaneGeometry(w, h).translate(map.origin_m[0] + w / 2, map.origin_m[1] + h / 2, 0), new THREE.MeshBasicMaterial({
      map: this.texture, side: THREE.DoubleSide, alphaTest: 0.5, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    }));
    this.place = matrix(map.T_world);
    this.object.matrixAutoUpdate = false;
    this.object.matrix.copy(this.place);
  }

  set(settings: Settings, leads: boolean): void {
    const channel = this.map.channels.find((c) => channelKey(c) === settings.channels?.[this.key]) ?? this.map.channels[0];
    const layer = settings.layers[this.key];
    this.object.material.opacity = layer?.opacity ?? 1;
    this.object.material.alphaTest = 0.5 * this.object.material.opacity;
    this.object.material.transparent = this.object.material.opacity < 1;
    if (!channel || layer?.visible === false) return;
    const found = this.found.get(channelKey(channel));
    if (!found) { values(channel, this.blob).then((v) => { this.found.set(channelKey(channel), measured(v)); this.again(); }, () => undefined); return; }
    this.values = found.values;
    this.scale = scaleOf(channel, found.whole, found.inner, leads ? settings.range : null, settings.colors);
    const look = `${channelKey(channel)} ${this.scale.low} ${this.scale.high} ${this.scale.log} ${settings.colors}`;
    if (look === this.painted) return;
    this.painted = look;
    const pixels = this.texture.image.data as Uint8Array;
    for (let i = 0; i < found.values.length; i++) pixels.set(Number.isNaN(found.values[i]!) ? [0, 0, 0, 0] : [...this.scale.color(found.values[i]!), 255], 4 * i);
    this.texture.needsUpdate = true;
  }

  pick(ray: THREE.Ray): { distance: number; point: THREE.Vector3; cell: [number, number]; value: number } | null {
    if (!this.object.visible) return null;
    const back = this.place.clone().invert(), local = ray.clone().applyMatrix4(back), t = -local.origin.z / local.direction.z;
    if (!(t > 0)) return null;
    const p = local.at(t, new THREE.Vector3()), { origin_m, cell_m, shape } = this.map;
    const i = Math.floor((p.x - origin_m[0]) / cell_m[0]), j = Math.floor((p.y - origin_m[1]) / cell_m[1]);
    if (i < 0 || j < 0 || i >= shape[0] || j >= shape[1]) return null;
    const value = this.values?.[i + shape[0] * j] ?? NaN;
    return Number.isNaN(value) ? null : { distance: t, point: ray.at(t, new THREE.Vector3()), cell: [i, j], value };
  }

  dispose(): void { free(this.object); }
}
