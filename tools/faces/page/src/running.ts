// Run and Pause. A session that follows the clock runs by itself; another one is run piece by piece, at the pace that was chosen.
import type { Stopped } from './protocol';
import { changed, state, the_engine } from './state';
import { command, print } from './session';

const kPiece = 50;        // ms of the reader's time that a piece takes
const kWithoutEnd = '24h';

/** What does not end a run: its length has passed, or an answer has come, which the panes show. */
const kGoesOn = new Set(['limit', 'answer']);

const pause_of = (ms: number): Promise<void> => new Promise((done) => setTimeout(done, ms));

async function run_piece(length_ns: number): Promise<boolean> {
  const began = performance.now();
  const reply = await command<Stopped>(`continue ${length_ns}ns`);
  if (reply.error !== undefined || reply.interrupted) return false;
  if (reply.json?.stopped !== 'limit') print(reply.text);
  if (!kGoesOn.has(reply.json?.stopped ?? '')) return false;
  await pause_of(began + kPiece - performance.now());
  return true;
}

async function run_without_end(): Promise<void> {
  for (;;) {
    const reply = await command<Stopped>(`continue ${kWithoutEnd}`);
    if (reply.interrupted || reply.error !== undefined) return;
    print(reply.text);
    if (!state.own_run || !kGoesOn.has(reply.json?.stopped ?? '')) return;
  }
}

export async function run(): Promise<void> {
  if (state.running) return;
  state.own_run = true;
  state.running = true;
  state.notice = null;
  changed();
  if (state.hello?.live || state.pace === 0) await run_without_end();
  else while (state.own_run && await run_piece(Math.max(1, Math.round(state.pace * kPiece * 1e6)))) {}
  state.own_run = false;
  state.running = false;
  changed();
}

export function pause(): void {
  state.own_run = false;
  the_engine().stop();
}
