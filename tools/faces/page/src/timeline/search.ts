// Searches through the past: the nearest trouble, the next request without an answer, the longest answer, the longest scan.
import { exchanges_of, is_unanswered, type Exchange } from '../exchanges';
import { ask_why_latency } from '../causes';
import { command, move, run_to, take_over } from '../session';
import { notice, state } from '../state';
import { duration_text, moment_word } from '../words';
import { bring_into_view, show_found, spans_between } from './view';
import type { Answers, Span, Stops } from '../protocol';

function has_trouble(span: Span): boolean {
  return span.error !== undefined || (span.errors ?? 0) > 0;
}

/** The nearest element with trouble; where several are one, it looks into them. Nothing if something else is wanted meanwhile. */
async function find(from_ns: number, to_ns: number, direction: 1 | -1, is_wanted: () => boolean): Promise<Span | null> {
  const spans = await spans_between(from_ns, to_ns);
  if (!is_wanted()) return null;
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

export async function find_error(direction: 1 | -1): Promise<void> {
  const past = state.past;
  if (!past) return;
  const [from, to] = direction > 0 ? [past.now_ns + 1, past.newest_ns + 1] : [past.oldest_ns, past.now_ns];
  const is_wanted = take_over();
  const found = to > from ? await find(from, to, direction, is_wanted) : null;
  if (!is_wanted()) return;
  if (!found) {
    notice(direction > 0 ? 'No lost character or error after this moment' : 'No lost character or error before this moment');
    return;
  }
  state.selected_span = found;
  await show_found(found);
  notice(found.error ?? found.text);
}

const kFirstPart = 2e9, kLongestPart = 600e9;  // ns that are looked through at once
const kMostElements = 20000;

/** All exchanges after `from`, part by part: shorter parts where there are more frames than a reply can have. */
async function* exchanges_after(from: number): AsyncGenerator<Exchange[]> {
  const newest = state.past?.newest_ns ?? 0;
  for (let length = kFirstPart; from < newest;) {
    const to = Math.min(newest, from + length);
    const spans = await spans_between(from, to, kMostElements);
    if (!spans) return;
    if (spans.tracks.some((track) => track.kind === 'frames' && !track.exact)) {
      length /= 4;
      continue;
    }
    const all = exchanges_of(spans, to);
    const cut = to < newest ? all.findIndex((one) => one.pending) : -1;
    yield cut < 0 ? all : all.slice(0, cut);
    from = cut < 0 ? to : Math.max(from + 1, all[cut]!.at_ns - 1);
    length = Math.min(2 * length, kLongestPart);
  }
}

export async function find_unanswered(): Promise<void> {
  notice('Looking for a request without an answer …');
  const is_wanted = take_over();
  for await (const part of exchanges_after((state.past?.now_ns ?? 0) + 1)) {
    if (!is_wanted()) return;
    const found = part.find(is_unanswered);
    if (found) return show_found(found);
  }
  notice('No unanswered request after this moment');
}

/** Of the whole past, which is played once for it; a report of a long run knows it already. */
async function answers_of_past(): Promise<Answers | undefined> {
  const past = state.past;
  if (!past) return undefined;
  if (state.picture?.answers && state.picture.to_ns === past.newest_ns) return state.picture.answers;
  return (await spans_between(past.oldest_ns, past.newest_ns, 1))?.answers;
}

export async function find_longest(): Promise<void> {
  notice('Looking for the longest answer …');
  const is_wanted = take_over(), answers = await answers_of_past(), longest = answers?.longest[0];
  if (!is_wanted()) return;
  if (!answers || !longest) {
    notice('There is no answer yet');
    return;
  }
  await ask_why_latency(longest.text, longest.answer_end_ns, longest.station);
  bring_into_view({ at_ns: longest.at_ns, end_ns: longest.answer_end_ns });
  notice(`The ${answers.count === 1 ? 'only answer' : `longest of ${answers.count} answers`}: after ${duration_text(longest.answer_ns - longest.end_ns)}, to ${longest.text}`);
}

const kLongestScan = 'SMW26';  // ms since power-up

/** The change at which a value came to what it is most; where several are one, it looks into them. */
async function change_to_most(address: string, from_ns: number, to_ns: number, is_wanted: () => boolean): Promise<Span | null> {
  const spans = await spans_between(from_ns, to_ns, undefined, [address]);
  const all = spans?.tracks.find((one) => one.kind === 'value')?.spans ?? [];
  const most_of = (one: Span): number => one.most ?? one.value ?? 0;
  const most = Math.max(...all.map(most_of)), first = all.find((one) => most_of(one) === most);
  if (!first || !is_wanted()) return null;
  const is_one = (first.count ?? 1) <= 1 || first.end_ns - first.at_ns >= to_ns - from_ns;
  return is_one ? first : change_to_most(address, first.at_ns, first.end_ns, is_wanted);
}

export async function find_longest_scan(): Promise<void> {
  const past = state.past;
  if (!past || past.newest_ns === 0) return;
  notice('Looking for the longest scan …');
  const is_wanted = take_over();
  const change = await change_to_most(kLongestScan, past.oldest_ns, past.newest_ns, is_wanted);
  if (!is_wanted()) return;
  const ms = change?.value ?? 0;
  if (!change || ms === 0) {
    notice('No scan has lasted 1 ms yet');
    return;
  }
  const spans = await spans_between(Math.max(past.oldest_ns, change.at_ns - (ms + 1) * 1e6), Math.min(past.newest_ns, change.at_ns + 1));
  if (!is_wanted()) return;
  const scans = spans?.tracks.filter((one) => one.kind === 'scans' && (one.station ?? '') === past.station).flatMap((one) => one.spans) ?? [];
  const scan = scans.sort((a, b) => b.end_ns - b.at_ns - (a.end_ns - a.at_ns))[0] ?? change;
  await show_found(scan);
  notice(`The longest scan since power-up lasted ${ms} ms (${kLongestScan}): ${scan.text}. It counts whole ms: another scan may have lasted a little longer`);
}

const kLongestRun = 10e9;  // ns that are run for a condition when there is no past after this moment

const kPassed = new Set(['limit', 'answer']);

/** Goes to the next moment at which a condition comes to hold: through the past, or by running on. */
export async function find_condition(condition: string): Promise<void> {
  const past = state.past;
  if (!past || condition.trim() === '') return;
  const is_wanted = take_over(), set = await command<Stops>(`break ${condition}; break`);
  if (set.error !== undefined || !set.json) return;
  const number = Math.max(...set.json.stops.map((one) => one.number));
  const length = past.in_the_past ? past.newest_ns - past.now_ns : kLongestRun, end_ns = past.now_ns + length;
  const run = is_wanted() ? await run_to(end_ns, is_wanted) : undefined;
  await command(`delete ${number}`);
  if (!is_wanted() || !kPassed.has(run?.json?.stopped ?? '')) return;  // found, paused, or it cannot run so far: that is said
  if (past.in_the_past) await move(`at ${moment_word(past.now_ns)}`);
  notice(`${condition} does not come to hold within ${duration_text(length)}`);
}
