// Which part of the past the timeline shows, and what it asks for: a little more than the window, so that moving it is smooth.
import { also_seen, go_to, look_through, query, Seen } from '../session';
import { changed, notice, show_pane, state } from '../state';
import { kAddresses, line_of, symbol_named, word_of, type Command } from '../commands';
import { moment_word } from '../words';
import type { Hello, Span, Spans, SpanTrack } from '../protocol';

const kElements = 3000;
const kLeastWindow = 2000;  // ns
const kFirstWindow = 200e6;

/** Whether the window goes along with the present. */
let goes_along = true;

const kMargin = 0.03;  // of the window: the present is no nearer to its ends

export function window_of(): { from_ns: number; to_ns: number } {
  if (state.window) return state.window;
  const newest = Math.max(state.past?.newest_ns ?? 0, 1e6), from_ns = Math.max(state.past?.oldest_ns ?? 0, newest - kFirstWindow);
  return { from_ns, to_ns: newest + (newest - from_ns) * kMargin };
}

function query_of(from_ns: number, to_ns: number, elements: number, watched: string[]): Command {
  const asked = [moment_word(from_ns), moment_word(to_ns), String(elements), ...watched.filter((one) => word_of(one) !== undefined)];
  return line_of`spans ${asked}`;
}

export async function spans_between(from_ns: number, to_ns: number, elements = kElements, watched: string[] = []): Promise<Spans | null> {
  return (await query<Spans>(query_of(from_ns, to_ns, elements, watched))).json;
}

/** The same for a search. Nothing if something else is wanted meanwhile. */
export async function spans_searched(from_ns: number, to_ns: number, is_wanted: () => boolean, elements = kElements): Promise<Spans | null> {
  const reply = await look_through<Spans>(query_of(from_ns, to_ns, elements, []), is_wanted);
  return is_wanted() ? reply.json : null;
}

const kLate = 300;   // ms after which it is said that something is being computed
const kRest = 150;  // ms between two questions while it runs, so that the run goes on meanwhile

const seen: Seen = new Seen(async () => {
  if (state.running) await new Promise((done) => setTimeout(done, kRest));
  const past = state.past;
  if (!past || !state.outline) return;
  const while_running = state.running, follows = runs_on() && goes_along;
  if (goes_along && !follows) follow_present();
  if (follows) state.window ??= { from_ns: window_of().from_ns, to_ns: window_of().from_ns + kFirstWindow * (1 + kMargin) };
  const window = follows ? window_at_present() : window_of(), { from_ns, to_ns } = window;
  const length = to_ns - from_ns;
  const first = Math.max(past.oldest_ns, from_ns - length / 4), last = Math.min(past.newest_ns, to_ns + length / 4);
  if (last <= first) return;
  if (is_picture_seen(first, last)) {
    state.spans = await picture_up_to(state.picture!, last);
    return;
  }
  if (state.picture && !covers(state.spans, from_ns, to_ns)) state.spans = state.picture;
  const late = setTimeout(() => { state.computing = true; changed(); }, kLate);
  const spans = await spans_between(first, last, kElements, state.watched);
  clearTimeout(late);
  state.computing = false;
  if (spans) state.spans = spans;
  if (spans && follows && goes_along) state.window = window;
  if (spans?.interrupted && while_running) seen.refresh();  // it was the run that was stopped
});

function covers(spans: Spans | null, from_ns: number, to_ns: number): boolean {
  return spans !== null && spans.from_ns <= Math.max(0, from_ns) && spans.to_ns >= Math.min(to_ns, state.past?.newest_ns ?? 0);
}

/** Whether all of the run of a report is seen, of which there is a picture. */
function is_picture_seen(from_ns: number, to_ns: number): boolean {
  return state.picture !== null && state.watched.length === 0 && from_ns <= state.picture.from_ns && to_ns >= state.picture.to_ns;
}

