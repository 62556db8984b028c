// The trail: what was asked, what the answer is, and the way on from there.
import { h, type Child, type Part } from '../dom';
import { ask_who, ask_why, forget_trail } from '../causes';
import { go_to, move } from '../session';
import { state, type TrailStep } from '../state';
import { moment_text } from '../words';

const kAddress = /\b(?:(?:SM|[IQVMSL])\d+\.[0-7]|(?:SM|[IQVMSL])[BWD]\d+|A[IQ]W\d+|[TC]\d{1,3}|HC\d|AC[0-3])\b/g;
const kMoment = /\b(\d+\.\d{6}) ms\b/g;

/** A line of an answer: its moments lead there, its addresses ask on. */
export function linked(line: string): Child[] {
  const parts: Child[] = [];
  let end = 0;
  const marks = [...line.matchAll(kAddress), ...line.matchAll(kMoment)].sort((a, b) => a.index! - b.index!);
  for (const mark of marks) {
    if (mark.index! < end) continue;
    parts.push(line.slice(end, mark.index));
    const text = mark[0];
    const ns = Math.round(Number(mark[1]) * 1e6);
    parts.push(mark[1] !== undefined
      ? h('button', { class: 'link', title: 'Go to this moment', onclick: () => void go_to(ns) }, text)
      : h('button', { class: 'link', title: `Why ${text}?`, onclick: () => void ask_why(text) }, text));
    end = mark.index! + text.length;
  }
  parts.push(line.slice(end));
  return parts;
}

function step(one: TrailStep, i: number): Part {
  return h('li', { key: i },
    h('div', { class: 'question' }, one.question,
      h('button', { class: 'link', title: 'Go back to where this was asked', onclick: () => void go_to(one.at_ns) }, moment_text(one.at_ns))),
    h('pre', {}, one.text.split('\n').map((line) => h('div', {}, linked(line)))));
}

export function causes_pane(): Part {
  return h('div', { class: 'causes-pane' },
    h('div', { class: 'chart-tools' },
      h('button', { onclick: () => void ask_why(), title: 'What decided that it has come here (w)' }, 'Why here?'),
      h('button', { onclick: () => void move('rwhy'), title: 'Go to the instruction that decided it' }, 'Go to what decided'),
      h('button', { onclick: forget_trail, disabled: state.trail.length === 0 }, 'Clear')),
    h('form', { class: 'ask', onsubmit: (event: Event) => {
      event.preventDefault();
      const field = (event.target as HTMLElement).querySelector('input')!;
      const who = (event as SubmitEvent).submitter?.id === 'ask-who';
      if (field.value.trim() !== '') void (who ? ask_who(field.value.trim()) : ask_why(field.value.trim()));
    } },
    h('input', { 'aria-label': 'Address', placeholder: 'Q0.1, VW100, a symbol', list: 'symbols', autocomplete: 'off', spellcheck: 'false' }),
    h('button', { id: 'ask-why' }, 'Why?'), h('button', { id: 'ask-who' }, 'Who?')),
    state.trail.length === 0 ? h('p', { class: 'empty' }, 'Ask why an address has its value, or why the program has come here. Each answer leads on: click a moment to go there, an address to ask about it.')
      : h('ol', { class: 'trail' }, state.trail.map(step).reverse()));
}
