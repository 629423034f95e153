/** Histograms and curves beside the view, and tied to it: a range that is dragged in a histogram is that of the colours; a point of a curve is the volume of as many samples, or the mapping's scale. */

import { useEffect, useRef, useState } from "preact/hooks";
import uPlot from "uplot";
import type { Plot, Vector } from "../../contract";
import { titled } from "../../scene/colors";
import { channelKey } from "../../settings";
import { Section, Select } from "./controls";
import { channelOf } from "./look";
import type { ViewModel } from "./model";

const WIDTH = 266, HEIGHT = 168;
const DRAGGED = 4; // pixels: less is a click
const WHOLE = [1, 2, 5, 10, 20, 50].flatMap((step) => [1, 1e2, 1e4, 1e6, 1e8].map((size) => step * size)).sort((a, b) => a - b); // steps of a count
const whole = (values: (number | null)[]): boolean => values.every((v) => v === null || Number.isInteger(v));

export function Plots({ model }: { model: ViewModel }) {
  const { plots } = model.manifest.value!, channel = channelOf(model);
  const [name, setName] = useState<string | null>(null);
  const own = plots.find((each) => channel && each.channel?.name === channelKey(channel)); // that of the channel that is shown
  const shown = plots.find((each) => each.name === name) ?? own ?? plots[0];
  if (!shown) return null;
  return (
    <Section title="Plots" open>
      {plots.length > 1 && <Select label="Plot" value={shown.name} options={plots.map((each) => ({ value: each.name, label: each.label }))} onChange={setName} />}
      <OnePlot key={shown.name} model={model} plot={shown} />
    </Section>
  );
}

/** What the x of a curve's points is of the view: what is shown, and how another is. Null where it is nothing that could be changed. */
function setting(model: ViewModel, { sets, robot = 0 }: Plot): { shown: number | null; put(x: number | null): void } | null {
  const settings = model.settings.value!, { mapping } = model.manifest.value!;
  if (sets === "samples" && model.canAsk && model.manifest.value!.robots[robot]) return { shown: settings.samples[robot] ?? null, put: (count) => model.setSamples(robot, count) };
  if (sets !== "scale" || !mapping) return null;
  const own = settings.mapping ?? mapping, mean = typeof own.scale === "number" ? own.scale : Math.cbrt(own.scale.reduce((a, b) => a * b)); // what such a curve is drawn over
  const scaled = (by: number) => (typeof own.scale === "number" ? own.scale * by : (own.scale.map((each) => each * by) as Vector));
  return { shown: mean, put: (scale) => model.update({ mapping: scale === null ? null : { scale: scaled(scale / mean), offset_m: own.offset_m } }) };
}

