// What is between the two cursors, or in view without them: how many elements each track has there, how long they are, which
// values an address had.
import { notice, show_dialog, state } from '../state';
import { spans_between, window_of } from './view';
import type { Span, SpanTrack } from '../protocol';

const kElements = 20000;

/** Of a watched address values, of other tracks lengths in ns. Where elements are several in one, only what can be added up. */
export interface Measured {
  name: string;
  of_values: boolean;
  count: number;
  average: number;
  least?: Span;
  most?: Span;
  /** For the histogram. */
  all: number[];
}

export interface Measurement {
  from_ns: number;
  to_ns: number;
  tracks: Measured[];
}

export const length_of = (one: Span): number => one.end_ns - one.at_ns;

function sum_of(numbers: number[]): number {
  return numbers.reduce((sum, one) => sum + one, 0);
}

/** The element with the least number, or with the most, the first of equal ones. */
function extreme(spans: Span[], numbers: number[], sign: 1 | -1): Span | undefined {
  let at = 0;
  numbers.forEach((one, i) => { if (sign * one > sign * numbers[at]!) at = i; });
  return spans[at];
}

/** How far a value reaches counts for its average; it may have begun before the part. */
function value_track(name: string, spans: Span[], from_ns: number, to_ns: number): Measured {
  const numbers = spans.map((one) => one.value ?? 0);
  const lengths = spans.map((one) => Math.min(to_ns, one.end_ns) - Math.max(from_ns, one.at_ns));
  return { name, of_values: true, count: spans.length, average: sum_of(numbers.map((one, i) => one * lengths[i]!)) / Math.max(1, sum_of(lengths)),
    least: extreme(spans, numbers, -1)!, most: extreme(spans, numbers, 1)!, all: numbers };
}

function length_track(name: string, spans: Span[], exact: boolean): Measured {
  const count = sum_of(spans.map((one) => one.count ?? 1));
  if (!exact) return { name, of_values: false, count, average: sum_of(spans.map((one) => one.busy_ns ?? length_of(one))) / count, all: [] };
  const lengths = spans.map(length_of);
  return { name, of_values: false, count, average: sum_of(lengths) / count, least: extreme(spans, lengths, -1)!, most: extreme(spans, lengths, 1)!, all: lengths };
}

/** What an event waited for its interrupt. */
function waits_of(name: string, spans: Span[]): Measured[] {
  const waited = spans.filter((one) => one.occurred_ns !== undefined).map((one) => ({ ...one, at_ns: one.occurred_ns!, end_ns: one.at_ns }));
  return waited.every((one) => length_of(one) === 0) ? [] : [length_track(`${name}, waited`, waited, true)];
}

function measured(track: SpanTrack, from_ns: number, to_ns: number): Measured[] {
  const name = track.station ? `${track.station} ${track.name}` : track.name;
  if (track.kind === 'value') {
    const seen = track.spans.filter((one) => one.end_ns > from_ns && one.at_ns < to_ns);
    return seen.length === 0 ? [] : [value_track(name, seen, from_ns, to_ns)];
  }
  const inside = track.spans.filter((one) => one.at_ns >= from_ns && one.at_ns < to_ns);
  if (inside.length === 0) return [];
  const exact = inside.every((one) => (one.count ?? 1) === 1);
  return [length_track(name, inside, exact), ...(exact && track.kind === 'interrupts' ? waits_of(name, inside) : [])];
}

export async function measure(): Promise<void> {
  const past = state.past, { a_ns, b_ns } = state.cursors;
  if (!past) return;
  const view = window_of();
  const from_ns = Math.max(past.oldest_ns, a_ns !== null && b_ns !== null ? Math.min(a_ns, b_ns) : view.from_ns);
  const to_ns = Math.min(past.newest_ns, a_ns !== null && b_ns !== null ? Math.max(a_ns, b_ns) : view.to_ns);
  const spans = to_ns > from_ns ? await spans_between(from_ns, to_ns, kElements, state.watched) : null;
  if (!spans) {
    notice('There is nothing to measure yet');
    return;
  }
  state.measurement = { from_ns, to_ns, tracks: spans.tracks.flatMap((track) => measured(track, from_ns, to_ns)) };
  show_dialog('measurement');
}