/** With what has run since: only that is computed. */
async function picture_up_to(picture: Spans, to_ns: number): Promise<Spans> {
  const more = to_ns > picture.to_ns ? await spans_between(picture.to_ns, to_ns, kElements) : null;
  if (!more) return picture;
  const name_of = (one: SpanTrack): string => `${one.station ?? ''} ${one.kind} ${one.name}`;
  const later = new Map(more.tracks.map((one) => [name_of(one), one]));
  const begun = (one: SpanTrack | undefined): Span[] => (one?.spans ?? []).filter((span) => span.at_ns >= picture.to_ns);
  const known = picture.tracks.map((one) => ({ ...one, spans: [...one.spans, ...begun(later.get(name_of(one)))] }));
  const names = new Set(known.map(name_of)), left_out = picture.left_out ?? [];
  const others = more.tracks.filter((one) => !names.has(name_of(one)) && !left_out.includes(one.kind));
  return { ...picture, to_ns: more.to_ns, tracks: [...known, ...others] };
}

const kExchanges = 60e9;  // ns before and after a moment whose exchanges are listed

const exchanges = new Seen(async () => {
  if (state.running) await new Promise((done) => setTimeout(done, 3 * kRest));
  const past = state.past;
  if (!past || past.newest_ns === 0) return;
  const middle = state.exchanges_around_ns ?? past.now_ns;
  const from = Math.max(past.oldest_ns, middle - kExchanges), to = Math.min(past.newest_ns, middle + kExchanges);
  const spans = await spans_between(from, to, 20000);
  if (!spans) return;
  state.exchanges = spans;
  state.exchanges_before = from > past.oldest_ns;
  state.exchanges_after = to < past.newest_ns;
});
let exchanges_of: { hello: Hello | null; now_ns: number; newest_ns: number } | null = null;

/** The line pane shows the exchanges around this moment; it asks again when that is another one, or of another future or session. */
export function see_exchanges(): void {
  const { now_ns = 0, newest_ns = 0 } = state.past ?? {}, { hello } = state, before = exchanges_of;
  if (before?.hello === hello && before.now_ns === now_ns && before.newest_ns === newest_ns) return;
  exchanges_of = { hello, now_ns, newest_ns };
  state.exchanges_around_ns = null;
  exchanges.refresh();
}

/** Lists the part of the past before or after the one that is listed. */
export function list_exchanges(direction: 1 | -1): void {
  const { oldest_ns, newest_ns, now_ns } = state.past!;
  const middle = (state.exchanges_around_ns ?? now_ns) + direction * 2 * kExchanges;
  state.exchanges_around_ns = Math.max(oldest_ns + kExchanges, Math.min(newest_ns - kExchanges, middle));
  exchanges.refresh();
}

export function start_timeline(): void {
  also_seen(new Seen(async () => {
    const now = state.past?.now_ns ?? 0;
    if (!runs_on() && (goes_along || now !== followed_ns)) follow_present();
    followed_ns = now;
    seen.refresh();
  }));
}

/** Where the present was last; it is sought again wherever one goes, but not while a run goes on. */
let followed_ns = 0;

/** Whether a run goes on, not just a step: then the timeline shows what was known of it last. */
export function runs_on(): boolean {
  return state.running && (state.own_run || state.others_run || state.hello?.live === true);
}

/** The present as the timeline shows it. */
export function shown_now(): number {
  const now = state.past?.now_ns ?? 0;
  return runs_on() ? Math.min(now, state.spans?.to_ns ?? now) : now;
}

/** As wide as the window is, with the present at its right end. */
function window_at_present(): { from_ns: number; to_ns: number } {
  const { from_ns, to_ns } = window_of(), length = to_ns - from_ns, now = state.past!.now_ns;
  const from = now > from_ns && now < to_ns - length * kMargin / 2 ? from_ns : Math.max(0, now - length * (1 - kMargin));
  return { from_ns: from, to_ns: from + length };
}

