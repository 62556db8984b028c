// Two futures: the one that has been is kept from a moment on, something is changed there, and what comes then stands above it,
// with what differs marked.
import { changed, notice, state } from './state';
import { line_of } from './commands';
import { also_seen, move_on, run_to, Seen, take_over } from './session';
import { first_after } from './timeline/scale';
import { spans_between } from './timeline/view';
import { moment_text, moment_word } from './words';
import { is_of_numbers, type Span, type Spans, type SpanTrack } from './protocol';

const kElements = 3000;
const kLeastAhead = 200e6;  // ns

/** What is to be compared reaches as far as the timeline shows, at least. */
function end_of_first(now_ns: number, newest_ns: number): number {
  return Math.max(newest_ns, now_ns + kLeastAhead, state.window?.to_ns ?? 0);
}

const kWatchable = /^(?:SM|[IQVMSL])(?:\d+\.[0-7]|[BWD]\d+)$/;

/** What may be put on the timeline later: its values of this future cannot be asked for once there is another one. */
function all_known(): string[] {
  const shown = [...state.values.values()].map((one) => one.address).filter((one) => kWatchable.test(one));
  return [...new Set([...state.watched, ...shown])];
}

/** Runs from the newest moment on to that one. Returns whether nothing else is wanted meanwhile. */
async function run_from_newest(until_ns: number, is_wanted: () => boolean): Promise<boolean> {
  if ((state.past?.newest_ns ?? 0) >= until_ns) return is_wanted();
  if (state.past?.in_the_past) await move_on(line_of`at end`);
  if (is_wanted()) await run_to(until_ns, is_wanted);
  return is_wanted();
}

let is_keeping = false;

/** Keeps what comes after the present moment, which is run if it has not been yet; ends the comparison if there is one. */
export async function compare_futures(): Promise<void> {
  if (is_keeping) return;
  if (state.first_future) {
    state.first_future = null;
    changed();
    return;
  }
  is_keeping = true;
  await keep_future(take_over());
  is_keeping = false;
}

/** As far as it has been run: a breakpoint may have ended it before. */
async function keep_future(is_wanted: () => boolean): Promise<void> {
  const past = state.past;
  if (!past) return;
  const at_ns = past.now_ns;
  if (!await run_from_newest(end_of_first(at_ns, past.newest_ns), is_wanted)) return;
  const spans = await spans_between(at_ns, Math.max(at_ns + 1, state.past!.newest_ns), kElements, all_known());
  if (!is_wanted()) return;
  await move_on(line_of`at ${moment_word(at_ns)}`);
  if (!is_wanted() || !spans) return;
  state.first_future = { at_ns, until_ns: spans.to_ns, spans };
  state.futures_part_ns = null;
  notice('This future is kept, below each track. Now switch an input, write a value or send a frame, and Run: what differs is marked.');
}

/** Runs as far as the first future goes, so that both can be compared. */
export async function run_second(): Promise<void> {
  if (state.first_future) await run_from_newest(state.first_future.until_ns, take_over());
}

function key_of(one: Span): string {
  return `${one.at_ns} ${one.end_ns} ${one.text} ${one.value ?? ''} ${one.error ?? ''} ${one.count ?? 1}`;
}

/** The value of a watched address at a moment. */
function value_at(track: SpanTrack, ns: number): number | undefined {
  const one = track.spans[first_after(track.spans, ns)];
  return one && one.at_ns <= ns ? one.value : undefined;
}

/** Whether an element of a track, within a part of the time, is one that the other track does not have. */
function differs_from(other: SpanTrack | undefined, track: SpanTrack, from_ns: number, to_ns: number): (one: Span) => boolean {
  const known = new Set((other?.spans ?? []).map(key_of));
  if (track.kind === 'value' && !other) return () => false;  // it is not known of that future
  return (one) => (is_of_numbers(track) && other
    ? one.end_ns > from_ns && one.at_ns < to_ns && value_at(other, Math.max(one.at_ns, from_ns)) !== one.value
    : one.at_ns > from_ns && one.end_ns < to_ns && !known.has(key_of(one)));
}

/** The elements of a track, those marked that the other one does not have. Where several are in one, that cannot be told. */
function marked(track: SpanTrack, other: SpanTrack | undefined, from_ns: number, to_ns: number): Span[] {
  if (other && !(track.exact && other.exact)) return track.spans;
  const differs = differs_from(other, track, from_ns, to_ns);
  return track.spans.map((one) => (differs(one) ? { ...one, differs: true, differs_until_ns: to_ns } : one));
}

const same = (a: SpanTrack) => (b: SpanTrack): boolean => a.name === b.name && a.station === b.station;

function both(spans: Spans, first: NonNullable<typeof state.first_future>): Spans {
  const newest = state.past?.newest_ns ?? 0, from = first.at_ns, to = Math.min(first.until_ns, newest, spans.to_ns);
  const names = new Set(spans.tracks.map((one) => `${one.station ?? ''} ${one.name}`));
  const lower = (track: SpanTrack, upper: SpanTrack | undefined): SpanTrack => ({ ...track, before: true, spans: marked(track, upper, from, to) });
  const tracks = spans.tracks.flatMap((track) => {
    const kept = first.spans.tracks.find(same(track));
    const unknown = track.kind === 'value' ? [{ ...track, before: true, unknown: true, spans: [] }] : [];
    return [{ ...track, spans: marked(track, kept, from, to) }, ...(kept ? [lower(kept, track)] : unknown)];
  });
  const gone = first.spans.tracks.filter((one) => one.kind !== 'value' && !names.has(`${one.station ?? ''} ${one.name}`)).map((one) => lower(one, undefined));
  return { ...spans, tracks: [...tracks, ...gone] };
}

let of_spans: Spans | null = null, of_first: unknown = null, shown: Spans | null = null;

/** What the timeline shows: of two futures each track twice. */
export function shown_spans(): Spans | null {
  if (!state.first_future || !state.spans) return state.spans;
  if (of_spans !== state.spans || of_first !== state.first_future) {
    of_spans = state.spans;
    of_first = state.first_future;
    shown = both(state.spans, state.first_future);
  }
  return shown;
}

/** When the second future has something first that the one kept has not, or the other way round; null if nothing yet. */
function parting_of(first: NonNullable<typeof state.first_future>, second: Spans): number | null {
  const to = Math.min(first.until_ns, second.to_ns), is_whole = second.to_ns >= first.until_ns;
  const begin = (one: SpanTrack, other: SpanTrack | undefined): number => {
    if (!is_whole && other && !(one.exact && other.exact)) return Infinity;  // several are put together in another way
    const found = one.spans.find(differs_from(other, one, first.at_ns, to));
    return found ? Math.max(found.at_ns, first.at_ns) : Infinity;
  };
  const at = Math.min(...second.tracks.map((one) => begin(one, first.spans.tracks.find(same(one)))),
    ...first.spans.tracks.map((one) => begin(one, second.tracks.find(same(one)))));
  return at === Infinity ? null : at;
}

/** Of all that has been of both, whatever is in view. */
const parting = new Seen(async () => {
  const first = state.first_future;
  if (!first || (state.past?.newest_ns ?? 0) <= first.at_ns) return;
  const second = await spans_between(first.at_ns, first.until_ns, kElements, state.watched);
  if (second) state.futures_part_ns = parting_of(first, second);
});

export function start_futures(): void {
  also_seen(parting);
}

export function difference_text(): string {
  const at = state.futures_part_ns;
  return at === null ? 'both futures are the same so far' : `both futures part at ${moment_text(at)}`;
}
