/** Jobs as the server lists them. */

import type { Problem } from "../../sources/api";

export type State = "queued" | "running" | "canceling" | "succeeded" | "failed" | "canceled" | "timed_out" | "expired";
export const STATES: State[] = ["queued", "running", "canceling", "succeeded", "failed", "canceled", "timed_out", "expired"];
export const ENDED: State[] = ["succeeded", "failed", "canceled", "timed_out", "expired"];

export interface Progress { fraction: number; samples_done: number; samples_total: number | null; rate_per_s: number | null; eta_s: number | null; message: string }

export interface Job {
  id: string;
  analysis: string;
  robots: string[]; // and mechanisms, by name
  state: State;
  created_at: string;
  started_at: string | null;
  finished_at: string | null;
  labels: Record<string, string>;
  priority: number;
  attempt: number;
  last_event: number; // id of its newest
  progress: Progress;
  error: Problem | null;
  warnings: { code: string; message: string }[];
}

/** Of what is known of a job and what is told, the newer: an event overtakes an answer that was written before it. */
export const newer = (known: Job | undefined, told: Job): Job => (known && known.last_event > told.last_event ? known : told);

export interface JobFile { name: string; media_type: string; bytes: number; href: string }
