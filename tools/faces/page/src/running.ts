// Run and Pause. A session that follows the clock runs by itself; another one is run piece by piece, at the pace that was chosen.
import type { PieceOfRun, Stopped } from './protocol';
import { changed, state, the_engine } from './state';
import { switch_due, time_to_edge_ns } from './pulses';
import { line_of } from './commands';
import { begin_to_move, print, run_piece_of, say_why_stopped, take_over } from './session';

const kPiece = 50;         // ms of the reader's time that a piece takes
const kLongPiece = 1000;   // as fast as it goes: between pieces the panes are brought up to date. A command does not wait for its end
const kWithoutEnd = '24h';

/** What does not end a run: its length has passed, or an answer has come, which the panes show. */
const kGoesOn = new Set(['limit', 'answer']);

const pause_of = (ms: number): Promise<void> => new Promise((done) => setTimeout(done, ms));

/** The next piece is the first one of a run. */
let begins = false;

function piece_of_run(): PieceOfRun {
  const piece = begins ? 'begins' : 'goes on';
  begins = false;
  return piece;
}

/** Runs that long without an edge of a pulse train. Returns whether the run goes on. */
async function run_on(length_ns: number): Promise<boolean> {
  const is_long = state.pace === 0 && the_engine().can_be_stopped;
  const reply = await run_piece_of<Stopped>(line_of`continue ${Math.max(1, Math.round(length_ns))}ns`, is_long, piece_of_run());
  if (reply.gave_way) return true;
  if (reply.error !== undefined || reply.interrupted) return false;
  if (reply.json?.stopped !== 'limit') print(reply.text);
  say_why_stopped(reply);
  return kGoesOn.has(reply.json?.stopped ?? '');
}

/** Runs that long. Returns how long that took, in ms of the reader's time, or nothing if the run is over. */
async function run_piece(length_ns: number, goes_on: () => boolean): Promise<number | undefined> {
  const began = performance.now();
  const now = (): number => state.past?.now_ns ?? 0;
  for (const end = now() + length_ns; now() < end && goes_on();) {
    await switch_due(now());
    if (!goes_on() || !await run_on(Math.min(end - now(), time_to_edge_ns(now())))) return undefined;
  }
  return performance.now() - began;
}

/** At the pace that is chosen, which may change meanwhile. */
async function run_paced(goes_on: () => boolean): Promise<void> {
  const long_ms = the_engine().can_be_stopped ? kLongPiece : kPiece;
  let fastest = kPiece * 1e6;
  while (goes_on()) {
    const took = await run_piece(state.pace === 0 ? fastest : state.pace * kPiece * 1e6, goes_on);
    if (took === undefined) return;
    if (state.pace === 0) fastest *= Math.min(4, Math.max(0.25, long_ms / Math.max(1, took)));
    else await pause_of(kPiece - took);
  }
}

/** A run that follows the clock carries out commands meanwhile. */
async function run_live(goes_on: () => boolean): Promise<void> {
  while (goes_on()) {
    const reply = await run_piece_of<Stopped>(line_of`continue ${kWithoutEnd}`, false, piece_of_run());
    if (reply.interrupted || reply.error !== undefined) return;
    print(reply.text);
    say_why_stopped(reply);
    if (!kGoesOn.has(reply.json?.stopped ?? '')) return;
  }
}

export async function run(): Promise<void> {
  if (state.running) return;
  take_over();
  state.own_run = true;
  begins = true;
  const is_last = begin_to_move();
  await (state.hello?.live ? run_live : run_paced)(() => state.own_run && is_last());
  if (!is_last()) return;
  state.own_run = false;
  state.others_run = false;
  state.running = false;
  changed();
}
