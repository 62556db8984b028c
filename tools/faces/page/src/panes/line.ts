// The line: a request to send, and what was asked and answered.
import { h, type Part } from '../dom';
import { line_of, words } from '../commands';
import { command, go_to, query, Seen } from '../session';
import { changed, notice, rows_shown, state } from '../state';
import { ask_why_latency, ask_why_unanswered } from '../causes';
import { list_exchanges, see_exchanges } from '../timeline/view';
import { exchanges_of, is_overdue, is_unanswered, with_text, type Exchange } from '../exchanges';
import { action, title_with_key } from '../actions';
import { clock_text, duration_text, moment_text } from '../words';
import { histogram } from './histogram';
import type { Hello, Past, PortSettings } from '../protocol';

let filter = '';

const kStillUnderWay = 'send: the last frame is still under way';

const kSendable = 'a frame or a request; write for example 01 03 00 0a 00 02 crc, read 40011:2, or text in quotation marks';

async function send(text: string): Promise<void> {
  const line = text.trim();
  if (line === '') return;
  const reply = await command(line_of`send ${words(line, kSendable)}`), told = `send ${line}: `, at_ns = state.past?.now_ns ?? 0;
  if (reply.error?.startsWith(told)) notice(reply.error.slice(told.length), 'error', 'send');
  if (reply.error?.startsWith(kStillUnderWay)) notice('The last frame is still under way or waiting for its answer: Run on first', 'error', 'send');
  if (reply.error === undefined) waiting = { of: state.hello, at_ns, frame: line };
  changed();
}

/** What was sent while the program stood at that moment: it is on the line as soon as it runs. */
let waiting: { of: Hello | null; at_ns: number; frame: string } | null = null;

function waiting_row(): Part | null {
  if (!waiting || waiting.of !== state.hello || state.running || waiting.at_ns !== state.past?.now_ns) return null;
  return h('tr', { key: 'waits', class: 'waits' }, h('td', {}, ''), h('td', { class: 'frame' }, waiting.frame), h('td', { class: 'frame' }, 'waits for Run'), h('td', {}, ''));
}

let port_settings: PortSettings | null = null, port_at: Past | null = null;
const port = new Seen(async () => { port_settings = (await query<PortSettings>(line_of`port`)).json; });

/** How the port is set up at the moment that is looked at: programs change that. */
function port_text(): string {
  if (state.past !== port_at) {
    port_at = state.past;
    port.refresh();
  }
  const parts = /^(.*?): (.*)$/.exec(port_settings?.mode ?? ''), station = state.past?.station ?? '';
  return parts ? `${station === '' ? 'Port' : `${station}, port`} ${port_settings!.port}: ${parts[2]} (${parts[1]} now); what is sent here has the same format` : '';
}

const kExamples = ['01 03 00 0a 00 02 crc', 'read 40011:2', 'write 40011=1234', "'HELLO\\r'"];

/** What nobody answers is shown of one of those that have heard it. */
function asked_text(one: Exchange): string {
  if (one.sent) return `${one.station} asks`;
  if (one.answer === undefined && one.others) return `${one.asker === undefined ? '' : `${one.asker} asks: `}${one.others + 1} PLCs hear it`;
  return one.asker === undefined ? `${one.station} is asked` : `${one.asker} asks ${one.station}`;
}

function row(one: Exchange, i: number): Part {
  const unanswered = is_unanswered(one) || is_overdue(one);
  const result = one.error ?? (one.answer === undefined ? undefined : with_text(one.answer)) ?? (one.pending ? 'under way …' : one.others ? 'no PLC answers' : 'no answer');
  const why = unanswered ? { title: 'What kept the program from an answer', ask: () => void ask_why_unanswered(one) }
    : one.answer_end_ns === undefined || one.sent ? null : { title: 'What the answer waited for', ask: () => void ask_why_latency(one.request, one.answer_end_ns!, one.station) };
  return h('tr', { key: i, class: one.error !== undefined || is_unanswered(one) ? 'trouble' : '', onclick: () => void go_to(one.at_ns) },
    h('td', {}, h('button', { class: 'link', title: 'Go to this request' }, moment_text(one.at_ns))),
    h('td', { class: 'frame' }, one.station === '' ? null : h('div', { class: 'asked', title: one.others ? `${one.others} more ${one.others === 1 ? 'PLC has' : 'PLCs have'} heard it` : '' }, asked_text(one)),
      h('div', { class: 'frame-text', title: one.request }, with_text(one.request))), h('td', { class: 'frame' }, result, why ? h('button', { class: 'why', title: why.title, onclick: (event: Event) => { event.stopPropagation(); why.ask(); } }, 'Why?') : null),
    h('td', { class: 'number' }, one.latency_ns === undefined ? '' : duration_text(one.latency_ns)));
}

