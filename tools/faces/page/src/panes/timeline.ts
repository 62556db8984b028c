// The timeline: what happened, as tracks. Wheel and keys zoom, dragging moves, the ruler measures, a click goes to that moment.
import { h, type Part } from '../dom';
import { draw, height_of, kRuler, rows_of, span_at, span_text, type Theme, type View } from '../timeline/draw';
import { ns_at, type Scale } from '../timeline/scale';
import { measure } from '../timeline/measure';
import * as search from '../timeline/search';
import { executed_text, go_to_other_execution, is_of_selected, select_line, selected_instruction } from '../timeline/executions';
import * as timeline from '../timeline/view';
import { go_to } from '../session';
import { compare_futures, difference_text, run_second, shown_spans } from '../futures';
import { icon } from '../icons';
import { changed, state } from '../state';
import { duration_text } from '../words';
import { is_of_numbers, type SpanTrack } from '../protocol';

const kLabels = 118, kLabelsOfSystem = 178;
const kPaper = { width: 718, height: 840 };

const is_narrow = (): boolean => innerWidth <= 760;

/** The width of the names of the tracks, in a system with their stations. */
function labels_width(): number {
  return state.hello?.stations.length && !is_narrow() ? kLabelsOfSystem : kLabels;
}

let canvas: HTMLCanvasElement | null = null;
let shown: View | null = null;
let drag: { x: number; from_ns: number; measures: boolean; moved: boolean } | null = null;
let pointer: { x: number; y: number } | null = null;
let told = '';

