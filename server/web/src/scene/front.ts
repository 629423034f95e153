/** What stands before the picture: the gizmo of a tool, the mark of a chosen voxel. */

import * as THREE from "three";
import type { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { TransformControls } from "three/addons/controls/TransformControls.js";
import { free } from "./glb";
import { lines } from "./lines";

export interface Moved { robot: number; T: number[]; dragging: boolean }

const STATES = { reachable: 0x2e9d6a, unreachable: 0xd8423c, undecided: 0xd9a032, blocked: 0xd8423c };

export class Front {
  readonly scene = new THREE.Scene();
  robot: number | null = null;
  private controls: TransformControls | null = null;
  private handle = new THREE.Object3D();
  private ball = new THREE.Mesh(new THREE.SphereGeometry(1, 24, 16), new THREE.MeshBasicMaterial({ color: 0x8a96a3, depthTest: false }));
  private box: THREE.Object3D | null = null;
  private boxKey = "";
  private view: THREE.Camera | null = null;

  constructor(private canvas: HTMLCanvasElement, private orbit: OrbitControls, private redraw: () => void, private moved: (moved: Moved) => void) {
    this.ball.visible = false;
    this.ball.renderOrder = 1;
    this.scene.add(this.handle, this.ball);
  }

  attach(at: { robot: number; T: ArrayLike<number>; size: number } | null, mode: "translate" | "rotate"): void {
    if (!at) { this.detach(); return; }
    if (!this.controls) {
      const controls = new TransformControls(this.view ?? this.orbit.object, this.canvas);
      controls.setSize(0.8);
      controls.addEventListener("change", this.redraw);
      controls.addEventListener("dragging-changed", ({ value }) => {
        this.orbit.enabled = !value;
        if (!value) this.tellMoved(false);
      });
      controls.addEventListener("objectChange", () => { this.place(); this.tellMoved(true); });
      controls.attach(this.handle);
      this.scene.add(controls.getHelper());
      this.controls = controls;
    }
    this.robot = at.robot;
    this.controls.setMode(mode);
    this.controls.setSpace("local");
    this.ball.scale.setScalar(at.size * 0.03);
    this.ball.visible = true;
    this.tell(null);
    this.follow(at.T);
  }

  /** Goes to a pose, but while it is dragged. */
  follow(T: ArrayLike<number>): void {
    if (this.controls?.dragging) return;
    new THREE.Matrix4().fromArray(Array.from(T)).transpose().decompose(this.handle.position, this.handle.quaternion, new THREE.Vector3());
    this.handle.updateMatrixWorld();
    this.place();
  }

  tell(state: keyof typeof STATES | null): void { this.ball.material.color.set(state ? STATES[state] : 0x8a96a3); }

  mark(voxel: { at: THREE.Vector3; size: number; place: THREE.Matrix4 } | null, color: string): void {
    const key = voxel ? `${voxel.at.toArray()} ${voxel.size} ${voxel.place.elements} ${color}` : "";
    if (key === this.boxKey) return;
    this.boxKey = key;
    if (this.box) free(this.box);
    this.box = null;
    if (!voxel) return;
    const edges = new THREE.EdgesGeometry(new THREE.BoxGeometry(voxel.size, voxel.size, voxel.size)), box = lines(Array.from(edges.attributes.position!.array), color, 2.4);
    edges.dispose();
    box.applyMatrix4(new THREE.Matrix4().extractRotation(voxel.place).scale(new THREE.Vector3().setFromMatrixScale(voxel.place)).setPosition(voxel.at));
    this.box = box;
    this.scene.add(box);
  }

  /** Whether there is anything to draw; the gizmo is turned to the camera. */
  ready(view: THREE.PerspectiveCamera | THREE.OrthographicCamera): boolean {
    this.view = view;
    if (this.controls) this.controls.camera = view;
    return this.controls !== null || this.box !== null;
  }

  get dragging(): boolean { return this.controls?.dragging ?? false; }
  /** Whether the pointer is over the gizmo. */
  get hovered(): boolean { return !!this.controls?.axis; }

  private place(): void { this.ball.position.copy(this.handle.position); }

  private tellMoved(dragging: boolean): void {
    if (this.robot === null) return;
    const T = new THREE.Matrix4().compose(this.handle.position, this.handle.quaternion, new THREE.Vector3(1, 1, 1)).transpose().toArray();
    this.moved({ robot: this.robot, T, dragging });
  }

  private detach(): void {
    this.robot = null;
    this.ball.visible = false;
    if (!this.controls) return;
    this.orbit.enabled = true;
    this.controls.getHelper().removeFromParent();
    this.controls.detach();
    this.controls.dispose();
    this.controls = null;
  }

  dispose(): void {
    this.detach();
    this.mark(null, "");
    free(this.ball);
  }
}
