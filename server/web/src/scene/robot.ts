/** A robot at a configuration: its bodies, or sticks where it has none; frames of its base, joints and tool. */

import * as THREE from "three";
import type { Robot } from "../contract";
import { bytes, type Blob_ } from "./data";
import { body, fade, free, matrix } from "./glb";
import { frames, type Changed } from "./kinematics";

const STICK = 0xcfd5dc, JOINT = 0x2f74ad;
const PLAIN = 128 / 255, LINKS = [0xd9dee4, 0x9fb0c2]; // MuJoCo's grey of what has no colour of its own; what is shown instead, link by link

/** Axes x, y, z in colours that the colour-blind tell apart. */
function triad(length: number): THREE.Object3D {
  const axes = new THREE.Group(), rod = new THREE.CylinderGeometry(0.045, 0.045, 1, 10).translate(0, 0.5, 0).scale(length, length, length);
  [0xd55e00, 0x009e73, 0x0072b2].forEach((color, k) => {
    const axis = new THREE.Mesh(rod, new THREE.MeshBasicMaterial({ color }));
    if (k === 0) axis.rotation.z = -Math.PI / 2;
    if (k === 2) axis.rotation.x = Math.PI / 2;
    axes.add(axis);
  });
  return axes;
}

function paint(object: THREE.Object3D, color: number): void {
  object.traverse((node) => {
    const own = (node as THREE.Mesh<THREE.BufferGeometry, THREE.MeshPhongMaterial>).material?.color;
    if (own && [own.r, own.g, own.b].every((each) => Math.abs(each - PLAIN) < 0.003)) own.set(color);
  });
}

export class RobotBody extends THREE.Group {
  q: number[];
  changed: Changed = {};
  readonly frames = new THREE.Group();
  private links: { frame: number; object: THREE.Object3D }[] = [];
  private sticks: THREE.Mesh[] = [];
  private materials: THREE.Material[] = [];
  readonly size: number;

  constructor(readonly robot: Robot, readonly index: number) {
    super();
    this.q = [...robot.home];
    const at = frames(robot.chain, this.q).map((T) => new THREE.Vector3(T[3], T[7], T[11]));
    this.size = Math.max(0.05, at.slice(1).reduce((sum, p, i) => sum + p.distanceTo(at[i]!), 0));
    for (let i = 0; i < at.length; i++) {
      const axes = triad(this.size * (i === at.length - 1 ? 0.11 : 0.07));
      axes.matrixAutoUpdate = false;
      this.frames.add(axes);
    }
    this.frames.visible = false;
    this.add(this.frames);
  }

  async load(blob: Blob_): Promise<void> {
    const seen = this.robot.links.filter((l) => l.kind === "visual"), links = seen.length ? seen : this.robot.links;
    this.links = await Promise.all(links.map(async (link) => ({ frame: link.frame, object: (await body(await bytes(link.geometry, blob))) as THREE.Object3D })));
    for (const { object, frame } of this.links) { object.matrixAutoUpdate = false; this.add(object); paint(object, LINKS[frame % 2]!); }
    if (!this.links.length) this.draw();
    this.pose(this.q);
  }

  /** Capsules between the joints' origins, a drum along the axis of each that turns, a box where one slides. */
  private draw(): void {
    const { revolute } = this.robot.chain, r = this.size * 0.02;
    const stick = new THREE.MeshPhongMaterial({ color: STICK, shininess: 50, specular: 0x333333 });
    const joint = new THREE.MeshPhongMaterial({ color: JOINT, shininess: 60, specular: 0x333333 });
    this.materials = [stick, joint];
    const tube = new THREE.CylinderGeometry(r, r, 1, 24, 1, true).rotateX(Math.PI / 2), ball = new THREE.SphereGeometry(r, 20, 14);
    const drum = new THREE.CylinderGeometry(r * 1.5, r * 1.5, r * 3.4, 32).rotateX(Math.PI / 2), box = new THREE.BoxGeometry(r * 2.7, r * 2.7, r * 3.4);
    for (let i = 0; i <= revolute.length; i++) {
      const piece = new THREE.Mesh(tube, stick), end = new THREE.Mesh(ball, stick);
      this.sticks.push(piece);
      this.links.push({ frame: i + 1, object: end });
      this.add(piece, end);
    }
    revolute.forEach((turns, i) => {
      const mesh = new THREE.Mesh(turns ? drum : box, joint);
      this.links.push({ frame: i + 1, object: mesh });
      this.add(mesh);
    });
    for (const { object } of this.links) object.matrixAutoUpdate = false;
    for (const piece of this.sticks) piece.matrixAutoUpdate = false;
  }

  pose(q: ArrayLike<number>): void {
    this.q = Array.from(q);
    const T = frames(this.robot.chain, this.q, this.changed), M = T.map(matrix);
    for (const { frame, object } of this.links) { object.matrix.copy(M[Math.min(frame, M.length - 1)]!); object.matrixWorldNeedsUpdate = true; }
    const at = M.map((m) => new THREE.Vector3().setFromMatrixPosition(m)), unit = new THREE.Vector3(0, 0, 1);
    this.sticks.forEach((piece, i) => {
      const along = at[i + 1]!.clone().sub(at[i]!), length = along.length();
      piece.visible = length > 1e-4 * this.size;
      if (!piece.visible) return;
      piece.matrix.compose(at[i]!.clone().addScaledVector(along, 0.5), new THREE.Quaternion().setFromUnitVectors(unit, along.divideScalar(length)), new THREE.Vector3(1, 1, length));
      piece.matrixWorldNeedsUpdate = true;
    });
    this.frames.children.forEach((axes, i) => { axes.matrix.copy(M[i]!); axes.matrixWorldNeedsUpdate = true; });
  }

  /** Around its bodies and frames. */
  box(): THREE.Box3 {
    const box = new THREE.Box3();
    this.updateMatrixWorld();
    for (const child of this.children) if (child !== this.frames && child.visible) box.expandByObject(child);
    for (const frame of this.frames.children) box.expandByPoint(new THREE.Vector3().setFromMatrixPosition(frame.matrix));
    return box;
  }

  /** Frame of the tip in the world. */
  tip(): Float64Array { return frames(this.robot.chain, this.q, this.changed).at(-1)!; }

  show(visible: boolean, opacity: number): void {
    for (const child of this.children) if (child !== this.frames) child.visible = visible;
    if (visible) this.pose(this.q);
    for (const { object } of this.links) fade(object, opacity);
    for (const piece of this.sticks) fade(piece, opacity);
  }

  /** Link that a ray meets. */
  pick(caster: THREE.Raycaster): { distance: number; point: THREE.Vector3; link: string } | null {
    const hit = caster.intersectObjects(this.children.filter((c) => c !== this.frames && c.visible), true)[0];
    if (!hit) return null;
    const seen = this.robot.links.filter((l) => l.kind === "visual"), links = seen.length ? seen : this.robot.links;
    let node: THREE.Object3D | null = hit.object;
    while (node && node.parent !== this) node = node.parent;
    return { distance: hit.distance, point: hit.point, link: links[this.links.findIndex((l) => l.object === node)]?.name ?? "" };
  }

  dispose(): void {
    free(this);
    for (const m of this.materials) m.dispose();
  }
}
