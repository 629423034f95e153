/** Robots: their joints, the tool's gizmo, all postures of a pose, and what is changed by dragging. */

import { useState } from "preact/hooks";
import type { Vector } from "../../contract";
import { titled } from "../../scene/colors";
import { words, type JsonObject } from "../form/schema";
import { number } from "../parts";
import { Section, Slide, Tick } from "./controls";
import { boxOf } from "./look";
import { changedJob, tipOf, toolOf } from "./changed_job";
import type { ViewModel } from "./model";

const DEG = 180 / Math.PI;
const UNLIMITED = [-Math.PI, Math.PI] as const;

/** Limits of a joint as they are shown: [°] of hinges, [m] of slides. */
function shownLimits(lower: number | null, upper: number | null, angle: boolean): [number, number] {
  const [low, high] = [lower ?? (angle ? UNLIMITED[0] : -1), upper ?? (angle ? UNLIMITED[1] : 1)];
  return angle ? [low * DEG, high * DEG] : [low, high];
}

export interface RobotsProps { model: ViewModel; onJob?: ((document: JsonObject) => void) | undefined; jobLabel?: string; open?: boolean }

export function Robots({ model, onJob, jobLabel = "Submit as a job …", open = true }: RobotsProps) {
  const { robots } = model.manifest.value!;
  return <>{robots.map((robot, i) => <OneRobot key={i} model={model} number_={i} title={robots.length > 1 ? `Robot ${i + 1}: ${robot.name}` : `Robot: ${robot.name}`} onJob={onJob} jobLabel={jobLabel} open={open && i === 0} />)}</>;
}

function OneRobot({ model, number_: i, title, onJob, jobLabel, open }: RobotsProps & { number_: number; title: string }) {
  const { chain, home, samples } = model.robot(i), settings = model.settings.value!, q = settings.configurations[i] ?? home;
  const reach = model.reach.value, postures = model.postures.value, indices = model.indices.value;
  const motion = postures?.robot === i ? postures.postures[postures.at]?.curve : null;
  const [sample, setSample] = useState(-1);
  const room = model.shown ? boxOf(model.shown) : [0, 1].map((side) => [0, 1, 2].map((k) => chain.T_base[4 * k + 3]! + 2 * side - 1)); // for the tool [m]
  const T = model.frameOfTip(i);
  return (
    <Section title={title} open={open}>
      {chain.joints.map((joint, k) => {
        const angle = chain.angle[k]!, [low, high] = shownLimits(chain.lower[k] ?? null, chain.upper[k] ?? null, angle), scale = angle ? DEG : 1;
        return <Slide key={joint} label={joint} name={`Joint ${joint}`} unit={angle ? "°" : "m"} value={q[k]! * scale} low={low} high={high}
          onChange={(value) => model.moveByHand(i, q.map((each, n) => (n === k ? Math.min(high, Math.max(low, value)) / scale : each)))} />;
      })}
      <div class="wrap">
        <button onClick={() => model.moveByHand(i, home)}>Home</button>
        {samples && <button onClick={() => { const next = (sample + 1) % samples.configurations.length; setSample(next); model.moveByHand(i, samples.configurations[next]!); }}>Next sample</button>}
        {model.canAsk && <button aria-pressed={model.gizmo.value === i} onClick={() => model.setGizmo(model.gizmo.value === i ? null : i)}>Drag the tool</button>}
        {model.canAsk && <button onClick={() => void model.askPostures(i)}>Other postures</button>}
      </div>
      {samples && <p class="help">Samples: {words(samples.said).toLowerCase()}{sample >= 0 ? `, ${sample + 1} of ${samples.configurations.length}` : ""}</p>}
      {model.gizmo.value === i && <p class={`reach ${reach ? (reach.label === "reachable" ? "yes" : "no") : ""}`} data-reach={reach?.label ?? ""}><span class="hidden">Tool: </span>{reach ? (reach.label === "reachable" ? "Reachable" : `${reach.label.charAt(0).toUpperCase()}${reach.label.slice(1)}: ${reach.reason}`) : "Drag the tool's arrows or rings."}</p>}
      {model.gizmo.value === i && ["x", "y", "z"].map((axis, k) => <Slide key={axis} label={`Tool at ${axis}`} unit="m" value={T[4 * k + 3]!} low={room[0]![k]!} high={room[1]![k]!} step={0.005} onChange={(value) => void model.reachFor(i, { ...model.tip(i), position_m: [0, 1, 2].map((n) => (n === k ? value : T[4 * n + 3]!)) as Vector })} />)}
      {model.gizmo.value === i && <Tick label="Turn it instead of moving it" value={model.turning.value} onChange={(turns) => { model.turning.value = turns; model.setGizmo(i); }} />}
      {postures?.robot === i && (
        <div class="wrap" role="group" aria-label="Postures">
          <button onClick={() => model.stepPosture(-1)} disabled={!postures.postures.length} aria-label="Previous posture">‹</button>
          <span>{postures.postures.length ? `${postures.at + 1} of ${postures.postures.length}` : postures.reason || "none"}</span>
          <button onClick={() => model.stepPosture(1)} disabled={!postures.postures.length} aria-label="Next posture">›</button>
          {postures.families > 0 && <span class="help">{postures.families === postures.postures.length ? "each of a family" : `${postures.families} of them of a family`}</span>}
          {postures.postures[postures.at]?.said && <p class="help">{postures.postures[postures.at]!.said}</p>}
        </div>
      )}
      {motion && (
        <>
          <Slide label="Along it" name="Along the self-motion" value={postures!.along + 1} low={1} high={motion.configurations.length} step={1} onChange={(value) => model.stepAlong(Math.min(motion.configurations.length, Math.max(1, Math.round(value))) - 1)} />
          <p class="help">{`The joints' ways are drawn while the tip stands: step ${postures!.along + 1} of ${motion.configurations.length}, ${motion.reasons[postures!.along] ? `blocked by ${motion.reasons[postures!.along]}` : "free"}.`}</p>
        </>
      )}
      <dl class="values">
        <dt>Tip [m]</dt><dd class="mono" data-tip={[T[3], T[7], T[11]].join(" ")}>{[T[3]!, T[7]!, T[11]!].map((each) => each.toFixed(4)).join(", ")}</dd>
      </dl>
      {indices?.robot === i && (
        <details>
          <summary>Indices of this configuration</summary>
          <dl class="values">{indices.values.map((each) => <><dt title={each.label}>{titled(each)}</dt><dd>{number(each.value)}</dd></>)}</dl>
        </details>
      )}
      {model.canAsk && <Changes model={model} i={i} onJob={onJob} jobLabel={jobLabel} />}
    </Section>
  );
}

