/** Lines of a width in CSS pixels. */

import * as THREE from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

/** CSS pixels of the picture that is drawn; the renderer knows only those of its canvas. */
export const LINES = { resolution: new THREE.Vector2(1, 1) };

/** Segments from point to point, 6 numbers each. */
export function lines(segments: number[], color: THREE.ColorRepresentation, width: number): LineSegments2 {
  const geometry = new LineSegmentsGeometry(), material = new LineMaterial({ color, linewidth: width });
  geometry.setPositions(segments);
  const object = new LineSegments2(geometry, material);
  object.onBeforeRender = () => { material.resolution.copy(LINES.resolution); material.uniformsNeedUpdate = true; };
  return object;
}
