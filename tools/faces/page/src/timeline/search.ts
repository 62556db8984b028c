// Searches through the past: the nearest trouble, the next request without an answer, the longest answer, the longest scan.
import { exchanges_of, is_unanswered, type Exchange } from '../exchanges';
import { ask_why_latency } from '../causes';
import { command, move } from '../session';
import { notice, state } from '../state';
import { duration_text, moment_word } from '../words';
import { show_found, spans_between } from './view';
import type { Answers, Span, Stopped, Stops, Value } from '../protocol';

function has_trouble(span: Span): boolean {
  return span.error !== undefined || (span.errors ?? 0) > 0;
}

/** The nearest element with trouble; where several are one, it looks into them. */
async function find(from_ns: number, to_ns: number, direction: 1 | -1): Promise<Span | null> {
  const spans = await spans_between(from_ns, to_ns);
  const found = (spans?.tracks ?? []).flatMap((track) => track.spans.filter(has_trouble))
    .filter((span) => span.at_ns >= from_ns && span.at_ns < to_ns || (span.count ?? 1) > 1)
    .sort((a, b) => direction * (a.at_ns - b.at_ns));
  for (const one of found) {
    if ((one.count ?? 1) <= 1) return one;
    const first = Math.max(from_ns, one.at_ns), last = Math.min(to_ns, one.end_ns + 1);
    if (last - first >= to_ns - from_ns) continue;
    const inside = await find(first, last, direction);
    if (inside) return inside;
  }
  return null;
}

export async function find_error(direction: 1 | -1): Promise<void> {
  const past = state.past;
  if (!past) return;
  const [from, to] = direction > 0 ? [past.now_ns + 1, past.newest_ns + 1] : [past.oldest_ns, past.now_ns];
  const found = to > from ? await find(from, to, direction) : null;
  if (!found) {
    notice(direction > 0 ? 'No lost character or error after this moment' : 'No lost character or error before this moment');
    return;
  }
  state.selected_span = found;
  await show_found(found);
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
  for await (const part of exchanges_after((state.past?.now_ns ?? 0) + 1)) {
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
  const answers = await answers_of_past(), longest = answers?.longest[0];
  if (!answers || !longest) {
    notice('There is no answer yet');
    return;
  }
  await show_found({ at_ns: longest.at_ns, end_ns: longest.answer_end_ns });
  await ask_why_latency(longest.text, longest.answer_end_ns, longest.station);
  notice(`The longest of ${answers.count} answers: after ${duration_text(longest.answer_ns - longest.end_ns)}, to ${longest.text}`);
}

/** The longest scan since power-up, in ms, as the CPU knows it at a moment. */
async function longest_scan_at(ns: number): Promise<number> {
  const reply = await command<{ values: Value[] }>(`at ${moment_word(ns)}; values SMW26`);
  return Number(reply.json?.values[0]?.number ?? 0);
}

/** The CPU counts it only up: the moment at which it came to what it is in the end is found by halves. */
export async function find_longest_scan(): Promise<void> {
  const past = state.past;
  if (!past) return;
  notice('Looking for the longest scan …');
  const ms = await longest_scan_at(past.newest_ns);
  if (ms === 0) {
    notice('No scan has lasted 1 ms yet');
    return;
  }
  let before = past.oldest_ns, since = past.newest_ns;
  while (since - before > 1e6) {
    const middle = Math.floor((before + since) / 2);
    if (await longest_scan_at(middle) >= ms) since = middle;
    else before = middle;
  }
  const now = (): number => state.past?.now_ns ?? 0;
  await move(`at ${moment_word(since)}`);
  let end_ns = since;
  while (now() > Math.max(past.oldest_ns, since - ms * 1e6 / 2)) {
    end_ns = now();
    await move('rscan');
  }
  await show_found({ at_ns: now(), end_ns });
  notice(`The longest scan since power-up lasted ${ms} ms (SMW26): scan ${state.past?.scan ?? ''}; others may have lasted as many`);
}

const kLongestRun = 10e9;  // ns that are run for a condition when there is no past after this moment

/** Goes to the next moment at which a condition comes to hold: through the past, or by running on. */
export async function find_condition(condition: string): Promise<void> {
  const past = state.past;
  if (!past || condition.trim() === '') return;
  const set = await command<Stops>(`break ${condition}; break`);
  if (set.error !== undefined || !set.json) return;
  const number = Math.max(...set.json.stops.map((one) => one.number));
  const length = past.in_the_past ? past.newest_ns - past.now_ns : kLongestRun;
  const run = await move<Stopped>(`continue ${moment_word(length)}`);
  await command(`delete ${number}`);
  if (run.json?.stopped === 'stop point') return;
  if (past.in_the_past) await move(`at ${moment_word(past.now_ns)}`);
  notice(`${condition} does not come to hold within ${duration_text(length)}`);
}
