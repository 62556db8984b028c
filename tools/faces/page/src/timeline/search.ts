// Searches through the past: the nearest trouble, the next request without an answer, the longest answer, the longest scan.
import { exchanges_of, is_unanswered, type Exchange } from '../exchanges';
import { ask_why_latency } from '../causes';
import { line_of, words } from '../commands';
import { command, move, query, run_to, take_over_at_once } from '../session';
import { notice, state } from '../state';
import { duration_text, moment_text, moment_word } from '../words';
import { bring_into_view, searched_from, show_found, spans_searched } from './view';
import type { Span, Spans, Stops } from '../protocol';

function has_trouble(span: Span): boolean {
  return span.error !== undefined || (span.errors ?? 0) > 0;
}

const kFirstPart = 2e9, kLongestPart = 600e9;  // ns that are looked through at once

/** The nearest element with trouble; where several are one, it looks into them. Nothing if something else is wanted meanwhile. */
async function find(from_ns: number, to_ns: number, direction: 1 | -1, is_wanted: () => boolean): Promise<Span | null> {
  const spans = await spans_searched(from_ns, to_ns, is_wanted);
  const found = (spans?.tracks ?? []).flatMap((track) => track.spans.filter(has_trouble))
    .filter((span) => span.at_ns >= from_ns && span.at_ns < to_ns || (span.count ?? 1) > 1)
    .sort((a, b) => direction * (a.at_ns - b.at_ns));
  for (const one of found) {
    if ((one.count ?? 1) <= 1) return one;
    const first = Math.max(from_ns, one.at_ns), last = Math.min(to_ns, one.end_ns + 1);
    if (last - first >= to_ns - from_ns) continue;
    const inside = await find(first, last, direction, is_wanted);
    if (inside) return inside;
  }
  return null;
}

function say_how_far(what: string, at_ns: number): void {
  notice(`Looking for ${what} … ${moment_text(at_ns, 0)}`);
}

/** The same, part by part: what is near is found soon, and it is seen how far a long search has come. */
async function find_by_parts(from_ns: number, to_ns: number, direction: 1 | -1, is_wanted: () => boolean): Promise<Span | null> {
  let [first, last] = [from_ns, to_ns];
  for (let length = kFirstPart; first < last && is_wanted(); length = Math.min(2 * length, kLongestPart)) {
    const [from, to] = direction > 0 ? [first, Math.min(last, first + length)] : [Math.max(first, last - length), last];
    const found = await find(from, to, direction, is_wanted);
    if (found) return found;
    if (direction > 0) first = to;
    else last = from;
    if (is_wanted() && first < last) say_how_far('a lost character or error', direction > 0 ? first : last);
  }
  return null;
}

export async function find_error(direction: 1 | -1): Promise<void> {
  const is_wanted = await take_over_at_once(), past = state.past;
  if (!past || !is_wanted()) return;
  const at = searched_from(), [from, to] = direction > 0 ? [at + 1, past.newest_ns + 1] : [past.oldest_ns, at];
  const found = await find_by_parts(from, to, direction, is_wanted);
  if (!is_wanted()) return;
  if (!found) {
    notice(direction > 0 ? 'No lost character or error after this moment' : 'No lost character or error before this moment');
    return;
  }
  state.selected_span = found;
  await show_found(found);
  notice(found.error ?? found.text);
}

const kMostElements = 20000;

/** All exchanges that begin from `from` on, part by part: shorter parts where there are more frames than a reply can have. */
async function* exchanges_after(from: number, is_wanted: () => boolean): AsyncGenerator<Exchange[]> {
  const begin = from, newest = state.past?.newest_ns ?? 0;
  for (let length = kFirstPart; from < newest;) {
    const to = Math.min(newest, from + length);
    const spans = await spans_searched(from, to, is_wanted, kMostElements);
    if (!spans) return;
    if (spans.tracks.some((track) => track.kind === 'frames' && !track.exact)) {
      length /= 4;
      continue;
    }
    const all = exchanges_of(spans, to);
    const cut = to < newest ? all.findIndex((one) => one.pending) : -1;
    yield (cut < 0 ? all : all.slice(0, cut)).filter((one) => one.at_ns >= begin);
    from = cut < 0 ? to : Math.max(from + 1, all[cut]!.at_ns - 1);
    length = Math.min(2 * length, kLongestPart);
    say_how_far('a request without an answer', from);
  }
}

