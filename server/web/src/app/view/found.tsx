/** What was found: the voxel that was clicked, distances, headline, warnings, what was left out. */

import { useState } from "preact/hooks";
import { titled } from "../../scene/colors";
import { words } from "../form/schema";
import { number } from "../parts";
import { Section, Value } from "./controls";
import type { ViewModel } from "./model";

export function Found({ model }: { model: ViewModel }) {
  const settings = model.settings.value!, voxel = model.voxel.value, { measure } = settings;
  const distance = measure.length === 2 ? Math.hypot(...measure[0]!.map((each, k) => each - measure[1]![k]!)) : null;
  return (
    <Section title="Selected" open>
      {!voxel ? (
        <>
          {model.shown && <p class="help">Click a voxel of the volume: its values come here{model.canAsk && model.manifest.value!.robots.length ? ", and the robot moves there where samples are kept" : ""}.</p>}
          {model.canAsk && model.manifest.value!.maps.length > 0 && <p class="help">Click a cell of a map: the robot stands there.</p>}
        </>
      ) : (
        <>
          <dl class="values" data-voxel={settings.selected?.cell.join(" ")}>
            <dt>Centre [m]</dt><dd class="mono">{voxel.center_m.map((each) => number(each, 4)).join(", ")}</dd>
            {Number.isFinite(voxel.count) && <><dt>Samples</dt><dd>{voxel.count}</dd></>}
            {voxel.values.filter((each) => each.statistic !== "count").map((each) => <><dt title={each.label}>{titled(each)}</dt><dd data-value={`${each.statistic}:${each.name}`} data-exact={String(each.value)}>{number(each.value, 6)}</dd></>)}
          </dl>
          {voxel.rounded && <p class="help">These values are rounded to 16 bits.</p>}
          {voxel.sample !== null && <p class="help">Best posture: sample {voxel.sample}.</p>}
          <button onClick={() => { model.update({ selected: null }); model.voxel.value = null; }}>Forget it</button>
        </>
      )}
      {model.shown && <Place model={model} />}
      {model.placed.value && <><h3>Where the robot stands</h3><dl class="values">{model.placed.value.map((each) => <><dt title={each.label}>{titled(each)}</dt><dd>{number(each.value)}</dd></>)}</dl></>}
      <div class="wrap">
        <button aria-pressed={model.measuring.value} onClick={() => { model.measuring.value = !model.measuring.value; if (model.measuring.value) model.update({ measure: [] }); }}>Measure</button>
        {measure.length > 0 && <button onClick={() => model.update({ measure: [] })}>Clear</button>}
        {model.measuring.value && measure.length < 2 && <span class="help">Click {measure.length ? "the second point" : "two points"}.</span>}
        {distance !== null && <strong data-distance={distance}>{number(distance, 4)} m</strong>}
      </div>
    </Section>
  );
}

/** A voxel by the coordinates of a point in it: for the keyboard. */
function Place({ model }: { model: ViewModel }) {
  const [point, setPoint] = useState<(number | null)[]>([null, null, null]);
  return (
    <form class="wrap" onSubmit={(e) => { e.preventDefault(); if (point.every((each) => each !== null)) void model.selectAt(point as [number, number, number]); }}>
      <span class="triple">{["x", "y", "z"].map((axis, k) => <Value key={axis} label={`${axis} of a place [m]`} value={point[k] ?? null} placeholder={axis} onChange={(value) => setPoint(point.map((each, n) => (n === k ? value : each)))} />)}</span>
      <button type="submit" disabled={point.some((each) => each === null)}>Look there</button>
    </form>
  );
}

export function About({ model }: { model: ViewModel }) {
  const manifest = model.manifest.value!;
  return (
    <Section title="About">
      <dl class="values"><dt>Analysis</dt><dd>{words(manifest.analysis)}</dd>{manifest.headline.map((each) => <><dt>{each.label}</dt><dd>{each.value}</dd></>)}</dl>
      {manifest.warnings.map((each) => <p class="notice">{each}</p>)}
      {manifest.omitted.length > 0 && <><h3>Left out</h3><ul>{manifest.omitted.map((each) => <li class="help">{each}</li>)}</ul></>}
    </Section>
  );
}
