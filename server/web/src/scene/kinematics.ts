/** Forward kinematics of a chain, in float64, as `wsrender.robots.chain.Chain.frames` computes it. Matrices: 16 numbers, row-major. */

import type { Chain } from "../contract";

export type Matrix = ArrayLike<number>;

export function multiply(a: Matrix, b: Matrix): Float64Array<ArrayBuffer> {
  const c = new Float64Array(16);
  for (let i = 0; i < 16; i += 4) for (let j = 0; j < 4; j++) c[i + j] = a[i]! * b[j]! + a[i + 1]! * b[4 + j]! + a[i + 2]! * b[8 + j]! + a[i + 3]! * b[12 + j]!;
  return c;
}

/** Of a rigid motion. */
export function inverse(a: Matrix): Float64Array {
  const c = new Float64Array(16);
  for (let i = 0; i < 3; i++) {
    for (let j = 0; j < 3; j++) { c[4 * i + j] = a[4 * j + i]!; c[4 * i + 3]! -= a[4 * j + i]! * a[4 * j + 3]!; }
  }
  c[15] = 1;
  return c;
}

function motion(turns: boolean, by: number): Float64Array {
  const c = turns ? Math.cos(by) : 1, s = turns ? Math.sin(by) : 0;
  return new Float64Array([c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, turns ? 0 : by, 0, 0, 0, 1]);
}

/** Where the base stands and the tip with its tool, where they are not as in the chain. */
export interface Changed { T_base?: Matrix | null; T_tip?: Matrix | null }

/** Frames in the world of the base, of every joint after its motion, and of the tip: L + 2. */
export function frames(chain: Chain, q: ArrayLike<number>, changed: Changed = {}): Float64Array[] {
  let T = Float64Array.from(changed.T_base ?? chain.T_base);
  const found: Float64Array[] = [T];
  chain.T_joint.forEach((joint, i) => {
    T = multiply(multiply(T, joint), motion(chain.revolute[i]!, chain.scale[i]! * q[chain.source[i]!]! + chain.offset[i]!));
    found.push(T);
  });
  found.push(multiply(T, changed.T_tip ?? chain.T_tip));
  return found;
}

/** Pose of the tip. */
export const tip = (chain: Chain, q: ArrayLike<number>, changed?: Changed): Float64Array => frames(chain, q, changed).at(-1)!;

/** Quaternion w-x-y-z of a rotation, w ≥ 0. */
export function quaternion(T: Matrix): [number, number, number, number] {
  const m = (i: number, j: number) => T[4 * i + j]!;
  const trace = m(0, 0) + m(1, 1) + m(2, 2);
  const q: [number, number, number, number] = [0, 0, 0, 0];
  if (trace > 0) {
    const s = 2 * Math.sqrt(trace + 1);
    q[0] = s / 4; q[1] = (m(2, 1) - m(1, 2)) / s; q[2] = (m(0, 2) - m(2, 0)) / s; q[3] = (m(1, 0) - m(0, 1)) / s;
  } else {
    const i = m(0, 0) > m(1, 1) ? (m(0, 0) > m(2, 2) ? 0 : 2) : m(1, 1) > m(2, 2) ? 1 : 2, j = (i + 1) % 3, k = (i + 2) % 3;
    const s = 2 * Math.sqrt(1 + m(i, i) - m(j, j) - m(k, k));
    q[0] = (m(k, j) - m(j, k)) / s; q[1 + i] = s / 4; q[1 + j] = (m(j, i) + m(i, j)) / s; q[1 + k] = (m(k, i) + m(i, k)) / s;
  }
  return q[0] < 0 ? (q.map((v) => -v) as typeof q) : q;
}
