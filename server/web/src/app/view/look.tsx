/** What the view looks like: layers, volume, colours, slices, cuts, mapping. */

import type { Channel, Vector, Volume } from "../../contract";
import { MAPS, titled } from "../../scene/colors";
import { channelKey as keyOf, type Layer, type Slice, type VolumeSettings } from "../../settings";
import { words } from "../form/schema";
import { number } from "../parts";
import { Section, Select, Slide, Tick, Value } from "./controls";
import type { ViewModel } from "./model";

const STYLES: { value: VolumeSettings["style"]; label: string }[] = [
  { value: "surface", label: "surface" }, { value: "translucent", label: "translucent" }, { value: "isosurface", label: "iso-surface" },
  { value: "cells", label: "voxels, exact colours" }, { value: "points", label: "points" },
];
const AXES = ["x", "y", "z"] as const;

/** Whose colours the range is of: the volume that is shown, else the first points or map. */
export function channelOf(model: ViewModel): Channel | undefined {
  const volume = model.shown, settings = model.settings.value!;
  if (volume && (settings.volumes[volume.name]?.visible || settings.slices.some((each) => each.visible))) return volume.channels.find((each) => keyOf(each) === settings.volumes[volume.name]!.channel);
  return paintedIn(model).filter((each) => settings.layers[each.name]?.visible ?? true).map((each) => paintOf(model, each)).find((each) => !each.categories);
}

function paintedIn(model: ViewModel): { name: string; label: string; channels: Channel[] }[] {
  const { points, maps } = model.manifest.value!;
  return [...points, ...maps].filter((each) => each.channels.length > 0);
}

function paintOf(model: ViewModel, of: { name: string; channels: Channel[] }): Channel {
  return of.channels.find((each) => keyOf(each) === model.settings.value!.channels[of.name]) ?? of.channels[0]!;
}

/** What the colours of points and maps say. */
export function Painted({ model }: { model: ViewModel }) {
  const { layers, channels } = model.settings.value!, painted = paintedIn(model).filter((each) => each.channels.length > 1 && (layers[each.name]?.visible ?? true));
  if (!painted.length) return null;
  return (
    <Section title="Points and maps" open>
      {painted.map((each) => <Select key={each.name} label={each.label} value={keyOf(paintOf(model, each))} options={each.channels.map((channel) => ({ value: keyOf(channel), label: titled(channel) }))}
        onChange={(channel) => model.update({ channels: { ...channels, [each.name]: channel }, range: { ...model.settings.value!.range, low: null, high: null } })} />)}
    </Section>
  );
}

/** Lower and upper corner [m]. */
export function boxOf(volume: Volume): [Vector, Vector] {
  const low = volume.first_voxel.map((each) => each * volume.voxel_size_m) as Vector;
  return [low, low.map((each, axis) => each + volume.shape[axis]! * volume.voxel_size_m) as Vector];
}

export function Layers({ model }: { model: ViewModel }) {
  const settings = model.settings.value!, manifest = model.manifest.value!;
  const keys: [string, string][] = [
    ...manifest.robots.map((each, i): [string, string] => [`robot:${i}`, manifest.robots.some((other, k) => k !== i && other.name === each.name) ? `${each.name} (${i + 1})` : each.name]),
    ...[...manifest.meshes, ...manifest.points, ...manifest.glyphs, ...manifest.curves, ...manifest.maps].map((each): [string, string] => [each.name, each.label]),
    ...manifest.skeletons.map((each): [string, string] => [each.name, words(each.name)]),
    ["axes", "Axes"], ["frames", "Frames"], ["scale_bar", "Scale bar"],
  ];
  const layerOf = (key: string): Layer => settings.layers[key] ?? { visible: key !== "frames", opacity: 1 };
  const put = (key: string, patch: Partial<Layer>) => model.update({ layers: { ...settings.layers, [key]: { ...layerOf(key), ...patch } } });
  const row = (key: string, label: string, layer: Layer, change: (patch: Partial<Layer>) => void) => (
    <div class="layer" key={key}>
      <input type="checkbox" aria-label={`Show ${label}`} checked={layer.visible} onChange={(e) => change({ visible: e.currentTarget.checked })} />
      <span title={label}>{label}</span>
      <input type="range" aria-label={`Opacity of ${label}`} min={0.05} max={1} step={0.05} value={layer.opacity} disabled={!layer.visible} onInput={(e) => change({ opacity: Number(e.currentTarget.value) })} />
    </div>
  );
  return (
    <Section title="Layers" open>
      {model.volumes.map((each) => settings.volumes[each.name] && row(`volume ${each.name}`, each.label, settings.volumes[each.name]!, (patch) => model.setVolume(each.name, patch)))}
      {keys.map(([key, label]) => row(key, label, layerOf(key), (patch) => put(key, patch)))}
    </Section>
  );
}

