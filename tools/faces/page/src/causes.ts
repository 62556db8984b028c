// Why and who: each answer is a step of a trail that one walks back to the cause.
import { changed, notice, show_pane, state } from './state';
import { line_of, symbol_named, type Command } from './commands';
import { command, fetch_chunk_of, go_to, look_at, query, Seen, take_over } from './session';
import { bring_into_view } from './timeline/view';
import type { Exchange } from './exchanges';
import type { Cause, Done, Past, Value } from './protocol';

const kMostSteps = 200;

/** The answer comes to the front unless the reader has chosen another pane meanwhile. */
async function ask(question: string, line: Command): Promise<void> {
  const at_ns = state.past?.now_ns ?? 0, { pane, side } = state;
  const reply = await command<Cause>(line);
  if (reply.error !== undefined) return;
  state.trail = [...state.trail, { question, at_ns, text: reply.text.trimEnd(), cause: reply.json }].slice(-kMostSteps);
  if (state.pane === pane && state.side === side) show_pane('causes');
  changed();
}

function named(address: string): string {
  const symbol = state.outline?.symbols.find((one) => one.address.toUpperCase() === address.toUpperCase());
  return symbol ? `${symbol.name} (${address})` : address;
}

export function ask_why(address = ''): Promise<void> {
  return ask(address ? `Why is ${named(address)} so?` : 'Why has it come here?', address ? line_of`why ${address}` : line_of`why`);
}

/** What keeps a bit off, or on, and the fewest contacts that would have to change. */
export async function ask_why_not(address: string): Promise<void> {
  const reply = await command<{ values: Value[] }>(line_of`values ${address}`);
  const value = reply.json?.values[0];
  if (value?.error === undefined && value?.type !== undefined && value.type !== 'bit') {
    notice(`${named(address)} is not a bit, which something could keep on or off: 'Why?' says what wrote it`, 'error', 'values');
    return;
  }
  const on = Number(value?.number ?? 0) === 1;
  await ask(`What keeps ${named(address)} ${on ? 'on' : 'off'}?`, on ? line_of`why not not ${address}` : line_of`why not ${address}`);
}

export function ask_who(address: string): Promise<void> {
  return ask(`Who wrote ${named(address)} last?`, line_of`who ${address}`);
}

const kBytes: Record<string, number> = { '': 1, B: 1, W: 2, D: 4 };

/** The bytes of V, M and the others that an address means, and its bit if it is one. */
function place_of(address: string): { area: string; first: number; end: number; bit: string } | undefined {
  const parts = /^(SM|[IQVMSL]|A[IQ](?=W))([BWD]?)(\d+)(?:\.(\d))?$/.exec(address.toUpperCase());
  return parts ? { area: parts[1]!, first: Number(parts[3]), end: Number(parts[3]) + kBytes[parts[2]!]!, bit: parts[4] ?? '' } : undefined;
}

/** Whether both have memory in common. */
export function overlap(one: string, other: string): boolean {
  const a = place_of(one), b = place_of(other);
  if (!a || !b) return one.toUpperCase() === other.toUpperCase();
  return a.area === b.area && a.first < b.end && b.first < a.end && (a.bit === '' || b.bit === '' || a.bit === b.bit);
}

const kMostUses = 300;

/** The lines of the program that name an address, or memory of it: Micro/WIN's cross reference. */
export async function ask_where_used(name: string): Promise<void> {
  const address = symbol_named(name)?.address ?? name, at_ns = state.past?.now_ns ?? 0, is_wanted = take_over(), uses: string[] = [];
  for (let line = 1; line <= (state.outline?.lines ?? 0); ++line) {
    await fetch_chunk_of(line);
    const one = state.lines.get(line), named_so = one?.operands?.filter((each) => each.address !== '' && overlap(each.address, address)) ?? [];
    if (one && named_so.length > 0) uses.push(`line ${line}: ${one.text.trim()}${named_so.some((each) => each.address === address) ? '' : ` (${named_so[0]!.address})`}`);
  }
  if (!is_wanted()) return;
  const more = uses.length - kMostUses;
  const text = uses.length === 0 ? 'The program does not name it; a pointer may lead there.' : [...uses.slice(0, kMostUses), ...(more > 0 ? [`and ${more} more`] : [])].join('\n');
  state.trail = [...state.trail, { question: `Where is ${named(address)} used?`, at_ns, text, cause: null }].slice(-kMostSteps);
  show_pane('causes');
}

/** What the last change of an address made otherwise, and until when. */
export function ask_effect(address: string): Promise<void> {
  return ask(`What came of the last change of ${named(address)}?`, line_of`effect ${address}`);
}

const kShownBytes = 12;

/** A frame by its first bytes, and what it says. */
export function in_short(frame: string): string {
  const parts = /^((?:[0-9a-f]{2} ?)+)(.*)$/s.exec(frame), bytes = parts?.[1]!.trim().split(' ') ?? [];
  return bytes.length <= kShownBytes ? frame : `${bytes.slice(0, kShownBytes).join(' ')} …${parts![2]}`;
}

/** In a system the PLC that it is about is asked. */
async function look_from(station: string): Promise<void> {
  if (station !== '' && station !== state.past?.station) await look_at(station);
}

const kAfterRequest = 100e6;  // ns after a request, when the program has made up its mind about it

/** A little after a request and before the next one it is known why it had no answer. */
export async function go_to_verdict(one: Exchange): Promise<void> {
  await look_from(one.station);
  await go_to(Math.min(one.end_ns + kAfterRequest, one.next_at_ns ?? Infinity, state.past?.newest_ns ?? 0));
}

export async function ask_why_unanswered(one: Exchange): Promise<void> {
  await go_to_verdict(one);
  bring_into_view({ at_ns: one.at_ns, end_ns: Math.max(one.end_ns, state.past?.now_ns ?? 0) });
  await ask(`Why has ${in_short(one.request)} no answer?`, line_of`why`);
}

/** What an answer of a PLC has waited for, as it is known at its end. */
export async function ask_why_latency(request: string, answer_end_ns: number, station = ''): Promise<void> {
  await look_from(station);
  await go_to(answer_end_ns);
  await ask(`What did the answer to ${in_short(request)} wait for?`, line_of`why latency`);
}

const kDone = 200;  // actions that are listed
const done = new Seen(async () => {
  const reply = await query<Done>(line_of`actions ${kDone}`);
  state.done = reply.json ?? null;
});
let done_at: Past | null = null;

/** The list is seen, and asked for whenever the session has moved or changed. */
export function see_done(): void {
  if (state.past === done_at) return;
  done_at = state.past;
  done.refresh();
}

export function forget_trail(): void {
  state.trail = [];
  changed();
}