/** What the volume follows while it is dragged. */
function Changes({ model, i, onJob, jobLabel }: RobotsProps & { i: number }) {
  const [open, setOpen] = useState(model.isChanged(i));
  const settings = model.settings.value!, { chain } = model.robot(i), live = model.live.value, changed = model.isChanged(i), limits = settings.limits[i] ?? {};
  const job = changed && onJob ? changedJob(model.manifest.value!.job, i, model.changes(i), chain) : null;
  const own = toolOf(chain, settings.tools[i] ?? chain.T_tip), stand = settings.placements[i] ?? chain.T_base;
  const moved = (T: number[], k: number, value: number) => T.map((each, n) => (n === 4 * k + 3 ? value : each));
  return (
    <details open={open} onToggle={(e) => setOpen(e.currentTarget.open)}>
      <summary>Change limits, tool, base …</summary>
      <div class="inside">
        <h3>Limits of the joints</h3>
        {chain.joints.map((joint, k) => {
          const angle = chain.angle[k]!, scale = angle ? DEG : 1, [low, high] = shownLimits(chain.lower[k] ?? null, chain.upper[k] ?? null, angle);
          const [from, to] = limits[joint] ?? [low / scale, high / scale];
          const put = (range: [number, number]) => model.setLimits(i, joint, range[0] * scale <= low && range[1] * scale >= high ? null : range);
          return (
            <div key={joint}>
              <Slide label={`${joint} from`} name={`Lower limit of ${joint}`} unit={angle ? "°" : "m"} value={from * scale} low={low} high={high} onChange={(value) => put([Math.min(value / scale, to), to])} onDone={() => model.recompute(i, true)} />
              <Slide label={`${joint} to`} name={`Upper limit of ${joint}`} unit={angle ? "°" : "m"} value={to * scale} low={low} high={high} onChange={(value) => put([from, Math.max(value / scale, from)])} onDone={() => model.recompute(i, true)} />
            </div>
          );
        })}
        <h3>Tool point, in the tip's frame</h3>
        {["x", "y", "z"].map((axis, k) => <Slide key={axis} label={`Tool ${axis}`} unit="m" value={own[4 * k + 3]!} low={-0.5} high={0.5} step={0.005} onChange={(value) => model.setTool(i, tipOf(chain, moved(own, k, value)))} onDone={() => model.recompute(i, true)} />)}
        <h3>Where the base stands</h3>
        {["x", "y", "z"].map((axis, k) => <Slide key={axis} label={`Base ${axis}`} unit="m" value={stand[4 * k + 3]!} low={chain.T_base[4 * k + 3]! - 1} high={chain.T_base[4 * k + 3]! + 1} step={0.01} onChange={(value) => model.setPlacement(i, moved(stand, k, value))} onDone={() => model.recompute(i, true)} />)}
        <p class={live?.wrong ? "problem" : "help"} role="status" data-volume={live?.volume_m3} data-live={live ? (live.busy ? "busy" : "done") : ""}>{live ? (live.busy ? "Computing …" : live.said) : model.isFollowed(i) ? "The volume is the file's." : "There is no volume yet."}</p>
        <div class="wrap">
          {!model.isFollowed(i) && <button onClick={() => model.followVolume(i)}>Compute its volume</button>}
          <button disabled={!changed && settings.samples[i] == null} onClick={() => model.forget(i)}>{model.manifest.value!.analysis ? "Back to the result" : "Back to the robot's own"}</button>
          {onJob && <button disabled={!job} title={changed && !job ? "This analysis has no such robot in its document." : ""} onClick={() => onJob(job!)}>{jobLabel}</button>}
        </div>
      </div>
    </details>
  );
}

