/** The job document of what was dragged. */

import type { Chain } from "../../contract";
import { inverse, multiply, quaternion } from "../../scene/kinematics";
import { ARMS, type Json, type JsonObject } from "../form/schema";

interface Changed { limits: Record<string, [number, number]>; tool?: number[]; placement?: number[] }

/** Where in a document a view's robot is; null: nowhere. */
function pathOf(job: JsonObject, robot: number): string[] | null {
  if (Array.isArray(job.robots)) return robot < job.robots.length ? ["robots", String(robot), "robot"] : null;
  const names = ARMS.find((each) => job[each[0]!] != null), name = names?.[robot];
  if (name === undefined) return null;
  const held = job[name];
  return name !== "robot" && typeof held === "object" && held !== null && "robot" in held ? [name, "robot"] : [name];
}

function at(job: JsonObject, path: string[]): Json | undefined {
  return path.reduce<Json | undefined>((value, step) => (value as Record<string, Json> | undefined)?.[step], job);
}

function put(value: Json, [step, ...rest]: string[], item: Json): Json {
  if (step === undefined) return item;
  if (Array.isArray(value)) return value.map((each, i) => (String(i) === step ? put(each, rest, item) : each));
  return { ...(value as JsonObject), [step]: put((value as Record<string, Json>)[step] ?? {}, rest, item) };
}

/** The document with a robot's limits, tool and placement; null where it has no such robot. */
export function changedJob(job: unknown, robot: number, changes: Changed, chain: Chain): JsonObject | null {
  if (typeof job !== "object" || job === null) return null;
  const document = job as JsonObject, path = pathOf(document, robot);
  return path && (put(document, path, changed(at(document, path), changes, chain)) as JsonObject);
}

/** The tool of the document, in the frame of the tip; none: as if it were at the tip. */
function toolIn(job: unknown, robot: number): number[] {
  const path = typeof job === "object" && job !== null ? pathOf(job as JsonObject, robot) : null;
  const spec = path && at(job as JsonObject, path), tool = spec && typeof spec === "object" ? (spec as JsonObject).tool : null;
  return matrixOf((tool ?? {}) as JsonObject);
}

/** What `T_tip` of the chain is as the engine asks for it: the tool in the frame of the tip. */
export function toolOf(job: unknown, robot: number, chain: Chain, T_tip: number[]): number[] {
  return [...multiply(multiply(toolIn(job, robot), inverse(chain.T_tip)), T_tip)];
}

/** The chain's `T_tip` of a tool in the frame of the tip. */
export function tipOf(job: unknown, robot: number, chain: Chain, tool: number[]): number[] {
  return [...multiply(multiply(chain.T_tip, inverse(toolIn(job, robot))), tool)];
}

/** Of a document's transform. */
function matrixOf({ position_m, quat_wxyz, rpy_deg, euler_xyz_deg }: JsonObject): number[] {
  const [x = 0, y = 0, z = 0] = (position_m ?? []) as number[], about = (axis: number, degrees: number) => {
    const c = Math.cos((degrees * Math.PI) / 180), s = Math.sin((degrees * Math.PI) / 180), T = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
    T[5 * i] = T[5 * j] = c;
    T[4 * i + j] = -s;
    T[4 * j + i] = s;
    return T;
  };
  let R: ArrayLike<number> = about(0, 0);
  if (Array.isArray(quat_wxyz)) {
    const length = Math.hypot(...(quat_wxyz as number[])), [w, i, j, k] = (quat_wxyz as number[]).map((each) => each / length) as [number, number, number, number];
    R = [1 - 2 * (j * j + k * k), 2 * (i * j - k * w), 2 * (i * k + j * w), 0, 2 * (i * j + k * w), 1 - 2 * (i * i + k * k), 2 * (j * k - i * w), 0, 2 * (i * k - j * w), 2 * (j * k + i * w), 1 - 2 * (i * i + j * j), 0, 0, 0, 0, 1];
  } else if (Array.isArray(rpy_deg)) R = multiply(multiply(about(2, rpy_deg[2] as number), about(1, rpy_deg[1] as number)), about(0, rpy_deg[0] as number));
  else if (Array.isArray(euler_xyz_deg)) R = multiply(multiply(about(0, euler_xyz_deg[0] as number), about(1, euler_xyz_deg[1] as number)), about(2, euler_xyz_deg[2] as number));
  const T = Array.from(R);
  [T[3], T[7], T[11]] = [x, y, z];
  return T;
}

function changed(spec: Json | undefined, { limits, tool, placement }: Changed, chain: Chain): JsonObject {
  const robot: JsonObject = typeof spec === "string" ? { library: spec } : { ...(spec as JsonObject) };
  const degrees = robot.limits_deg as JsonObject | undefined; // a joint has its limits once
  if (degrees) robot.limits_deg = Object.fromEntries(Object.entries(degrees).filter(([joint]) => !(joint in limits)));
  const own = Object.fromEntries(Object.entries(limits).filter(([joint]) => chain.joints.includes(joint)));
  robot.limits = { ...(robot.limits as JsonObject | undefined), ...own };
  if (tool) robot.tool = pose(tool);
  if (placement) robot.placement = pose(placement);
  return robot;
}

function pose(T: number[]): JsonObject {
  return { position_m: [T[3]!, T[7]!, T[11]!], quat_wxyz: quaternion(T) };
}