export function VolumePanel({ model }: { model: ViewModel }) {
  const volume = model.shown, settings = volume && model.settings.value!.volumes[volume.name];
  if (!volume || !settings) return null;
  const channel = channelOf(model), put = (patch: Partial<VolumeSettings>) => model.setVolume(volume.name, patch);
  const others = model.volumes.filter((each) => each !== volume && Math.abs(each.voxel_size_m / volume.voxel_size_m - 1) < 1e-9);
  const low = channel?.minimum ?? 0, high = channel?.maximum ?? 1;
  return (
    <Section title="Volume" open>
      {model.volumes.length > 1 && <p class="help">{volume.label}</p>}
      <Select label="Style" value={settings.style} options={STYLES} onChange={(style) => put({ style, threshold: style === "isosurface" ? (low + high) / 2 : null })} />
      <Select label="Channel" value={settings.channel} options={[...volume.channels.map((each) => ({ value: keyOf(each), label: titled(each) })), { value: "", label: "where it is occupied" }]} onChange={(next) => { put({ channel: next, threshold: null }); model.update({ range: { ...model.settings.value!.range, low: null, high: null } }); }} />
      {channel && !channel.categories && <Slide label="Threshold" value={settings.threshold ?? (settings.style === "isosurface" ? (low + high) / 2 : low)} low={low} high={high} unit={channel.unit === "1" ? "" : channel.unit} onChange={(threshold) => put({ threshold })} />}
      {others.length > 0 && <Select label="Minus" value={settings.minus} options={[{ value: "", label: "nothing" }, ...others.map((each) => ({ value: each.name, label: each.label }))]} onChange={(minus) => put({ minus })} />}
      {volume.reduced && <p class="notice">{volume.reduced}</p>}
    </Section>
  );
}

export function Colors({ model }: { model: ViewModel }) {
  const settings = model.settings.value!, { range } = settings, channel = channelOf(model);
  const put = (patch: Partial<typeof range>) => model.update({ range: { ...range, ...patch } });
  return (
    <Section title="Colours" open>
      <Select label="Colour map" value={settings.colors} options={MAPS.map((each) => ({ value: each, label: each }))} onChange={(colors) => model.update({ colors })} />
      {channel && !channel.categories && <>
        <Select label="Scale" value={range.scale} options={[{ value: "linear", label: "linear" }, { value: "log", label: "logarithmic" }]} onChange={(scale) => put({ scale })} />
        <div class="line"><span>Range</span>
          <span class="pair">
            <Value label="Lower end of the range" value={range.low} placeholder={number(channel.minimum, 3)} onChange={(low) => put({ low })} />
            <Value label="Upper end of the range" value={range.high} placeholder={number(channel.maximum, 3)} onChange={(high) => put({ high })} />
          </span>
        </div>
        <Slide label="From" name="Lower end" value={range.low ?? channel.minimum} low={channel.minimum} high={channel.maximum} onChange={(low) => put({ low })} />
        <Slide label="To" name="Upper end" value={range.high ?? channel.maximum} low={channel.minimum} high={channel.maximum} onChange={(high) => put({ high })} />
        <Tick label="Leave out outliers" value={range.clipped} onChange={(clipped) => put({ clipped })} />
        <button onClick={() => put({ low: null, high: null })} disabled={range.low === null && range.high === null}>Whole range</button>
      </>}
    </Section>
  );
}

