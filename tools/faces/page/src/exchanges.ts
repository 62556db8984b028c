// Requests and answers, put together from the frames of the timeline.
import type { Span, Spans } from './protocol';

export interface Exchange {
  at_ns: number;
  end_ns: number;
  station: string;
  /** The PLC is the master. */
  sent: boolean;
  request: string;
  answer?: string;
  error?: string;
  latency_ns?: number;
  answer_end_ns?: number;
  pending?: boolean;
  overdue?: boolean;
  /** When the next request came. */
  next_at_ns?: number;
  /** The PLC that asks, if it is one. */
  asker?: string;
  /** How many other PLCs of the line heard it, none of which answers. */
  others?: number;
}

const kAwaited = 1e9;  // ns for which a request without an answer may still get one
const kOverdue = 100e6;  // ns after which most programs have made up their mind about it

function is_sent(frame: Span): boolean {
  return frame.text.startsWith('sent');
}

function words_of(frame: Span): string {
  return frame.text.replace(/^(sent|received) /, '');
}

/** A request of Modbus RTU names its station. */
function asks(frame: Span): boolean {
  return /: station \d+: /.test(frame.text);
}

/** Its request was before the part of the time that is looked at. */
function answers_earlier(frame: Span): boolean {
  return /: an answer of station \d+$/.test(frame.text);
}

/** What a part begins with may be the answer to an earlier request: nobody answers it, and what follows asks the PLC. */
function without_first_answer(all: Exchange[]): Exchange[] {
  const [first, second] = all;
  return first?.sent && first.answer === undefined && second && !second.sent ? all.slice(1) : all;
}

/** A frame on the line, whoever sends or hears it. */
function on_line(frame: { at_ns: number; end_ns: number }, words: string): string {
  return `${frame.at_ns} ${frame.end_ns} ${words.split(':', 1)[0]}`;
}

/**
 * What all PLCs of a line hear is one request: of the one that answers; else of one to which it came damaged, or of the first. What
 * one of them answers is heard by the others, and asks nobody.
 */
function of_lines(all: Exchange[]): Exchange[] {
  const answers = new Set(all.flatMap((one) => (one.sent || one.answer === undefined ? [] : [on_line({ at_ns: one.end_ns + one.latency_ns!, end_ns: one.answer_end_ns! }, one.answer)])));
  const requests = new Map<string, Exchange[]>();
  for (const one of all) {
    const key = on_line(one, one.request);
    if (one.sent || !answers.has(key)) requests.set(key, [...requests.get(key) ?? [], one]);
  }
  return [...requests.values()].flatMap(once);
}

/** Of the ends of one request on a line those that tell most of it. */
function once(same: Exchange[]): Exchange[] {
  const asker = same.find((one) => one.sent), heard = same.filter((one) => !one.sent), answered = heard.filter((one) => one.answer !== undefined);
  if (heard.length === 0) return same;
  const shown = answered.length > 0 ? answered : [heard.find((one) => one.error !== undefined) ?? heard[0]!];
  return shown.map((one) => ({ ...one, ...(asker ? { asker: asker.station } : {}), ...(heard.length > shown.length ? { others: heard.length - shown.length } : {}) }));
}

/**
 * A frame that the PLC receives is a request, and the next one that it sends, before another request, is the answer. A PLC
 * that is a master sends requests of Modbus and receives their answers. What has run up to `known_ns` says whether there was an
 * answer, wherever one stands in that past.
 */
export function exchanges_of(spans: Spans | null, known_ns: number): Exchange[] {
  const all: Exchange[] = [];
  for (const track of spans?.tracks ?? []) {
    if (track.kind !== 'frames') continue;
    let open: Exchange | undefined;
    const of_track: Exchange[] = [];
    for (const frame of track.spans) {
      const sent = is_sent(frame), answers = open !== undefined && open.sent !== sent && !asks(frame);
      if (!answers && answers_earlier(frame)) continue;
      if (!answers && (!sent || asks(frame))) {
        open = { at_ns: frame.at_ns, end_ns: frame.end_ns, station: track.station ?? '', sent, request: words_of(frame) };
        if (frame.error !== undefined) open.error = frame.error;
        of_track.push(open);
      } else if (open) {
        open.answer = words_of(frame);
        open.latency_ns = frame.at_ns - open.end_ns;
        open.answer_end_ns = frame.end_ns;
        if (frame.error !== undefined) open.error = frame.error;
        open = undefined;
      }
    }
    if (open && known_ns - open.end_ns < kAwaited) open.pending = true;
    if (open?.pending && known_ns - open.end_ns > kOverdue) open.overdue = true;
    all.push(...(spans!.from_ns > 0 ? without_first_answer(of_track) : of_track));
  }
  const requests = of_lines(all).sort((a, b) => a.at_ns - b.at_ns);
  requests.slice(1).forEach((next, i) => { requests[i]!.next_at_ns = next.at_ns; });
  return requests;
}

const kShortestText = 2;  // characters
const kEscapes: Record<number, string> = { 9: '\\t', 10: '\\n', 13: '\\r' };

/** `48 45 4c 4c 4f 0d` with `'HELLO\r'` beside it, if all of it is text and nothing else is said of it. */
export function with_text(frame: string): string {
  if (!/^[0-9a-f]{2}( [0-9a-f]{2})*$/.test(frame)) return frame;
  const bytes = frame.split(' ').map((one) => parseInt(one, 16));
  if (bytes.length < kShortestText || !bytes.every((one) => (one >= 0x20 && one < 0x7f) || kEscapes[one] !== undefined)) return frame;
  return `${frame}  '${bytes.map((one) => kEscapes[one] ?? String.fromCharCode(one)).join('')}'`;
}

/** Whether it may still be answered, and one may ask why it is not yet. */
export function is_overdue(one: Exchange): boolean {
  return one.answer === undefined && one.overdue === true;
}

export function is_unanswered(one: Exchange): boolean {
  return one.answer === undefined && one.pending !== true;
}