function theme_of(node: HTMLElement): Theme {
  const style = getComputedStyle(node);
  const names = ['pane', 'text', 'line', 'grid', 'ruler', 'received', 'sent', 'interrupts', 'scans', 'networks', 'routines', 'events', 'errors', 'value',
    'trouble', 'comment', 'wait', 'future', 'measure', 'now', 'cursor', 'on-colour'];
  return Object.fromEntries(names.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

function scale_of(width: number): Scale {
  return { ...timeline.window_of(), left: 0, right: width };
}

function paint(node: HTMLCanvasElement): void {
  canvas = node;
  const tracks = node.parentElement!.parentElement!;
  const rows = rows_of(shown_spans(), tracks.scrollTop);
  const width = Math.max(100, (state.printing ? kPaper.width : tracks.clientWidth) - labels_width());
  const height = state.printing ? Math.min(height_of(rows), kPaper.height) : tracks.clientHeight;
  const ratio = devicePixelRatio || 1;
  if (node.width !== Math.round(width * ratio) || node.height !== Math.round(height * ratio)) {
    node.width = Math.round(width * ratio);
    node.height = Math.round(height * ratio);
    node.style.width = `${width}px`;
    node.style.height = `${height}px`;
  }
  const context = node.getContext('2d', { alpha: false })!;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  shown = { scale: scale_of(width), rows, width, height, now_ns: timeline.shown_now(), newest_ns: timeline.runs_on() ? timeline.shown_now() : state.past?.newest_ns ?? 0,
    cursors: state.cursors, marks: state.marks, selected: state.selected_span, is_of_line: is_of_selected() };
  draw(context, shown, theme_of(node));
  tell();
}

/** What the pointer is over, which zooming and steps change too. */
function tell(): void {
  const under = pointer && !drag && shown ? span_at(shown, pointer.x, pointer.y) : null, text = under ? span_text(under.track, under.span) : '';
  if (text === told) return;
  told = text;
  changed();
}

const kFromPointer = 12;  // pixels

/** Beside the pointer, all that the line above the tracks has no room for. */
function place_tip(node: HTMLElement): void {
  const line = document.querySelector('.readout');
  node.hidden = told === '' || !pointer || !canvas || !line || line.scrollWidth <= line.clientWidth;
  if (node.hidden) return;
  const box = canvas!.getBoundingClientRect(), x = box.left + pointer!.x, y = box.top + pointer!.y, above = y - node.offsetHeight - kFromPointer;
  node.style.left = `${Math.max(4, Math.min(x + kFromPointer, innerWidth - node.offsetWidth - 4))}px`;
  node.style.top = `${above >= 4 ? above : y + kFromPointer}px`;
}

function tip(): Part {
  return h('div', { class: 'tip', 'aria-hidden': 'true', ref: place_tip }, told.split(' · ').map((line) => h('div', {}, line)));
}

function point(event: MouseEvent): { x: number; y: number } {
  const box = canvas!.getBoundingClientRect();
  return { x: event.clientX - box.left, y: event.clientY - box.top };
}

function on_wheel(event: WheelEvent): void {
  if (!shown) return;
  event.preventDefault();
  const { x } = point(event);
  if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) timeline.move_by((event.deltaX || event.deltaY) / 1000);
  else timeline.zoom_by(1.0018 ** event.deltaY, ns_at(shown.scale, x));
}

function on_down(event: PointerEvent): void {
  if (!shown || event.button !== 0) return;
  const { x, y } = point(event);
  drag = { x, from_ns: shown.scale.from_ns, measures: y < kRuler || event.shiftKey, moved: false };
  canvas!.setPointerCapture(event.pointerId);
}

function on_move(event: PointerEvent): void {
  if (!shown) return;
  const { x, y } = point(event);
  pointer = { x, y };
  if (!drag) return tell();
  if (Math.abs(x - drag.x) < 3 && !drag.moved) return;
  drag.moved = true;
  if (drag.measures) {
    state.cursors = { a_ns: ns_at(shown.scale, drag.x), b_ns: ns_at(shown.scale, x) };
    changed();
  } else {
    const per_pixel = (shown.scale.to_ns - shown.scale.from_ns) / shown.width;
    timeline.move_to(drag.from_ns - (x - drag.x) * per_pixel);
  }
}

function on_up(event: PointerEvent): void {
  const was = drag;
  drag = null;
  if (!was || was.moved || !shown) return;
  const { x, y } = point(event);
  const under = span_at(shown, x, y);
  state.selected_span = under?.span ?? null;
  void go_to(under && (under.span.count ?? 1) <= 1 ? under.span.at_ns : Math.max(0, ns_at(shown.scale, x)));
}

function measured(): string {
  const { a_ns, b_ns } = state.cursors;
  if (a_ns === null || b_ns === null) return '';
  const [from, to] = [Math.min(a_ns, b_ns), Math.max(a_ns, b_ns)];
  const counts = (state.spans?.tracks ?? []).filter((track) => !is_of_numbers(track)).map((track) => {
    const inside = track.spans.filter((one) => one.at_ns >= from && one.at_ns < to);
    const count = inside.reduce((sum, one) => sum + (one.count ?? 1), 0);
    return count > 0 ? `${track.name} ${count}` : '';
  }).filter((text) => text !== '');
  return [`B − A = ${b_ns < a_ns ? '−' : ''}${duration_text(to - from)}`, ...counts].join(' · ');
}

function name_of(track: SpanTrack): string {
  return track.station ? `${track.station} ${track.name}` : track.name;
}

/** On a phone only the first track of a PLC has its name. */
function labels(): Part[] {
  const rows = rows_of(shown_spans(), 0);
  return rows.map((row, i) => h('div', { class: `track-name${row.track.before ? ' before' : ''}`, key: i, style: { top: `${row.top}px`, height: `${row.height}px` }, title: row.track.unknown ? `What ${row.track.name} was in the first future is not known: put it on the timeline before What if?` : row.track.before ? `${row.track.name}: the first future` : name_of(row.track) },
    h('span', {}, row.track.unknown ? 'first future: not kept' : row.track.before ? 'first future' : is_narrow() && row.track.station === rows[i - 1]?.track.station ? row.track.name : name_of(row.track)),
    row.track.kind === 'value' && !row.track.before ? h('button', { class: 'plain', 'aria-label': `Remove ${row.track.name}`, onclick: () => timeline.unwatch(watched_as(row.track.name)) }, icon('close')) : null));
}

function watched_as(name: string): string {
  return state.watched.find((one) => one.toUpperCase() === name.toUpperCase()) ?? name;
}

function tool(name: string, title: string, does: () => void, ...content: (Part | string)[]): Part {
  return h('button', { id: `timeline-${name}`, title, 'aria-label': title, onclick: does }, ...content);
}

const kHeader = 34;  // pixels: the tools above the tracks, and the pane's border
let most_room = 0;

/** What all tracks need. It does not become less while they come and go with the part that is shown. */
export function room_of_tracks(): number {
  most_room = Math.max(most_room, kHeader + height_of(rows_of(shown_spans(), 0)));
  return most_room;
}

/** The line that is selected in the listing, with its executions. */
function line_here(): Part | null {
  const selected = selected_instruction();
  if (!selected) return null;
  const told = executed_text(selected);
  return h('span', { class: 'line-here', role: 'group', 'aria-label': 'Executions of the line' },
    tool('line-before', `Back to the last execution of line ${selected.line}`, () => void go_to_other_execution(-1), icon('back')),
    h('span', { title: 'Its network is marked on the timeline' }, `line ${selected.line}${told ? `: ${told}` : ''}`),
    tool('line-after', `To the next execution of line ${selected.line}`, () => void go_to_other_execution(1), icon('forward')),
    h('button', { class: 'plain', 'aria-label': 'Select no line', onclick: () => select_line(null) }, icon('close')));
}

export function timeline_pane(): Part {
  const { from_ns, to_ns } = timeline.window_of();
  return h('section', { id: 'pane-timeline', class: 'pane timeline', 'aria-label': 'Timeline', tabindex: '-1' },
    h('header', {}, h('h2', {}, 'Timeline'),
      tool('in', 'Zoom in (+)', () => timeline.zoom_by(0.5), icon('plus')), tool('out', 'Zoom out (-)', () => timeline.zoom_by(2), icon('minus')),
      tool('all', 'The whole past (0)', timeline.show_all, 'All'),
      tool('previous-error', 'Previous lost character or error (Shift+E)', () => void search.find_error(-1), icon('back')),
      h('span', { class: 'small' }, 'trouble'),
      tool('next-error', 'Next lost character or error (e)', () => void search.find_error(1), icon('forward')),
      tool('next-unanswered', 'Next unanswered request (u)', () => void search.find_unanswered(), 'unanswered'),
      h('form', { class: 'condition', onsubmit: (event: Event) => { event.preventDefault(); void search.find_condition((event.target as HTMLElement).querySelector('input')!.value); } },
        h('input', { id: 'condition', placeholder: 'next VW20 > 5', 'aria-label': 'Go to the next time that this comes to hold', title: 'A condition in STL terms (x)', autocomplete: 'off', spellcheck: 'false' })),
      tool('compare', 'Two futures: keep this one, change something, compare (c)', () => void compare_futures(), state.first_future ? 'End comparison' : 'What if?'),
      state.first_future ? tool('second', 'Run as far as the first future goes', () => void run_second(), icon('run')) : null,
      tool('a', 'Cursor A here ([)', () => timeline.set_cursor('a'), 'A'), tool('b', 'Cursor B here (])', () => timeline.set_cursor('b'), 'B'),
      tool('measure', 'Measure between the cursors, or what is in view: count, shortest, average, longest, histogram (Shift+M)', () => void measure(), 'Measure'),
      line_here(),
      h('span', { class: 'readout', role: 'status' }, state.computing ? 'computing …' : told || (state.first_future ? difference_text() : '') || measured() || `${duration_text(to_ns - from_ns)} in view`),
      state.cursors.a_ns !== null ? h('button', { class: 'plain', 'aria-label': 'Remove cursors', onclick: timeline.clear_cursors }, icon('close')) : null,
      state.spans?.left_out?.length ? h('span', { class: 'small', title: 'Zoom in to 10 s or less' }, `zoom in for ${state.spans.left_out.join(', ')}`) : null),
    h('div', { class: 'tracks', onscroll: changed },
      h('div', { class: 'track-names', style: { width: `${labels_width()}px`, height: `${height_of(rows_of(shown_spans(), 0))}px` } }, labels()),
      state.past?.newest_ns === 0 ? h('p', { class: 'empty nothing-yet' }, 'Nothing has run yet: Run, or a step, brings what happens here.') : null,
      h('div', { class: 'track-canvas' }, h('canvas', { id: 'timeline', tabindex: '0', role: 'img', 'aria-label': 'Timeline: plus and minus zoom, arrows move, e finds the next error', ref: paint,
        onwheel: on_wheel, onpointerdown: on_down, onpointermove: on_move, onpointerup: on_up, onpointercancel: () => { drag = null; },
        onpointerleave: () => { pointer = null; tell(); } }))), tip());
}