/** The present stays in view: at the right end while it is new, in the middle after a jump. */
function follow_present(): void {
  const past = state.past;
  if (!past) return;
  const { from_ns, to_ns } = window_of();
  const length = to_ns - from_ns, now = past.now_ns;
  const room = length * kMargin / 2, is_first = from_ns <= past.oldest_ns;
  if (now > to_ns - room || now < from_ns + (is_first ? 0 : room)) {
    const from = Math.max(0, past.in_the_past ? now - length / 2 : now - length * 0.9);
    state.window = { from_ns: from, to_ns: from + length };
  }
}

function show(from_ns: number, to_ns: number): void {
  const newest = Math.max(state.past?.newest_ns ?? 0, 1e6);
  const length = Math.min(Math.max(kLeastWindow, to_ns - from_ns), newest * 1.2);
  const from = Math.min(Math.max(-length * 0.05, from_ns), newest - length * 0.1);
  state.window = { from_ns: from, to_ns: from + length };
  const now = shown_now();
  goes_along = now >= from && now <= from + length;
  seen.refresh();
  changed();
}

/** Around the present, or around `ns`, which keeps its place. */
export function zoom_by(factor: number, ns?: number): void {
  const { from_ns, to_ns } = window_of();
  const now = shown_now();
  const fixed = ns ?? (now >= from_ns && now <= to_ns ? now : (from_ns + to_ns) / 2);
  show(fixed - (fixed - from_ns) * factor, fixed + (to_ns - fixed) * factor);
}

export function move_by(part: number): void {
  const { from_ns, to_ns } = window_of();
  const length = to_ns - from_ns;
  show(from_ns + part * length, to_ns + part * length);
}

export function move_to(from_ns: number): void {
  const window = window_of();
  show(from_ns, from_ns + window.to_ns - window.from_ns);
}

export function show_all(): void {
  const { oldest_ns = 0, newest_ns = 0 } = state.past ?? {};
  show(oldest_ns, newest_ns + (newest_ns - oldest_ns) * kMargin);
}

export function set_cursor(which: 'a' | 'b', ns = state.past?.now_ns ?? 0): void {
  if (which === 'a') state.cursors.a_ns = ns;
  else state.cursors.b_ns = ns;
  changed();
}

export function clear_cursors(): void {
  state.cursors = { a_ns: null, b_ns: null };
  changed();
}

/** A track has the name of its address. */
export function watch_address(name: string): void {
  const address = symbol_named(name)?.address ?? name;
  if (word_of(address) === undefined) {
    notice(`'${address}' is not ${kAddresses}`, 'error');
    return;
  }
  if (!state.watched.includes(address)) state.watched.push(address);
  show_pane('timeline');
  seen.refresh();
}

export function unwatch(address: string): void {
  state.watched = state.watched.filter((one) => one !== address);
  seen.refresh();
  changed();
}

const kWidest = 10e9, kLeastFound = 20e6;  // ns

/** Goes to what was found. */
export async function show_found(found: { at_ns: number; end_ns: number }): Promise<void> {
  goes_along = true;
  if (await go_to(found.at_ns)) found_last = { at_ns: found.at_ns, shown_ns: state.past?.now_ns ?? 0 };
  bring_into_view(found);
}

let found_last: { at_ns: number; shown_ns: number } | null = null;

/** Where a search goes on from: the CPU stands a little after what was found, at the next instruction. */
export function searched_from(): number {
  const now = state.past?.now_ns ?? 0;
  return found_last?.shown_ns === now ? found_last.at_ns : now;
}

/** It comes into view with room around it; of a window in which it would be less than a pixel, near enough to be seen. */
export function bring_into_view(found: { at_ns: number; end_ns: number }): void {
  const { from_ns, to_ns } = window_of(), window = to_ns - from_ns, room = 2 * kMargin * window;
  const length = Math.max(found.end_ns - found.at_ns, kLeastFound), is_small = window > kWidest && length < kWidest;
  if (is_small || length > window - 2 * room) show(found.at_ns - length / 2, found.end_ns + length / 2);
  else if (found.at_ns < from_ns + room || found.end_ns > to_ns - room) move_to((found.at_ns + found.end_ns - window) / 2);
}
