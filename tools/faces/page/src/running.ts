// Run and Pause. A session that follows the clock runs by itself; another one is run piece by piece, at the pace that was chosen.
import type { Stopped } from './protocol';
import { changed, state, the_engine } from './state';
import { any_pulses, switch_due, time_to_edge_ns } from './pulses';
import { begin_anew, command, print, say_why_stopped, take_over } from './session';

const kPiece = 50;        // ms of the reader's time that a piece takes
const kWithoutEnd = '24h';

/** What does not end a run: its length has passed, or an answer has come, which the panes show. */
const kGoesOn = new Set(['limit', 'answer']);

const pause_of = (ms: number): Promise<void> => new Promise((done) => setTimeout(done, ms));

/** Runs that long without an edge of a pulse train. Returns whether the run goes on. */
async function run_on(length_ns: number): Promise<boolean> {
  const reply = await command<Stopped>(`continue ${Math.max(1, Math.round(length_ns))}ns`);
  if (reply.error !== undefined || reply.interrupted) return false;
  if (reply.json?.stopped !== 'limit') print(reply.text);
  say_why_stopped(reply);
  return kGoesOn.has(reply.json?.stopped ?? '');
}

/** Runs that long. Returns how long that took, in ms of the reader's time, or nothing if the run is over. */
async function run_piece(length_ns: number): Promise<number | undefined> {
  const began = performance.now();
  const now = (): number => state.past?.now_ns ?? 0;
  for (const end = now() + length_ns; now() < end && state.own_run;) {
    await switch_due(now());
    if (!await run_on(Math.min(end - now(), time_to_edge_ns(now())))) return undefined;
  }
  return performance.now() - began;
}

/** At the pace that is chosen, which may change meanwhile. */
async function run_paced(): Promise<void> {
  let fastest = kPiece * 1e6;
  while (state.own_run) {
    const took = await run_piece(state.pace === 0 ? fastest : state.pace * kPiece * 1e6);
    if (took === undefined) return;
    if (state.pace === 0) fastest *= Math.min(4, Math.max(0.25, kPiece / Math.max(1, took)));
    else await pause_of(kPiece - took);
  }
}

async function run_without_end(): Promise<void> {
  for (;;) {
    const reply = await command<Stopped>(`continue ${kWithoutEnd}`);
    if (reply.interrupted || reply.error !== undefined) return;
    print(reply.text);
    say_why_stopped(reply);
    if (!state.own_run || !kGoesOn.has(reply.json?.stopped ?? '')) return;
  }
}

export async function run(): Promise<void> {
  if (state.running) return;
  take_over();
  state.own_run = true;
  state.running = true;
  begin_anew();
  changed();
  if (state.hello?.live || (state.pace === 0 && the_engine().can_be_stopped && !any_pulses())) await run_without_end();
  else await run_paced();
  state.own_run = false;
  state.running = false;
  changed();
}

export function pause(): void {
  state.own_run = false;
  the_engine().stop();
}
