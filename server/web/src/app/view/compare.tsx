/** Two results side by side: one camera, and if one likes the same colours; or the difference of their volumes. */

import { effect, type Signal } from "@preact/signals";
import { useEffect, useMemo, useState } from "preact/hooks";
import type { Api } from "../../sources/api";
import { jobSource } from "../../sources/served";
import { channelKey, type Settings } from "../../settings";
import type { Theme } from "../app";
import { message } from "../parts";
import { hashOf, packed } from "../route";
import { pictureOf } from "./job_view";
import type { Camera } from "../../scene/stage";
import type { ViewModel } from "./model";
import { Viewer } from "./viewer";

const SHARED = ["range", "colors", "slices"] as const;

export function Compare({ api, first, second, view, other, theme }: { api: Api; first: string; second: string; view: string | undefined; other: string | undefined; theme: Signal<Theme> }) {
  const sources = useMemo(() => [jobSource(api, first), jobSource(api, second)] as const, [api, first, second]);
  const [models, setModels] = useState<(ViewModel | null)[]>([null, null]), [cameras, setCameras] = useState(true), [colors, setColors] = useState(true), [said, setSaid] = useState("");
  const [a, b] = models;
  useEffect(() => { // who is moved moves the other
    if (!a || !b || !cameras) return;
    let known: Camera | null = null; // at first the left one's
    return effect(() => {
      const pair = [a.camera.value, b.camera.value];
      if (!a.ready.value || !b.ready.value) return;
      if (!known && !pair[0] && !pair[1] && a.stage) return b.look((known = a.stage.camera)); // nobody has moved yet
      const moved = pair.findIndex((each) => each && each !== known);
      if (moved < 0) return;
      known = pair[moved]!;
      (moved ? a : b).look(known);
    });
  }, [a, b, cameras]);
  useEffect(() => {
    if (!a || !b || !colors) return;
    const known: Partial<Record<(typeof SHARED)[number], unknown>> = {};
    return effect(() => {
      const pair = [a.settings.value, b.settings.value];
      if (!pair[0] || !pair[1]) return;
      for (const key of SHARED) {
        const moved = pair.findIndex((each) => known[key] !== undefined && each![key] !== known[key]);
        known[key] = pair[Math.max(0, moved)]![key];
        for (const [i, each] of pair.entries()) if (each![key] !== known[key]) [a, b][i]!.update({ [key]: known[key] } as Partial<Settings>);
      }
    });
  }, [a, b, colors]);
  const subtract = async () => {
    try {
      setSaid(await difference(a!, b!));
    } catch (error) {
      setSaid(message(error));
    }
  };
  useEffect(() => { // a link to the difference
    if (!a?.ready.value || !b?.ready.value || !a.shown) return;
    const { minus } = a.settings.value!.volumes[a.shown.name]!;
    if (minus && !a.volume(minus)) void subtract();
  }, [a?.ready.value, b?.ready.value]);
  const linkOf = async () => { // both, whichever is asked
    const [view = "", other = ""] = await Promise.all([a!, b!].map((each) => packed(each.whole())));
    return new URL(hashOf({ page: "compare", first, second, view, other }), location.href).href;
  };
  const keep = (i: number) => (model: ViewModel) => setModels((before) => before.map((each, k) => (k === i ? model : each)));
  return (
    <>
      <div class="bar pad">
        <label class="tick"><input type="checkbox" checked={cameras} onChange={(e) => setCameras(e.currentTarget.checked)} />One camera</label>
        <label class="tick"><input type="checkbox" checked={colors} onChange={(e) => setColors(e.currentTarget.checked)} />One range of colours, the same slices</label>
        <button disabled={!a?.ready.value || !b?.ready.value} onClick={subtract}>Difference, on the left</button>
        <span role="status" class="help">{said}</span>
      </div>
      <div class="both">
        <Viewer source={sources[0]} named={first.slice(0, 8)} theme={theme} view={view} panels={false} linkOf={linkOf} onModel={keep(0)} picture={(url) => pictureOf(api, first, url)} />
        <Viewer source={sources[1]} named={second.slice(0, 8)} theme={theme} view={other} panels={false} linkOf={linkOf} onModel={keep(1)} picture={(url) => pictureOf(api, second, url)} />
      </div>
    </>
  );
}

/** The second result's volume is brought into the first view, and taken away there, voxel by voxel. */
async function difference(a: ViewModel, b: ViewModel): Promise<string> {
  const mine = a.shown, other = b.shown;
  if (!mine || !other) return "One of them has no volume.";
  if (Math.abs(mine.voxel_size_m / other.voxel_size_m - 1) > 1e-9) return `Their voxels differ: ${mine.voxel_size_m} m and ${other.voxel_size_m} m; a difference needs one lattice.`;
  const channel = a.settings.value!.volumes[mine.name]!.channel;
  if (channel && !other.channels.some((each) => channelKey(each) === channel)) return `The second has no channel ${channel.replace(":", " of ")}.`;
  const name = `other ${other.name}`, { coarser: _, ...whole } = other;
  const names = [other.occupancy.blob, ...other.channels.map((each) => each.data.blob)];
  const blobs = Object.fromEntries(await Promise.all(names.map(async (each) => [each, await b.source.blob(each)] as const)));
  await a.add({ ...whole, name, label: `${other.label} of the second` }, blobs, { ...a.settings.value!.volumes[mine.name]!, visible: false, minus: "" });
  if (a.settings.value!.volumes[mine.name]!.minus !== name) a.update({ range: { ...a.settings.value!.range, low: null, high: null } });
  a.setVolume(mine.name, { minus: name });
  return "On the left: the first minus the second, where both are.";
}
