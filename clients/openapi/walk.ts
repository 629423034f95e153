// Ten minutes with the client that openapi-typescript and openapi-fetch make of a server's description:
// node walk.js URL [KEY]
import createClient from "openapi-fetch";
import type { components, paths } from "./wsrender.js";

type Job = components["schemas"]["JobView"];

const [url = "http://127.0.0.1:8000", key] = process.argv.slice(2);
const client = createClient<paths>({ baseUrl: url, headers: key ? { Authorization: `Bearer ${key}` } : {} });

function must<T>(answer: { data?: T; error?: unknown }): T {
  if (answer.data === undefined) throw new Error(JSON.stringify(answer.error));
  return answer.data;
}

/** The job when it has ended. */
async function wait(job: Job): Promise<Job> {
  while (["queued", "running", "canceling"].includes(job.state))
    job = must(await client.GET("/v1/jobs/{job_id}", { params: { path: { job_id: job.id }, query: { wait: 30 } } }));
  return job;
}

function succeeded(job: Job): Job {
  if (job.state !== "succeeded") throw new Error(JSON.stringify(job.error));
  return job;
}

const point = succeeded(await wait(must(await client.POST("/v1/jobs", {
  body: { analysis: "indices_at", robot: { library: "ur5e" }, configurations: [[0, -1.5, 1.5, 0, 1, 0]] },
}))));
const result = must(await client.GET("/v1/jobs/{job_id}/result", { params: { path: { job_id: point.id } } }));
if (typeof result === "string") throw new Error("a range, though none was asked for");
console.log("indices_at:", Object.keys(result).sort().join(" "));

const space = succeeded(await wait(must(await client.POST("/v1/jobs", {
  params: { header: { "Idempotency-Key": `${Date.now()}` } },
  body: {
    analysis: "workspace",
    robot: { library: "ur5e" },
    sampling: { method: "sobol", count: 200_000 },
    voxel_size_m: 0.05,
    refined_volume: null,
    labels: { client: "typescript" },
  },
}))));
const path = { job_id: space.id };
const page = must(await client.GET("/v1/jobs/{job_id}/artifacts", { params: { path } }));
for (const item of page.items) {
  const file = must(await client.GET("/v1/jobs/{job_id}/artifacts/{name}", {
    params: { path: { ...path, name: item.name } },
    parseAs: "arrayBuffer",
  }));
  if (file.byteLength !== item.bytes) throw new Error(`${item.name}: ${file.byteLength} of ${item.bytes} bytes`);
  const rest = must(await client.GET("/v1/jobs/{job_id}/artifacts/{name}", { // a download that broke off goes on
    params: { path: { ...path, name: item.name }, header: { Range: "bytes=100-", "If-Range": `"${item.sha256}"` } },
    parseAs: "arrayBuffer",
  }));
  if (rest.byteLength !== item.bytes - 100) throw new Error(`${item.name}: ${rest.byteLength} bytes after the 100th`);
}
const plane = must(await client.GET("/v1/jobs/{job_id}/volume/slice", {
  params: { path, query: { axis: "y", at: 0 } },
  parseAs: "arrayBuffer",
}));
console.log("workspace:", page.items.map((item) => item.name).join(" "), plane.byteLength);

const model = must(await client.POST("/v1/models", {
  body: `<mujoco><worldbody><body><joint name="a" axis="0 0 1" range="-90 90"/><geom size="0.1"/>
    <site name="tool" pos="0.5 0 0"/></body></worldbody></mujoco>`,
  headers: { "Content-Type": "application/octet-stream" },
  bodySerializer: (body) => body,
}));
const long = must(await client.POST("/v1/jobs", {
  body: {
    analysis: "workspace",
    robot: { model: model.sha256 },
    sampling: { method: "sobol", count: 10_000_000_000 },
    voxel_size_m: 0.01,
  },
}));
must(await client.POST("/v1/jobs/{job_id}:cancel", { params: { path: { job_id: long.id } } }));
console.log("cancel:", (await wait(long)).state);

const refused = await client.POST("/v1/jobs", {
  body: { analysis: "workspace", robot: { library: "ur5e" }, voxel_size_m: -0.05 },
});
if (refused.error === undefined) throw new Error("a negative size was taken");
console.log("refused:", refused.error.code, refused.error.errors?.[0]?.pointer);
