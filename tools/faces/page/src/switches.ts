// Inputs as switches: what is put at a terminal, and what the program has read there.
import { line_of } from './commands';
import { command } from './session';
import { changed, state } from './state';

export function level_of(address: string): number {
  return Number(state.values.get(address)?.number ?? 0);
}

/** The terminal's level: what was put there until the scan has read it, then what the input register has. */
export function terminal_level(address: string): number {
  const put = state.switched.get(address), past = state.past;
  const unread = put && past && past.now_ns >= put.at_ns && past.scan <= put.scan + 1;
  return unread && !state.values.get(address)?.forced ? put.level : level_of(address);
}

export async function switch_to(address: string, level: number): Promise<void> {
  if (state.past) state.switched.set(address, { level, at_ns: state.past.now_ns, scan: state.past.scan });
  changed();
  await command(state.values.get(address)?.forced ? line_of`force ${address}=${level}` : line_of`input ${address}=${level}`);
}
