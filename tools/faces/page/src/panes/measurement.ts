// What was measured between two cursors: a row for each track.
import { h, type Child } from '../dom';
import { show_found } from '../timeline/view';
import { show_dialog, state } from '../state';
import { duration_text, moment_text } from '../words';
import { histogram } from './histogram';
import { length_of, type Measured } from '../timeline/measure';
import type { Span } from '../protocol';

function number_text(value: number): string {
  return String(Number(value.toPrecision(6)));
}

function cell(one: Measured, span: Span | undefined): Child {
  if (!span) return h('td', { class: 'number' }, one.count === 0 ? '' : 'too many');
  const text = one.of_values ? number_text(span.value ?? 0) : duration_text(length_of(span));
  return h('td', { class: 'number' }, h('button', { class: 'link', title: `Go to ${moment_text(span.at_ns)}`,
    onclick: () => { show_dialog(null); void show_found(span); } }, text));
}

function row(one: Measured, i: number): Child {
  return h('tr', { key: i },
    h('th', { scope: 'row' }, one.name), h('td', { class: 'number' }, String(one.count), one.cut === 0 ? null : h('div', { class: 'hint', title: 'It begins or ends outside of this part' }, `and ${one.cut} cut off`)), cell(one, one.least),
    h('td', { class: 'number' }, one.count === 0 ? '' : one.of_values ? number_text(one.average) : duration_text(one.average)), cell(one, one.most),
    h('td', {}, histogram(one.all, one.of_values ? number_text : duration_text)));
}

export function measurement(): Child[] {
  const all = state.measurement;
  if (!all) return [];
  return [
    h('p', {}, `${duration_text(all.to_ns - all.from_ns)}, from ${moment_text(all.from_ns)} to ${moment_text(all.to_ns)}`),
    h('table', { class: 'measured' },
      h('thead', {}, h('tr', {}, ['', 'Count', 'Shortest, least', 'Average', 'Longest, most', 'Histogram'].map((name) => h('th', {}, name)))),
      h('tbody', {}, all.tracks.map(row))),
    all.tracks.some((one) => one.cut > 0) ? h('p', { class: 'hint' }, 'What is cut off begins or ends outside of this part, and counts for no length.') : null,
    all.tracks.some((one) => one.count > 0 && !one.least) ? h('p', { class: 'hint' }, 'Where there are too many, measure a shorter part for the shortest and the longest.') : null,
  ];
}
