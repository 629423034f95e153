/** Bodies from GLB, in materials that software GL draws quickly. */

import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

export async function body(glb: ArrayBuffer): Promise<THREE.Group> {
  const { scene } = await new GLTFLoader().parseAsync(glb, "");
  scene.traverse((node) => {
    if (!(node instanceof THREE.Mesh)) return;
    const old = node.material as THREE.MeshStandardMaterial;
    if (!node.geometry.attributes.normal) node.geometry.computeVertexNormals();
    node.material = new THREE.MeshPhongMaterial({
      color: old.color, map: old.map, vertexColors: !!node.geometry.attributes.color, side: old.side, shininess: 45, specular: 0x2a2a2a,
      transparent: old.transparent, opacity: old.opacity,
    });
    old.dispose();
  });
  return scene;
}

/** Frees what an object and its children hold on the graphics card. */
export function free(object: THREE.Object3D): void {
  object.traverse((node) => {
    const { geometry, material } = node as THREE.Mesh;
    geometry?.dispose();
    for (const m of material ? [material].flat() : []) {
      (m as THREE.MeshPhongMaterial).map?.dispose();
      m.dispose();
    }
  });
  object.removeFromParent();
}

export function fade(object: THREE.Object3D, opacity: number): void {
  object.traverse((node) => {
    for (const m of (node as THREE.Mesh).material ? [(node as THREE.Mesh).material].flat() : []) {
      m.userData.opacity ??= m.opacity; // its own
      m.opacity = opacity * m.userData.opacity;
      m.transparent = m.opacity < 1;
      m.depthWrite = !m.transparent;
    }
  });
}

/** A row-major matrix as three's. */
export const matrix = (T: ArrayLike<number>): THREE.Matrix4 => new THREE.Matrix4().fromArray(Array.from(T)).transpose();