const kShown = 200;  // rows of the table

function latencies_of(all: Exchange[]): number[] {
  return all.flatMap((one) => (one.latency_ns === undefined ? [] : [one.latency_ns]));
}

/** Which part of the past is listed, unless it is all of it, and the way to the others. */
function part(): Part | null {
  const listed = state.exchanges;
  if (!listed || !(state.exchanges_before || state.exchanges_after)) return null;
  return h('p', { class: 'part' },
    h('button', { id: 'exchanges-before', disabled: !state.exchanges_before, onclick: () => list_exchanges(-1) }, 'Earlier'),
    h('button', { id: 'exchanges-after', disabled: !state.exchanges_after, onclick: () => list_exchanges(1) }, 'Later'),
    h('span', { class: 'hint' }, `Only ${clock_text(listed.from_ns, 0)} to ${clock_text(listed.to_ns, 0)} of ${clock_text(state.past?.newest_ns ?? 0, 0)} is listed, filtered and measured here`));
}

function summary(all: Exchange[]): string {
  const latencies = latencies_of(all);
  if (all.length === 0) return state.exchanges ? 'no request' : '';
  const unanswered = all.filter(is_unanswered).length;
  const ends = [...new Set([Math.min(...latencies), Math.max(...latencies)])].map(duration_text).join(' … ');
  const spread = latencies.length === 0 ? '' : `, latency ${ends}`;
  return `${all.length} ${all.length === 1 ? 'request' : 'requests'}, ${unanswered} without an answer${spread}`;
}

export function line_pane(): Part {
  see_exchanges();
  const all = exchanges_of(state.exchanges, state.exchanges?.to_ns ?? 0);
  const shown = filter === '' ? all : all.filter((one) => `${one.request} ${one.answer ?? 'no answer'} ${one.error ?? ''}`.toLowerCase().includes(filter.toLowerCase()));
  const rows = shown.slice(-rows_shown(kShown)).reverse(), older = shown.length - rows.length;
  return h('div', { class: 'line-pane' },
    h('form', { class: 'send', onsubmit: (event: Event) => { event.preventDefault(); void send(state.send_text); } },
      h('input', { id: 'send-text', 'aria-label': 'Frame, text or request', value: state.send_text, placeholder: kExamples[0]!, list: 'requests', autocomplete: 'off', spellcheck: 'false',
        oninput: (event: Event) => { state.send_text = (event.target as HTMLInputElement).value; } }),
      h('button', { id: 'do-send' }, 'Send')),
    h('datalist', { id: 'requests' }, kExamples.map((one) => h('option', { value: one }))),
    h('p', { class: 'hint send' }, 'Hex, crc for the check, text in quotation marks; or a Modbus request: read 40011:2, write 40011=5'),
    h('p', { class: 'hint port', title: 'Unless s7200 was started with --baud, --parity, --data-bits or --stop-bits' }, port_text()),
    h('div', { class: 'chart-tools' },
      h('input', { type: 'search', placeholder: 'Filter', 'aria-label': 'Filter', oninput: (event: Event) => { filter = (event.target as HTMLInputElement).value; changed(); } }),
      h('button', { title: title_with_key(action('longest')), onclick: action('longest').does }, 'Longest answer'),
      histogram(latencies_of(shown)), h('span', { class: 'hint' }, filter === '' ? '' : `${shown.length} of ${all.length} pass the filter: `, summary(shown))),
    part(),
    h('table', { class: 'exchanges' },
      h('thead', {}, h('tr', {}, ['Request at', 'Request', 'Answer', 'Latency'].map((name) => h('th', {}, name)))),
      h('tbody', {}, waiting_row(), rows.map(row))),
    older > 0 ? h('p', { class: 'hint' }, `and ${older} before these`) : null);
}
