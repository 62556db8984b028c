// The executions of the line that is selected: when it was executed last, its network on the timeline, the way to the one before and after.
import { line_of } from '../commands';
import { move_on, take_over } from '../session';
import { changed, notice, state } from '../state';
import { moment_text, moment_word } from '../words';
import type { Span, SpanTrack, Stopped } from '../protocol';

/** The selected line, if it is an instruction. */
export function selected_instruction(): { line: number; op: number } | null {
  const line = state.selected_line, op = line === null ? undefined : state.lines.get(line)?.op;
  return line === null || op === undefined || op === null ? null : { line, op };
}

function network_of(op: number): number | undefined {
  return state.outline?.routines.flatMap((one) => one.networks).find((one) => one.first <= op && op < one.end)?.first;
}

/** Whether an element of the timeline is an execution of the network of the selected line. */
export function is_of_selected(): (track: SpanTrack, one: Span) => boolean {
  const selected = selected_instruction(), network = selected ? network_of(selected.op) : undefined, station = state.past?.station ?? '';
  if (network === undefined) return () => false;
  return (track, one) => track.kind === 'networks' && !track.before && (track.station ?? '') === station && (one.count ?? 1) === 1 &&
    one.op !== undefined && network_of(one.op) === network;
}

/** `executed last at 8.919 ms`; nothing while that is not known. */
export function executed_text({ line, op }: { line: number; op: number }): string {
  const execution = state.executions.get(op), known = state.executions_known;
  if (execution) return `executed last at ${moment_text(execution.at_ns)}`;
  if (!known || line < known.first || line > known.last) return '';
  return known.since_ns > 0 ? `not executed since ${moment_text(known.since_ns)}` : 'never executed up to this moment';
}

const kAhead = 10e9;  // ns that are run for the next execution

/** Forwards past answers, at which a run ends. Returns whether it is there, or has stopped elsewhere for a reason that is said. */
async function goes_on_to(line: number, is_wanted: () => boolean): Promise<boolean> {
  const until_ns = (state.past?.now_ns ?? 0) + kAhead;
  for (;;) {
    const left_ns = until_ns - (state.past?.now_ns ?? until_ns);
    if (left_ns <= 0) return false;
    const { interrupted, json, error } = await move_on<Stopped>(line_of`until ${line} within ${moment_word(left_ns)}`);
    if (interrupted || error !== undefined || !is_wanted()) return true;
    if (json?.stopped !== 'answer') return json?.stopped !== 'limit';
  }
}

async function goes_back_to(line: number): Promise<boolean> {
  const reply = await move_on(line_of`runtil ${line}`);
  return reply.interrupted === true || reply.error !== undefined || state.past?.now_ns !== state.past?.oldest_ns || state.past?.line === line;
}

/** To the next execution of the selected line, or to the one before; if there is none, it stays where it was. */
export async function go_to_other_execution(direction: 1 | -1): Promise<void> {
  const selected = selected_instruction(), was_ns = state.past?.now_ns ?? 0, is_wanted = take_over();
  if (!selected) return;
  const { line } = selected;
  if (await (direction > 0 ? goes_on_to(line, is_wanted) : goes_back_to(line)) || !is_wanted()) return;
  await move_on(line_of`at ${moment_word(was_ns)}`);
  notice(direction > 0 ? `Line ${line} is not executed in the next 10 s` : `Line ${line} was not executed before this moment`);
}

export function select_line(line: number | null): void {
  state.selected_line = line;
  changed();
}
