// What is between the two cursors, or in view without them: how many elements each track has there, how long they are, which
// values an address had.
import { take_over } from '../session';
import { notice, show_dialog, state } from '../state';
import { spans_between, window_of } from './view';
import { is_of_numbers, type Span, type SpanTrack } from '../protocol';

const kElements = 20000;

/** Of a watched address values, of other tracks lengths in ns. Where elements are several in one, only what can be added up. */
export interface Measured {
  name: string;
  of_values: boolean;
  count: number;
  /** How many more reach over an end of the part: their lengths are not known. */
  cut: number;
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
  return { name, of_values: true, count: spans.length, cut: 0, average: sum_of(numbers.map((one, i) => one * lengths[i]!)) / Math.max(1, sum_of(lengths)),
    least: extreme(spans, numbers, -1)!, most: extreme(spans, numbers, 1)!, all: numbers };
}

function length_track(name: string, spans: Span[], exact: boolean, cut = 0): Measured {
  const count = sum_of(spans.map((one) => one.count ?? 1));
  if (!exact || count === 0) return { name, of_values: false, count, cut, average: sum_of(spans.map((one) => one.busy_ns ?? length_of(one))) / count, all: [] };
  const lengths = spans.map(length_of);
  return { name, of_values: false, count, cut, average: sum_of(lengths) / count, least: extreme(spans, lengths, -1)!, most: extreme(spans, lengths, 1)!, all: lengths };
}

/** What an event waited for its interrupt. */
function waits_of(name: string, spans: Span[], from_ns: number): Measured[] {
  const waited = spans.filter((one) => one.occurred_ns !== undefined && one.occurred_ns >= from_ns).map((one) => ({ ...one, at_ns: one.occurred_ns!, end_ns: one.at_ns }));
  return waited.every((one) => length_of(one) === 0) ? [] : [length_track(`${name}, waited`, waited, true)];
}

/** Whether all of an element is between the ends; what began before the past that is kept, or still goes on, is not. */
function is_whole(one: Span, from_ns: number, to_ns: number): boolean {
  const { oldest_ns, newest_ns } = state.past!;
  const begun = one.at_ns >= from_ns && (one.at_ns > oldest_ns || oldest_ns === 0);
  return begun && one.end_ns <= to_ns && (one.end_ns < newest_ns || one.end_ns === one.at_ns);
}

function touches(one: Span, from_ns: number, to_ns: number): boolean {
  return one.at_ns < to_ns && (one.end_ns > from_ns || one.at_ns === one.end_ns && one.at_ns >= from_ns);
}

export function measured(track: SpanTrack, from_ns: number, to_ns: number): Measured[] {
  const name = track.station ? `${track.station} ${track.name}` : track.name;
  if (is_of_numbers(track)) {
    const seen = track.spans.filter((one) => one.end_ns > from_ns && one.at_ns < to_ns);
    return seen.length === 0 ? [] : [value_track(name, seen, from_ns, to_ns)];
  }
  const seen = track.spans.filter((one) => touches(one, from_ns, to_ns));
  if (seen.length === 0) return [];
  const exact = seen.every((one) => (one.count ?? 1) === 1), inside = exact ? seen.filter((one) => is_whole(one, from_ns, to_ns)) : seen;
  return [length_track(name, inside, exact, seen.length - inside.length), ...(exact && track.kind === 'interrupts' ? waits_of(name, inside, from_ns) : [])];
}

export async function measure(): Promise<void> {
  const past = state.past, { a_ns, b_ns } = state.cursors;
  if (!past) return;
  const view = window_of(), is_wanted = take_over();
  const from_ns = Math.max(past.oldest_ns, a_ns !== null && b_ns !== null ? Math.min(a_ns, b_ns) : view.from_ns);
  const to_ns = Math.min(past.newest_ns, a_ns !== null && b_ns !== null ? Math.max(a_ns, b_ns) : view.to_ns);
  // A reply cuts what reaches over its ends: with 1 ns more at each it is seen what does.
  const spans = to_ns > from_ns ? await spans_between(Math.max(past.oldest_ns, from_ns - 1), Math.min(past.newest_ns, to_ns + 1), kElements, state.watched) : null;
  if (!is_wanted() || state.dialog !== null || state.menu !== null) return;
  if (!spans) {
    notice('There is nothing to measure yet');
    return;
  }
  state.measurement = { from_ns, to_ns, tracks: spans.tracks.flatMap((track) => measured(track, from_ns, to_ns)) };
  show_dialog('measurement');
}