function OnePlot({ model, plot }: { model: ViewModel; plot: Plot }) {
  const host = useRef<HTMLDivElement>(null), chart = useRef<uPlot | null>(null);
  const settings = model.settings.value!, channel = channelOf(model), voxel = model.voxel.value;
  const tied = plot.channel !== undefined && channel !== undefined && channelKey(channel) === plot.channel.name;
  const value = voxel?.values.find((each) => channelKey(each) === plot.channel?.name)?.value ?? null;
  const marks = useRef<{ low: number | null; high: number | null; value: number | null }>({ low: null, high: null, value: null });
  const set = setting(model, plot), put = useRef(set?.put), marked = set ? set.shown : value;
  put.current = set?.put;
  marks.current = { low: tied ? settings.range.low : null, high: tied ? settings.range.high : null, value: marked };
  useEffect(() => {
    const color = (name: string) => getComputedStyle(host.current!).getPropertyValue(name).trim();
    const [text, line, accent] = [color("--muted"), color("--line"), color("--accent")];
    const axis = (label: string, values: (number | null)[], vertical = false): uPlot.Axis => ({ label, ...(whole(values) && { incrs: WHOLE }), stroke: text, grid: { stroke: line, width: 1 }, ticks: { stroke: line }, labelSize: 16, size: vertical ? 52 : 38, font: "11px system-ui, sans-serif", labelFont: "11px system-ui, sans-serif" });
    const histogram = plot.kind === "histogram";
    const colors = [accent, "#d55e00", "#009e73", "#cc79a7"];
    const drawMarks = (u: uPlot) => {
      const { low, high, value: at } = marks.current, { ctx, bbox } = u;
      ctx.save();
      if (low !== null || high !== null) {
        const from = Math.max(bbox.left, u.valToPos(low ?? -Infinity, "x", true) || bbox.left), to = Math.min(bbox.left + bbox.width, high === null ? Infinity : u.valToPos(high, "x", true));
        ctx.fillStyle = accent + "33";
        ctx.fillRect(from, bbox.top, Math.max(0, to - from), bbox.height);
      }
      if (at !== null) {
        const x = u.valToPos(at, "x", true);
        ctx.strokeStyle = "#d55e00";
        ctx.lineWidth = 2;
        ctx.beginPath();
        ctx.moveTo(x, bbox.top);
        ctx.lineTo(x, bbox.top + bbox.height);
        ctx.stroke();
      }
      ctx.restore();
    };
    const u = new uPlot({
      width: WIDTH, height: HEIGHT, legend: { show: plot.y.length > 1, live: false }, cursor: { drag: { x: true, y: false, setScale: !histogram, dist: DRAGGED, click: () => undefined } },
      scales: { x: { time: false, distr: plot.sets === "samples" ? 3 : 1 } }, axes: [axis(titled(plot.x), plot.x.values), axis(plot.y[0] ? titled(plot.y[0]) : "", plot.y.flatMap((each) => each.values), true)],
      series: [{}, ...plot.y.map((each, i) => ({ label: each.label, stroke: colors[i % 4]!, width: 1.5, ...(histogram ? { paths: uPlot.paths.bars!({ size: [1, 64] }), fill: colors[i % 4]! + "99", points: { show: false } } : { points: { show: plot.x.values.length < 40 } }) }))],
      hooks: {
        draw: [drawMarks],
        ready: [({ over, posToIdx, syncRect }) => {
          let from = 0;
          over.addEventListener("pointerdown", ({ clientX }) => { from = clientX; });
          over.addEventListener("click", ({ clientX }) => {
            if (Math.abs(clientX - from) < DRAGGED) put.current?.(plot.x.values[posToIdx(clientX - over.getBoundingClientRect().left)] ?? null);
          });
          over.addEventListener("pointerenter", () => syncRect()); // a panel that scrolls in a shadow root tells the chart nothing
        }],
        setSelect: [(chart) => {
          if (!histogram || !plot.channel || chart.select.width < 3) return;
          const low = chart.posToVal(chart.select.left, "x"), high = chart.posToVal(chart.select.left + chart.select.width, "x");
          model.update({ range: { ...model.settings.value!.range, low, high } });
          chart.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        }],
      },
    }, [plot.x.values, ...plot.y.map((each) => each.values)] as uPlot.AlignedData, host.current!);
    chart.current = u;
    return () => u.destroy();
  }, [plot, settings.theme]);
  useEffect(() => chart.current?.redraw(false), [settings.range, marked, tied]);
  const total = plot.y[0]?.values.length ?? 0;
  return (
    <>
      <div class="plot" ref={host} role="img" aria-label={`${plot.label}: ${total} values of ${plot.x.label} from ${plot.x.values[0]} to ${plot.x.values.at(-1)}`} />
      {set && plot.sets === "samples" && <Select label="Volume of" value={String(set.shown ?? "")} options={[{ value: "", label: "the result" }, ...plot.x.values.map((each) => ({ value: String(each), label: `${each!.toLocaleString("en")} samples` }))]} onChange={(count) => set.put(count ? Number(count) : null)} />}
      {set && <p class="help">{plot.sets === "samples" ? "Click a point: the volume of as many Sobol samples is shown." : "Click it: the mapping takes that scale."} Drag over it to look closer, double-click for all.</p>}
      {set && plot.sets === "samples" && model.live.value && <p class={model.live.value.wrong ? "problem" : "help"} role="status">{model.live.value.busy ? "Computing …" : model.live.value.said}</p>}
      {plot.kind === "histogram" && plot.channel && <p class="help">{tied ? "Drag over it to choose the range of the colours." : "Show its channel to choose the colours' range here."}</p>}
    </>
  );
}