export function Slices({ model }: { model: ViewModel }) {
  const settings = model.settings.value!, volume = model.shown;
  if (!volume) return null;
  const [low, high] = boxOf(volume), middle = low.map((each, axis) => (each + high[axis]!) / 2) as Vector;
  const put = (i: number, patch: Partial<Slice>) => model.update({ slices: settings.slices.map((each, k) => (k === i ? { ...each, ...patch } : each)) });
  const ends = (slice: Slice): [number, number] => {
    if (slice.axis !== "oblique") return [low[AXES.indexOf(slice.axis)]!, high[AXES.indexOf(slice.axis)]!];
    const length = Math.hypot(...slice.normal) || 1, corners = [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => AXES.reduce((sum, _, axis) => sum + (slice.normal[axis]! / length) * ((bits >> axis) & 1 ? high : low)[axis]!, 0));
    return [Math.min(...corners), Math.max(...corners)];
  };
  return (
    <Section title="Slices" open={settings.slices.some((each) => each.visible)}>
      {settings.slices.map((slice, i) => {
        const [from, to] = ends(slice);
        return (
          <fieldset key={i} class="group">
            <legend>Slice {i + 1}</legend>
            <Tick label="Shown" value={slice.visible} onChange={(visible) => put(i, { visible })} />
            <Select label="Across" value={slice.axis} options={[...AXES.map((each) => ({ value: each as Slice["axis"], label: each })), { value: "oblique", label: "oblique" }]} onChange={(axis) => put(i, { axis, at_m: axis === "oblique" ? AXES.reduce((sum, _, k) => sum + (slice.normal[k]! / (Math.hypot(...slice.normal) || 1)) * middle[k]!, 0) : middle[AXES.indexOf(axis)]! })} />
            <Slide label="At" name={`Slice ${i + 1}, place`} unit="m" value={slice.at_m} low={from} high={to} step={volume.voxel_size_m / 2} onChange={(at_m) => put(i, { at_m })} />
            {slice.axis === "oblique" && AXES.map((axis, k) => <Slide key={axis} label={`Normal ${axis}`} value={slice.normal[k]!} low={-1} high={1} step={0.01} onChange={(value) => put(i, { normal: slice.normal.map((each, n) => (n === k ? value : each)) as Vector })} />)}
            <button onClick={() => model.update({ slices: settings.slices.filter((_, k) => k !== i) })}>Remove</button>
          </fieldset>
        );
      })}
      <button disabled={settings.slices.length >= 3} onClick={() => model.update({ slices: [...settings.slices, { axis: AXES[settings.slices.length % 3]!, at_m: middle[settings.slices.length % 3]!, normal: [1, 1, 0], visible: true }] })}>Add a slice</button>
    </Section>
  );
}

export function Cuts({ model }: { model: ViewModel }) {
  const volume = model.shown, settings = volume && model.settings.value!.volumes[volume.name];
  if (!volume || !settings) return null;
  const [low, high] = boxOf(volume);
  return (
    <Section title="Cut open">
      {AXES.map((axis, k) => {
        const cut = settings.cut.find((each) => each.axis === axis) ?? { axis, from_m: null, to_m: null };
        const put = (patch: Partial<typeof cut>) => {
          const next = { ...cut, ...patch }, rest = settings.cut.filter((each) => each.axis !== axis);
          if (next.from_m !== null && next.from_m <= low[k]!) next.from_m = null;
          if (next.to_m !== null && next.to_m >= high[k]!) next.to_m = null;
          model.setVolume(volume.name, { cut: next.from_m === null && next.to_m === null ? rest : [...rest, next] });
        };
        return (
          <div key={axis}>
            <Slide label={`${axis} from`} name={`Cut ${axis} from`} unit="m" value={cut.from_m ?? low[k]!} low={low[k]!} high={high[k]!} step={volume.voxel_size_m / 2} onChange={(from_m) => put({ from_m })} />
            <Slide label={`${axis} to`} name={`Cut ${axis} to`} unit="m" value={cut.to_m ?? high[k]!} low={low[k]!} high={high[k]!} step={volume.voxel_size_m / 2} onChange={(to_m) => put({ to_m })} />
          </div>
        );
      })}
      <button disabled={settings.cut.length === 0} onClick={() => model.setVolume(volume.name, { cut: [] })}>Whole</button>
    </Section>
  );
}

export function MappingPanel({ model }: { model: ViewModel }) {
  const { mapping } = model.manifest.value!;
  if (!mapping) return null;
  const own = model.settings.value!.mapping ?? { scale: mapping.scale, offset_m: mapping.offset_m };
  const volume = model.shown, [low, high] = volume ? boxOf(volume) : [[-1, -1, -1], [1, 1, 1]], reach = Math.max(...high.map((each, k) => each - low[k]!));
  const first = typeof mapping.scale === "number" ? [mapping.scale, mapping.scale, mapping.scale] : mapping.scale;
  const slider = (label: string, value: number, around: number, put: (value: number) => number | Vector) => <Slide key={label} label={label} value={value} low={around / 4} high={around * 4} onChange={(next) => model.update({ mapping: { ...own, scale: put(next) } })} />;
  return (
    <Section title="Mapping" open>
      {typeof own.scale === "number" ? slider("Scale", own.scale, first[0]!, (scale) => scale) : AXES.map((axis, k) => slider(`Scale ${axis}`, (own.scale as Vector)[k]!, first[k]!, (value) => (own.scale as Vector).map((each, n) => (n === k ? value : each)) as Vector))}
      {AXES.map((axis, k) => <Slide key={axis} label={`Offset ${axis}`} unit="m" value={own.offset_m[k]!} low={mapping.offset_m[k]! - reach} high={mapping.offset_m[k]! + reach} onChange={(value) => model.update({ mapping: { ...own, offset_m: own.offset_m.map((each, n) => (n === k ? value : each)) as Vector } })} />)}
      <button onClick={() => model.update({ mapping: null })} disabled={!model.settings.value!.mapping}>As in the result</button>
    </Section>
  );
}
