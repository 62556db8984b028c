// The trail: what was asked, what the answer is, and the way on from there.
import { h, type Child, type Part } from '../dom';
import { ask_effect, ask_who, ask_why, ask_why_not, forget_trail, see_done } from '../causes';
import { line_of } from '../commands';
import { go_to, move } from '../session';
import { switch_to, terminal_level } from '../switches';
import { show_line } from './program';
import { rows_shown, state, type TrailStep } from '../state';
import { moment_text, with_times } from '../words';
import type { Obstacle } from '../protocol';

const kAddress = /\b(?:(?:SM|[IQVMSL])\d+\.[0-7]|(?:SM|[IQVMSL])[BWD]\d+|A[IQ]W\d+|[TC]\d{1,3}|HC\d|AC[0-3])\b/g;
const kLine = /\bline (\d+)\b/g;
const kMoment = /\b(\d+\.\d{6}) ms\b/g;

/** A line of an answer: its moments lead there, its addresses ask on. */
export function linked(line: string): Child[] {
  const parts: Child[] = [];
  let end = 0;
  const marks = [...line.matchAll(kAddress), ...line.matchAll(kMoment), ...(state.hello?.stations.length ? [] : line.matchAll(kLine))].sort((a, b) => a.index! - b.index!);
  for (const mark of marks) {
    if (mark.index! < end) continue;
    parts.push(with_times(line.slice(end, mark.index)));
    const text = mark[0], number = Number(mark[1]);
    const ns = Math.round(number * 1e6);
    parts.push(text.startsWith('line') ? h('button', { class: 'link', title: 'Show this line', onclick: () => show_line(number) }, text)
      : mark[1] !== undefined
      ? h('button', { class: 'link', title: 'Go to this moment', onclick: () => void go_to(ns) }, moment_text(ns))
      : h('button', { class: 'link', title: `Why ${text}?`, onclick: () => void ask_why(text) }, text));
    end = mark.index! + text.length;
  }
  parts.push(with_times(line.slice(end)));
  return parts;
}

const kOpen = 4;  // levels of the tree that are seen at once

function since(one: Obstacle): Child[] {
  if (one.since_ns === 0) return [' since power-up'];
  const ns = one.since_ns ?? one.since_before_ns;
  return ns === undefined ? [] : [' since ', ...linked(`${(ns / 1e6).toFixed(6)} ms`), one.since_ns === undefined ? ' or longer' : ''];
}

/** What is in the way, with what in turn is in its way below; an input can be switched there. */
function obstacle(one: Obstacle, depth: number, key: number): Part {
  const head = one.name === undefined ? linked(one.text ?? '') : [
    ...linked(`${one.name} is ${one.value}`), h('span', { class: 'hint' }, since(one)),
    h('strong', {}, one.wanted === undefined ? '' : `, must be ${one.wanted}`),
    one.kind === 'input' ? input_button(one) : null,
    h('span', { class: 'hint' }, one.place === undefined ? '' : ` (${one.place})`, one.text === undefined ? '' : [': ', ...linked(one.text)])];
  if (!one.because?.length) return h('div', { class: 'obstacle', key }, head);
  return h('details', { class: 'obstacle', key, open: depth < kOpen }, h('summary', {}, head),
    one.because.map((each, i) => obstacle(each, depth + 1, i)));
}

function input_button(one: Obstacle): Part | null {
  const address = /\bI\d+\.[0-7]\b/.exec(one.name ?? '')?.[0], level = Number(one.wanted);
  if (address === undefined || !Number.isInteger(level)) return null;
  if (terminal_level(address) === level) return h('span', { class: 'hint' }, `, and is ${level} now`);
  return h('button', { class: 'why', title: `Switch the input ${address}`, onclick: (event: Event) => { event.preventDefault(); void switch_to(address, level); } }, `Switch to ${level}`);
}

function answer(one: TrailStep): Part {
  if (one.cause?.whyNot) return h('div', { class: 'obstacles' }, obstacle(one.cause.whyNot, 0, 0));
  return h('pre', {}, one.text.split('\n').map((line) => h('div', {}, linked(line))));
}

function step(one: TrailStep, i: number): Part {
  return h('li', { key: i },
    h('div', { class: 'question' }, one.question,
      h('button', { class: 'link', title: 'Go back to where this was asked', onclick: () => void go_to(one.at_ns) }, moment_text(one.at_ns))),
    answer(one));
}

/** What was done from outside, the newest first: with the program it is all that has led here. */
function what_led_here(): Part | null {
  see_done();
  const done = state.done;
  if (!done) return null;
  const shown = done.actions.slice(-rows_shown(done.actions.length)).reverse(), more = done.count - shown.length;
  return h('section', { class: 'led-here', 'aria-label': 'What led here' }, h('h3', {}, 'What led here'),
    done.count === 0 ? h('p', { class: 'hint' }, 'Nothing was done from outside up to this moment.') : null,
    h('table', { class: 'exchanges' }, h('tbody', {}, shown.map((one, i) => h('tr', { key: done.count - i },
      h('td', {}, h('button', { class: 'link', title: 'Go to this moment', onclick: () => void go_to(one.at_ns) }, moment_text(one.at_ns))),
      h('td', { class: 'frame' }, one.station ? `${one.station}: ` : '', one.text))))),
    more > 0 ? h('p', { class: 'hint' }, `and ${more} before these`) : null);
}

export function causes_pane(): Part {
  return h('div', { class: 'causes-pane' },
    h('div', { class: 'chart-tools' },
      h('button', { onclick: () => void ask_why(), title: 'What decided that it has come here (w)' }, 'Why here?'),
      h('button', { onclick: () => void move(line_of`rwhy`), title: 'Go to the instruction that decided it' }, 'Go to what decided'),
      h('button', { onclick: forget_trail, disabled: state.trail.length === 0 }, 'Clear')),
    h('form', { class: 'ask', onsubmit: (event: Event) => {
      event.preventDefault();
      const field = (event.target as HTMLElement).querySelector('input')!;
      const ask = { 'ask-who': ask_who, 'ask-why-not': ask_why_not, 'ask-effect': ask_effect }[(event as SubmitEvent).submitter?.id ?? ''] ?? ask_why;
      if (field.value.trim() !== '') void ask(field.value.trim());
    } },
    h('input', { 'aria-label': 'Address', placeholder: 'Q0.1, VW100, a symbol', list: 'symbols', autocomplete: 'off', spellcheck: 'false' }),
    h('button', { id: 'ask-why' }, 'Why?'), h('button', { id: 'ask-why-not', title: 'What keeps a bit as it is, and what would change it' }, 'What keeps it so?'), h('button', { id: 'ask-effect', title: 'What its last change made otherwise, and until when' }, 'What came of it?'), h('button', { id: 'ask-who' }, 'Who?')),
    state.trail.length === 0 ? h('p', { class: 'empty' }, 'Ask why an address has its value, or why the program has come here. Each answer leads on: click a moment to go there, an address to ask about it.')
      : h('ol', { class: 'trail' }, state.trail.map(step).reverse()),
    what_led_here());
}
