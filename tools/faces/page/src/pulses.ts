// Pulse trains on inputs, in simulated time: the run stops at each edge, so that edges are as exact as an instruction.
import { changed, state, type PointRow } from './state';
import { switch_to } from './switches';

export const kMostHertz = 1000;
const kLeastHertz = 0.01;

interface Train {
  row: PointRow;
  /** When the next edge comes, and to which level. */
  next_ns: number;
  level: number;
}

const trains = new Map<string, Train>();

function half_period_ns(row: PointRow): number {
  return 0.5e9 / row.hertz;
}

export function is_pulsing(address: string): boolean {
  return trains.has(address);
}

/** A session begins: nothing pulses in it. */
export function forget_pulses(): void {
  trains.clear();
}

export async function toggle_pulses(row: PointRow): Promise<void> {
  if (trains.delete(row.address)) {
    await switch_to(row.address, 0);
    return;
  }
  const train: Train = { row, next_ns: state.past?.now_ns ?? 0, level: 1 };
  trains.set(row.address, train);
  changed();
  if (state.hello?.live) void pulse_by_clock(train);
}

/** Returns whether the text is a frequency; then it is that of the row from the next edge on. */
export function set_hertz(row: PointRow, text: string): boolean {
  const hertz = Number(text.replace(',', '.').replace(/\s*hz$/i, ''));
  if (!(hertz >= kLeastHertz && hertz <= kMostHertz)) return false;
  row.hertz = hertz;
  changed();
  return true;
}

/** After a jump to another moment a train goes on from there. */
function come_along(train: Train, now_ns: number): void {
  if (train.next_ns < now_ns - 2 * half_period_ns(train.row) || train.next_ns > now_ns + 2 * half_period_ns(train.row)) train.next_ns = now_ns;
}

/** How long a run may go on from now on until the next edge. */
export function time_to_edge_ns(now_ns: number): number {
  let next = Infinity;
  for (const train of trains.values()) {
    come_along(train, now_ns);
    next = Math.min(next, train.next_ns - now_ns);
  }
  return Math.max(0, next);
}

/** Switches the inputs whose edges have come. */
export async function switch_due(now_ns: number): Promise<void> {
  for (const train of [...trains.values()]) {
    if (train.next_ns > now_ns) continue;
    await switch_to(train.row.address, train.level);
    train.level = 1 - train.level;
    train.next_ns += half_period_ns(train.row);
  }
}

const kLook = 50;  // ms until it is seen whether there is a run

/** A run that follows the clock goes on by itself: there the edges follow the reader's clock, while it goes on. */
async function pulse_by_clock(train: Train): Promise<void> {
  for (let next = performance.now(); trains.get(train.row.address) === train;) {
    const runs = state.running && state.past?.in_the_past === false;
    if (runs) {
      await switch_to(train.row.address, train.level);
      train.level = 1 - train.level;
    }
    const now = performance.now();
    next = Math.max(now, runs ? next + half_period_ns(train.row) / 1e6 : now + kLook);
    await new Promise((done) => setTimeout(done, next - now));
  }
}
