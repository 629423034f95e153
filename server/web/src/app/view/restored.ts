/** The settings of a link over those that a view begins with: whatever a link says, each is of its kind in the end. */

import type { Manifest } from "../../contract";
import { MAPS } from "../../scene/colors";
import type { Range, Settings, VolumeSettings } from "../../settings";

type Is = (value: unknown) => boolean;

const THEMES = ["light", "dark", "system"] as const;
const MOST_SLICES = 3; // as the panel has them
const number: Is = Number.isFinite, text: Is = (value) => typeof value === "string", yes: Is = (value) => typeof value === "boolean";
const oneOf = (...names: unknown[]): Is => (value) => names.includes(value);
const orNull = (is: Is): Is => (value) => value === null || is(value);
const list = (is: Is, least = 0, most = least || Infinity): Is => (value) => Array.isArray(value) && value.length >= least && value.length <= most && value.every(is);
const object = (value: unknown): value is Record<string, unknown> => typeof value === "object" && value !== null && !Array.isArray(value);
const fields = (each: Record<string, Is>): Is => (value) => object(value) && Object.entries(each).every(([name, is]) => is(value[name]));
const vector = list(number, 3), matrix = list(number, 16), share: Is = (value) => number(value) && (value as number) >= 0 && (value as number) <= 1;

const LAYER = { visible: yes, opacity: share };
const VOLUME: Record<keyof VolumeSettings, Is> = {
  ...LAYER, style: oneOf("surface", "translucent", "isosurface", "cells", "points"), channel: text, threshold: orNull(number), minus: text,
  cut: list(fields({ axis: oneOf("x", "y", "z"), from_m: orNull(number), to_m: orNull(number) })),
};
const RANGE = { low: orNull(number), high: orNull(number), scale: oneOf("linear", "log"), clipped: yes };
const apart: Is = (camera) => { // an eye that looks somewhere
  const { position, target } = camera as NonNullable<Settings["camera"]>;
  return position.some((each, k) => each !== target[k]);
};
const camera: Is = (value) => fields({ position: vector, target: vector, up: vector, orthographic: yes })(value) && apart(value);
const WHOLE: Partial<Record<keyof Settings, Is>> = {
  theme: oneOf(...THEMES), camera: orNull(camera), colors: oneOf(...MAPS), measure: list(vector, 0, 2),
  slices: list(fields({ axis: oneOf("x", "y", "z", "oblique"), at_m: number, normal: vector, visible: yes }), 0, MOST_SLICES),
  mapping: orNull(fields({ scale: (value) => number(value) || vector(value), offset_m: vector })), selected: orNull(fields({ volume: text, cell: list(Number.isInteger, 3) })),
};

/** By the keys of today, and of today's view: what an older page did not know, or nobody could have set, is as at first. */
export function restored(first: Settings, link: unknown, { robots }: Manifest): Settings {
  if (!object(link)) return first;
  const settings: Settings = { ...first, ...known<Settings>(link, WHOLE) }, said = (name: keyof Settings): Record<string, unknown> => (object(link[name]) ? link[name] : {});
  if (!first.mapping) settings.mapping = null;
  settings.range = { ...first.range, ...known<Range>(said("range"), RANGE) };
  settings.layers = { ...first.layers, ...entries(said("layers"), fields(LAYER)) };
  settings.channels = { ...first.channels, ...entries(said("channels"), text) };
  const volumes = said("volumes"), plain = Object.values(first.volumes)[0];
  const live = robots.map((_, robot) => `live_${robot}`).filter((name) => object(volumes[name])); // they are computed again
  settings.volumes = Object.fromEntries([...Object.keys(first.volumes), ...live].map((name) => [name, { ...(first.volumes[name] ?? plain!), ...known<VolumeSettings>(volumes[name], VOLUME) }]));
  settings.configurations = ofRobots("configurations", (robot) => list(number, robots[robot]!.home.length));
  settings.placements = ofRobots("placements", () => orNull(matrix));
  settings.tools = ofRobots("tools", () => orNull(matrix));
  settings.samples = ofRobots("samples", () => orNull((value) => Number.isInteger(value) && (value as number) > 0));
  settings.limits = ofRobots("limits", () => object).map((each, robot) => entries(each, (range, joint) => robots[robot]!.chain.joints.includes(joint) && list(number, 2)(range)));
  return settings;

  function ofRobots<T extends "configurations" | "placements" | "tools" | "limits" | "samples">(name: T, is: (robot: number) => Is): Settings[T] {
    const given = link as Record<string, unknown>, values = Array.isArray(given[name]) ? (given[name] as unknown[]) : [];
    return first[name].map((home, robot) => (is(robot)(values[robot]) ? values[robot] : home)) as Settings[T];
  }
}

/** The fields that are of their kind. */
function known<T>(value: unknown, each: Partial<Record<keyof T, Is>>): Partial<T> {
  return (object(value) ? Object.fromEntries(Object.entries<Is | undefined>(each as Record<string, Is>).filter(([name, is]) => name in value && is!(value[name])).map(([name]) => [name, value[name]])) : {}) as Partial<T>;
}

/** The entries, of whatever names, that are of a kind. */
function entries<T>(value: Record<string, unknown>, is: (item: unknown, name: string) => boolean): Record<string, T> {
  return Object.fromEntries(Object.entries(value).filter(([name, item]) => is(item, name))) as Record<string, T>;
}

/** The theme that a link asks for, if any. */
export const themeOf = (link: unknown): Settings["theme"] | undefined => THEMES.find((each) => object(link) && each === link.theme);