export async function find_unanswered(): Promise<void> {
  notice('Looking for a request without an answer …');
  const is_wanted = await take_over_at_once();
  for await (const part of exchanges_after(searched_from() + 1, is_wanted)) {
    const found = part.find(is_unanswered);
    if (found) return show_found(found);
  }
  if (is_wanted()) notice('No unanswered request after this moment');
}

/** What was longest in the whole past, which is played once for it; a report of a long run knows it already. */
async function longest_of_past(is_wanted: () => boolean): Promise<Spans | null> {
  const past = state.past;
  if (!past || past.newest_ns === past.oldest_ns) return null;
  const { picture } = state;
  if (picture?.answers && picture.longest_scans && picture.to_ns === past.newest_ns) return picture;
  return spans_searched(past.oldest_ns, past.newest_ns, is_wanted, 1);
}

export async function find_longest(): Promise<void> {
  notice('Looking for the longest answer …');
  const is_wanted = await take_over_at_once(), answers = (await longest_of_past(is_wanted))?.answers, longest = answers?.longest[0];
  if (!is_wanted()) return;
  if (!answers || !longest) {
    notice('There is no answer yet');
    return;
  }
  await ask_why_latency(longest.text, longest.answer_end_ns, longest.station);
  bring_into_view({ at_ns: longest.at_ns, end_ns: longest.answer_end_ns });
  notice(`The ${answers.count === 1 ? 'only answer' : `longest of ${answers.count} answers`}: after ${duration_text(longest.answer_ns - longest.end_ns)}, to ${longest.text}`);
}

export async function find_longest_scan(): Promise<void> {
  notice('Looking for the longest scan …');
  const is_wanted = await take_over_at_once(), all = (await longest_of_past(is_wanted))?.longest_scans ?? [];
  if (!is_wanted()) return;
  const scan = all.find((one) => (one.station ?? '') === (state.past?.station ?? ''));
  if (!scan) {
    notice('No scan has ended yet');
    return;
  }
  await show_found(scan);
  notice(`The longest scan since power-up lasted ${duration_text(scan.end_ns - scan.at_ns)}: ${scan.text}. SMW26 counts whole ms`);
}

const kLongestRun = 10e9;  // ns that are run for a condition when there is no past after this moment

const kPassed = new Set(['limit', 'answer']);

const kCondition = 'a condition; write for example VW20 > 5, Q0.3 or not T37';

/** Goes to the next moment at which a condition comes to hold: through the past, or by running on. */
export async function find_condition(condition: string): Promise<void> {
  if (condition.trim() === '') return;
  const is_wanted = await take_over_at_once(), past = state.past;
  if (!past || !is_wanted()) return;
  const set = await command(line_of`break ${words(condition, kCondition)}`);
  if (/^break expects |^break .*: when\? /.test(set.error ?? '')) notice(`'${condition.trim()}' is not ${kCondition}`, 'error', 'break');
  const stops = set.error === undefined ? (await query<Stops>(line_of`break`)).json : null;
  if (!stops) return;
  const number = Math.max(...stops.stops.map((one) => one.number));
  const length = past.in_the_past ? past.newest_ns - past.now_ns : kLongestRun, end_ns = past.now_ns + length;
  const run = is_wanted() ? await run_to(end_ns, is_wanted) : undefined;
  await command(line_of`delete ${number}`);
  if (!is_wanted() || run?.interrupted || !kPassed.has(run?.json?.stopped ?? '')) return;  // found, paused, or it cannot run so far: that is said
  if (past.in_the_past) await move(line_of`at ${moment_word(past.now_ns)}`);
  notice(`${condition} does not come to hold within ${duration_text(length)}`);
}
