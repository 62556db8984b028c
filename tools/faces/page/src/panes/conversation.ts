// The conversation of a recording: what was asked and answered, with latencies. There is no program, and nothing to run.
import { h, type Part } from '../dom';
import { action, title_with_key } from '../actions';
import { icon } from '../icons';
import { changed, state } from '../state';
import { duration_text, moment_text } from '../words';
import { histogram } from './histogram';
import type { DecodedConversation, DecodedFrame } from '../protocol';

const kPage = 500, kOnPaper = 100;  // rows that are shown at once, and that are printed
let filter = '', only_wrong = false, shown_from = 0;

function is_trouble(one: DecodedFrame): boolean {
  return !one.right || one.unanswered || one.kind === 'stray';
}

/** What a frame says, and what became of it. */
function said(one: DecodedFrame): string {
  return one.unanswered ? `${one.text}: no answer` : one.text;
}

function matches(one: DecodedFrame): boolean {
  if (only_wrong && !is_trouble(one)) return false;
  const words = `${one.place} ${one.kind} ${spaced(one.bytes)} ${said(one)}`.toLowerCase();
  return words.includes(filter.toLowerCase());
}

function spaced(hex: string): string {
  return hex.replace(/..(?=.)/g, '$& ');
}

function us_text(us: number | null): string {
  return us === null ? '' : duration_text(us * 1e3);
}

function row(one: DecodedFrame, number: number): Part {
  return h('tr', { key: number, class: is_trouble(one) ? `${one.kind} trouble` : one.kind },
    h('td', { class: 'number' }, one.at_us === null ? '' : moment_text(one.at_us * 1e3, 3)),
    h('td', { class: 'number' }, us_text(one.silence_us)),
    h('td', {}, one.kind),
    h('td', { class: 'frame' }, spaced(one.bytes)),
    h('td', {}, said(one)),
    h('td', { class: 'number' }, us_text(one.latency_us)),
    h('td', { class: 'hint' }, one.place));
}

function summary(conversation: DecodedConversation): Part {
  const { summary: of, file, form, protocol, line } = conversation;
  const spread = of.shortest_latency_us === null ? '' : `, after ${us_text(of.shortest_latency_us)} to ${us_text(of.longest_latency_us)}`;
  const rows = [
    ['Recording', `${file}${form === null ? '' : `, ${form}`}`], ['Protocol', protocol], ['Line', line ?? ''],
    ['Requests', `${of.requests}, answered: ${of.answered}${spread}`], ['Wrong frames', String(of.wrong)], ['Frames of no request', String(of.strays)],
  ];
  return h('table', { class: 'summary' }, h('tbody', {}, rows.filter(([, text]) => text !== '').map(([name, text]) => h('tr', {}, h('th', { scope: 'row' }, name!), h('td', {}, text!)))));
}

/** Which of the rows that fit are shown: there may be a hundred thousand. */
function pager(count: number): Part | null {
  if (count <= kPage) return null;
  const go = (from: number) => () => { shown_from = from; changed(); };
  return h('span', { class: 'choice' },
    h('button', { disabled: shown_from === 0, 'aria-label': 'Rows before', onclick: go(Math.max(0, shown_from - kPage)) }, icon('back')),
    h('button', { disabled: shown_from + kPage >= count, 'aria-label': 'Rows after', onclick: go(shown_from + kPage) }, icon('forward')));
}

/** The whole page of such a report. */
export function conversation_page(conversation: DecodedConversation): Part[] {
  const fits = conversation.frames.map((one, number) => ({ one, number })).filter(({ one }) => matches(one));
  if (shown_from >= fits.length) shown_from = 0;
  const latencies = conversation.frames.flatMap((one) => (one.latency_us === null ? [] : [one.latency_us * 1e3]));
  const last = Math.min(fits.length, shown_from + (state.printing ? kOnPaper : kPage));
  return [
    h('header', { class: 'toolbar' }, h('h1', {}, 'Conversation'), h('div', { class: 'group right' },
      ['theme', 'about'].map((id) => h('button', { id: `do-${id}`, title: title_with_key(action(id)), 'aria-label': action(id).title, onclick: action(id).does }, id === 'theme' ? icon('theme') : 'About')))),
    h('main', { class: 'conversation' },
      summary(conversation),
      h('div', { class: 'chart-tools' },
        h('input', { type: 'search', id: 'frame-filter', placeholder: 'Filter', 'aria-label': 'Filter', oninput: (event: Event) => { filter = (event.target as HTMLInputElement).value; changed(); } }),
        h('button', { 'aria-pressed': String(only_wrong), onclick: () => { only_wrong = !only_wrong; changed(); } }, 'Only trouble'),
        histogram(latencies), pager(fits.length),
        h('span', { class: 'hint rows-shown' }, fits.length === 0 ? 'no frames' : `${shown_from + 1} to ${last} of ${fits.length} frames${state.printing && filter !== '' ? ` with '${filter}'` : ''}`)),
      h('div', { class: 'conversation-rows' }, h('table', { class: 'exchanges' },
        h('thead', {}, h('tr', {}, ['At', 'Silence', '', 'Bytes', 'What it says', 'Latency', 'Place'].map((name) => h('th', {}, name)))),
        h('tbody', {}, fits.slice(shown_from, last).map(({ one, number }) => row(one, number)))))),
  ];
}
