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

/** What `T_tip` of the chain is as the engine asks for it: the tool in the frame of the tip. */
export function toolOf(chain: Chain, T_tip: number[]): number[] {
  return [...multiply(multiply(chain.T_tool, inverse(chain.T_tip)), T_tip)];
}

/** The chain's `T_tip` of a tool in the frame of the tip. */
export function tipOf(chain: Chain, tool: number[]): number[] {
  return [...multiply(multiply(chain.T_tip, inverse(chain.T_tool)), tool)];
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
