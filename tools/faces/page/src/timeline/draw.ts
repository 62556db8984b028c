// Draws tracks on a canvas. What is narrower than a pixel is added up in its column, and trouble is drawn last and at least two
// pixels wide, so that a lost character is seen at every zoom.
import { is_of_numbers, type SerialFormat, type Span, type SpanTrack, type Spans } from '../protocol';
import { without_turns } from '../dom';
import { first_after, ns_at, step_of, x_of, type Scale } from './scale';
import { clock_text, duration_text, kAsClock, kInSeconds, moment_text, with_times } from '../words';

export const kRuler = 22, kGap = 3;

const kHeights: Record<SpanTrack['kind'], number> = {
  characters: 22, frames: 18, interrupts: 15, queues: 15, scans: 13, networks: 13, routines: 13, events: 11, errors: 11, value: 18,
};
const kWave = 36;

export interface Theme {
  [name: string]: string;
}

export interface Row {
  track: SpanTrack;
  top: number;
  height: number;
}

function is_bit(track: SpanTrack): boolean {
  return track.spans.every((one) => (one.value === 0 || one.value === 1) && (one.least ?? 0) >= 0 && (one.most ?? 1) <= 1);
}

const is_of_errors = (track: SpanTrack): boolean => track.kind === 'errors';

/** The tracks below the ruler, errors first, which must not be missed; `scrolled` pixels of them are above it. */
export function rows_of(spans: Spans | null, scrolled: number): Row[] {
  let top = kRuler + kGap - scrolled;
  const tracks = spans?.tracks ?? [];
  return [...tracks.filter(is_of_errors), ...tracks.filter((one) => !is_of_errors(one))].map((track) => {
    const height = is_of_numbers(track) && !is_bit(track) ? kWave : kHeights[track.kind] ?? 16;
    const row = { track, top, height };
    top += height + kGap;
    return row;
  });
}

export function height_of(rows: Row[]): number {
  const last = rows[rows.length - 1];
  return last ? last.top + last.height + kGap : kRuler + kGap;
}

export interface View {
  scale: Scale;
  rows: Row[];
  width: number;
  height: number;
  now_ns: number;
  newest_ns: number;
  cursors: { a_ns: number | null; b_ns: number | null };
  marks: number[];
  selected: Span | null;
  /** Executions of the line that is selected in the listing. */
  is_of_line?: (track: SpanTrack, one: Span) => boolean;
}

function colour_of(track: SpanTrack, one: Span, theme: Theme): string {
  if (track.kind === 'frames') return one.text.startsWith('sent') ? theme['sent']! : theme['received']!;
  if (track.kind === 'characters') return track.name.endsWith('sent') ? theme['sent']! : theme['received']!;
  return theme[track.kind] ?? theme['scans']!;
}

/** A network without power flow stands back. */
function strength_of(track: SpanTrack, one: Span): number {
  return track.kind === 'networks' && one.value === 0 ? 0.35 : 1;
}

/** A frame says what it means rather than its direction, which its colour says. */
function label_of(track: SpanTrack, one: Span): string {
  if (track.kind !== 'frames') return one.text;
  const words = one.text.indexOf(': ');
  return words < 0 ? one.text.replace(/^(sent|received) /, '') : one.text.slice(words + 2);
}

const kFewest = 6;  // letters of a text below which it says nothing

function label(c: CanvasRenderingContext2D, text: string, x: number, y: number, width: number, colour: string): void {
  c.fillStyle = colour;
  const letters = Math.floor((width - 6) / 6.2);
  if (letters < Math.min(text.length, kFewest)) return;
  text = without_turns(text);
  c.fillText(text.length > letters ? (letters > 3 ? text.slice(0, letters - 1) + '…' : text.slice(0, letters)) : text, x + 3, y);
}

/** Where nothing is missing between several and the next ones, they go on to these. */
function end_of(one: Span, next: Span | undefined): number {
  const usual = 2 * (one.end_ns - one.at_ns) / Math.max(1, (one.count ?? 1) - 1);
  return (one.count ?? 1) > 1 && next && next.at_ns - one.end_ns < usual ? next.at_ns : one.end_ns;
}

function draw_spans(c: CanvasRenderingContext2D, view: View, row: Row, theme: Theme): void {
  const { scale } = view, { track, top, height } = row;
  const columns = new Float64Array(Math.ceil(view.width) + 1);
  const per_pixel = (scale.to_ns - scale.from_ns) / (scale.right - scale.left);
  const trouble: [number, number][] = [], differs: [number, number][] = [];
  const waited: Span[] = [], of_line: [number, number][] = [];
  for (let i = first_after(track.spans, scale.from_ns); i < track.spans.length; ++i) {
    const one = track.spans[i]!;
    if (one.at_ns >= scale.to_ns) break;
    const x = Math.max(scale.left, x_of(scale, one.at_ns)), end = Math.min(scale.right, x_of(scale, end_of(one, track.spans[i + 1])));
    const width = end - x, several = (one.count ?? 1) > 1;
    const wrong = one.error !== undefined || (one.errors ?? 0) > 0;
    if (wrong) trouble.push([x, Math.max(2, several ? 2 : width)]);
    if (view.is_of_line?.(track, one)) of_line.push([x, Math.max(4, width)]);
    if (one.differs) differs.push(difference_of(scale, one));
    if (one.occurred_ns !== undefined && !several && one.at_ns > one.occurred_ns) waited.push(one);
    if (one.end_ns === one.at_ns) {
      c.fillStyle = colour_of(track, one, theme);
      c.fillRect(x, top, 2, height);
    } else if (width < 1.5) {
      const column = Math.floor(x);
      columns[column] = (columns[column] ?? 0) + Math.max(1, several ? one.busy_ns ?? 0 : one.end_ns - one.at_ns);
    } else if (several) {
      const share = Math.min(1, (one.busy_ns ?? 0) / Math.max(1, one.end_ns - one.at_ns));
      c.fillStyle = colour_of(track, one, theme);
      c.globalAlpha = 0.55;
      c.fillRect(x, top + height * (1 - Math.max(0.15, share)), width, height * Math.max(0.15, share));
      c.globalAlpha = 1;
    } else {
      c.fillStyle = wrong ? theme['trouble']! : colour_of(track, one, theme);
      c.globalAlpha = strength_of(track, one);
      c.fillRect(x, top, Math.max(1, width - 0.5), height);
      c.globalAlpha = 1;
      if (width > 14 && !draw_levels(c, view, row, one, theme)) label(c, label_of(track, one), x, top + height / 2, width, theme[strength_of(track, one) < 1 ? 'text' : 'on-colour']!);
      if (one === view.selected) { c.strokeStyle = theme['text']!; c.lineWidth = 1.5; c.strokeRect(x, top, width, height); }
    }
  }
  c.fillStyle = track.spans[0] ? colour_of(track, track.spans[0], theme) : theme['scans']!;
  columns.forEach((busy, x) => {
    if (busy === 0) return;
    const share = Math.min(1, Math.max(0.2, busy / per_pixel));
    c.fillRect(x, top + height * (1 - share), 1, height * share);
  });
  for (const one of waited) draw_wait(c, view, row, one, theme);
  c.fillStyle = theme['trouble']!;
  for (const [x, width] of trouble) c.fillRect(Math.min(x, scale.right - 2), top, width <= 2 ? 2 : width, width <= 2 ? height : 3);
  draw_differences(c, row, differs, theme);
  c.fillStyle = theme['now']!;
  for (const [x, width] of of_line) c.fillRect(x, top - kGap + 1, width, kGap);
}

/** From where to how many pixels further an element differs, of what is in view. */
function difference_of(scale: Scale, one: Span): [number, number] {
  const x = Math.max(scale.left, x_of(scale, one.at_ns)), end = x_of(scale, Math.min(one.end_ns, one.differs_until_ns ?? Infinity));
  return [x, Math.max(2, Math.min(scale.right, end) - x)];
}

/** A line below what only one of two futures has. */
function draw_differences(c: CanvasRenderingContext2D, row: Row, parts: [number, number][], theme: Theme): void {
  c.fillStyle = theme['cursor']!;
  for (const [x, width] of parts) c.fillRect(x, row.top + row.height, width, kGap - 1);
}

/** The first of two futures stands back. */
function draw_band(c: CanvasRenderingContext2D, view: View, row: Row, theme: Theme): void {
  if (!row.track.before) return;
  c.fillStyle = theme['future']!;
  c.fillRect(view.scale.left, row.top - kGap, view.scale.right - view.scale.left, row.height + kGap);
}

const kLeastBit = 7;  // pixels from which on single bits are drawn

/** The level of the line in each bit: start, data from the lowest bit on, parity, stop. */
export function levels_of(format: SerialFormat, byte: number, error = ''): number[] {
  const data = Array.from({ length: format.data_bits }, (_, bit) => byte >> bit & 1);
  const odd = data.reduce((sum, bit) => sum ^ bit, 0);
  const parity = format.parity === 'none' ? [] : [odd ^ (format.parity === 'odd' ? 1 : 0) ^ (/parity/.test(error) ? 1 : 0)];
  return [0, ...data, ...parity, ...new Array<number>(format.stop_bits).fill(/framing/.test(error) ? 0 : 1)];
}

function draw_levels(c: CanvasRenderingContext2D, view: View, row: Row, one: Span, theme: Theme): boolean {
  const format = row.track.format;
  if (!format) return false;
  const levels = levels_of(format, parseInt(one.text, 16), one.error);
  const x = x_of(view.scale, one.at_ns), bit = (x_of(view.scale, one.end_ns) - x) / levels.length;
  if (bit < kLeastBit) return false;
  const y = (level: number): number => row.top + (level ? 4 : row.height - 4);
  c.strokeStyle = theme['on-colour']!;
  c.lineWidth = 1.5;
  c.beginPath();
  c.moveTo(x, y(1));
  levels.forEach((level, i) => { c.lineTo(x + i * bit, y(level)); c.lineTo(x + (i + 1) * bit, y(level)); });
  c.stroke();
  const middle = x + bit * levels.length / 2;
  c.fillStyle = colour_of(row.track, one, theme);
  c.fillRect(middle - 9, row.top + 5, 18, row.height - 10);
  c.fillStyle = theme['on-colour']!;
  c.fillText(one.text, middle - 7, row.top + row.height / 2);
  return true;
}

/** From the occurrence of an event to its service: what it waited, with an arrow where there is room. */
function draw_wait(c: CanvasRenderingContext2D, view: View, row: Row, one: Span, theme: Theme): void {
  const x = Math.max(view.scale.left, x_of(view.scale, one.occurred_ns!)), end = x_of(view.scale, one.at_ns);
  if (end - x < 2) return;
  const y = row.top - kGap / 2;  // above what the same interrupt may still be doing then, and the words in it
  c.strokeStyle = theme['wait']!;
  c.lineWidth = 1.5;
  c.beginPath();
  c.moveTo(x, y - 2); c.lineTo(x, y + 4);
  c.moveTo(x, y); c.lineTo(end, y);
  if (end - x > 8) { c.moveTo(end - 4, y - 3); c.lineTo(end, y); c.lineTo(end - 4, y + 3); }
  c.stroke();
}

function draw_value(c: CanvasRenderingContext2D, view: View, row: Row, theme: Theme): void {
  const { scale } = view, { track, top, height } = row;
  let least = Infinity, most = -Infinity;
  const first = first_after(track.spans, scale.from_ns);
  let last = first;
  for (; last < track.spans.length && track.spans[last]!.at_ns < scale.to_ns; ++last) {
    const one = track.spans[last]!;
    least = Math.min(least, one.least ?? one.value ?? 0);
    most = Math.max(most, one.most ?? one.value ?? 0);
  }
  const differs = track.spans.slice(first, last).filter((one) => one.differs).map((one) => difference_of(scale, one));
  draw_differences(c, row, differs, theme);
  const bit = is_bit(track);
  if (bit) { least = 0; most = 1; }
  const y = (value: number): number => top + height - 2 - (most === least ? 0.5 : (value - least) / (most - least)) * (height - 4);
  c.strokeStyle = theme['value']!;
  c.lineWidth = 1.4;
  c.beginPath();
  for (let i = first; i < last; ++i) {
    const one = track.spans[i]!;
    const x = Math.max(scale.left, x_of(scale, one.at_ns)), end = Math.min(scale.right, x_of(scale, one.end_ns));
    const value = one.value ?? 0;
    if (i === first) c.moveTo(x, y(value));
    if (one.least !== undefined && one.most !== undefined && one.least !== one.most) {
      c.lineTo(x, y(one.least)); c.lineTo(x, y(one.most));
      if (end - x > 1) { c.lineTo(end, y(one.most)); c.lineTo(end, y(one.least)); }
    }
    c.lineTo(x, y(value)); c.lineTo(end, y(value));
    if (!bit && end - x > 30) {
      c.fillStyle = theme['text']!;
      c.fillText(String(value), x + 3, y(value) > top + height / 2 ? y(value) - 7 : y(value) + 8);
    }
  }
  c.stroke();
}

/** What the marks of the ruler stand at. */
function marks_of(scale: Scale): { x: number; text: string }[] {
  const step = step_of(scale, 110);
  const first = Math.ceil(scale.from_ns / step);
  const count = Math.floor(scale.to_ns / step) - first + 1;
  return Array.from({ length: Math.max(0, count) }, (_, i) => {
    const ns = (first + i) * step;
    return { x: Math.round(x_of(scale, ns)) + 0.5, text: mark_text(ns, step, scale.to_ns) };
  });
}

function draw_grid(c: CanvasRenderingContext2D, view: View, theme: Theme): void {
  c.strokeStyle = theme['grid']!;
  c.lineWidth = 1;
  c.beginPath();
  for (const { x } of marks_of(view.scale)) { c.moveTo(x, kRuler); c.lineTo(x, view.height); }
  c.stroke();
}

const kFlag = 13, kPointer = 10;  // pixels: what a cursor or mark has in the ruler, and the present

/** What stands in the ruler beside its numbers, which make room for it: its line, and the pixels that it takes. */
export interface Flag {
  line: number;
  from: number;
  to: number;
}

function flags_of(view: View): Flag[] {
  const named = [view.cursors.a_ns, view.cursors.b_ns, ...view.marks].filter((ns): ns is number => ns !== null);
  const now = x_of(view.scale, view.now_ns);
  return [...named.map((ns) => x_of(view.scale, ns)).map((x) => ({ line: x, from: x, to: x + kFlag })), { line: now, from: now - kPointer / 2, to: now + kPointer / 2 }];
}

const kBeside = 3;  // pixels between a line and its number

/** Where the number of a grid line begins: right of the line, left of it if a cursor is in the way there; null where there is no room. */
export function place_of_number(x: number, width: number, flags: Flag[], from: number, to: number): number | null {
  const at_line = flags.filter((one) => one.from < x + kBeside && one.to > x - kBeside);
  const right = Math.max(x, ...at_line.filter((one) => one.line <= x).map((one) => one.to)) + kBeside;
  const left = Math.min(x, ...at_line.filter((one) => one.line > x).map((one) => one.from)) - kBeside - width;
  const is_free = (start: number, others: Flag[]): boolean => start >= from && start + width <= to
    && !others.some((one) => one.from < Math.max(x, start + width) && one.to > Math.min(x, start));
  if (x + kBeside + width > to) return null;
  if (is_free(right, flags.filter((one) => !at_line.includes(one) || one.line > x))) return right;
  return is_free(left, flags.filter((one) => !at_line.includes(one) || one.line < x)) ? left : null;
}

/** Over the tracks, which move below it. */
function draw_ruler(c: CanvasRenderingContext2D, view: View, theme: Theme): void {
  c.fillStyle = theme['ruler']!;
  c.fillRect(0, 0, view.width, kRuler);
  c.strokeStyle = theme['line']!;
  c.lineWidth = 1;
  c.fillStyle = theme['text']!;
  c.beginPath();
  const flags = flags_of(view);
  let from = view.scale.left;
  for (const { x, text } of marks_of(view.scale)) {
    c.moveTo(x, kRuler - 6); c.lineTo(x, kRuler);
    const width = c.measureText(text).width, start = place_of_number(x, width, flags, from, view.scale.right);
    if (start === null) continue;
    c.fillText(text, start, kRuler / 2);
    from = start + width + kBeside;
  }
  c.stroke();
}

const kMinute = 60e9;

/** In a part of minutes or hours, and late in a long run, as a clock that was started with it. */
function mark_text(ns: number, step: number, to_ns: number): string {
  const digits_of = (unit: number): number => Math.max(0, Math.round(Math.log10(unit) - Math.floor(Math.log10(step))));
  if (ns >= 0 && (step >= kMinute / 4 || to_ns >= kAsClock)) return clock_text(ns, step >= 10 * kMinute ? 'minutes' : digits_of(1e9));
  const [unit, name] = step >= 1e9 || to_ns >= kInSeconds ? [1e9, 's'] : step >= 1e3 ? [1e6, 'ms'] : [1e3, 'µs'];
  return `${(ns / unit).toFixed(digits_of(unit))} ${name}`;
}

function draw_line_at(c: CanvasRenderingContext2D, view: View, ns: number, colour: string, name: string): void {
  const x = Math.round(x_of(view.scale, ns)) + 0.5;
  if (x < view.scale.left || x > view.scale.right) return;
  c.strokeStyle = colour;
  c.lineWidth = 1.5;
  c.beginPath();
  c.moveTo(x, 0); c.lineTo(x, view.height);
  c.stroke();
  c.fillStyle = colour;
  if (name === '') {
    c.beginPath();
    c.moveTo(x - 5, 0); c.lineTo(x + 5, 0); c.lineTo(x, 8);
    c.fill();
  } else {
    c.fillRect(x, 1, 6 + 7 * name.length, 13);
    c.fillStyle = '#fff';
    c.fillText(name, x + 3, 8);
  }
}

export function draw(c: CanvasRenderingContext2D, view: View, theme: Theme): void {
  const { scale } = view;
  c.font = '11px system-ui, "Segoe UI", sans-serif';
  c.textBaseline = 'middle';
  c.fillStyle = theme['pane']!;
  c.fillRect(0, 0, view.width, view.height);
  draw_grid(c, view, theme);
  for (const row of view.rows) {
    if (row.top + row.height < kRuler || row.top > view.height) continue;
    draw_band(c, view, row, theme);
    if (is_of_numbers(row.track)) draw_value(c, view, row, theme);
    else draw_spans(c, view, row, theme);
  }
  draw_ruler(c, view, theme);
  const future = x_of(scale, view.newest_ns);
  if (future < scale.right) {
    c.fillStyle = theme['future']!;
    c.fillRect(Math.max(scale.left, future), kRuler, scale.right - Math.max(scale.left, future), view.height);
  }
  const { a_ns, b_ns } = view.cursors;
  if (a_ns !== null && b_ns !== null) {
    const x = x_of(scale, Math.min(a_ns, b_ns)), end = x_of(scale, Math.max(a_ns, b_ns));
    c.fillStyle = theme['measure']!;
    c.fillRect(Math.max(scale.left, x), kRuler, Math.min(scale.right, end) - Math.max(scale.left, x), view.height);
  }
  view.marks.forEach((ns, i) => draw_line_at(c, view, ns, theme['comment']!, String(i + 1)));
  draw_line_at(c, view, view.now_ns, theme['now']!, '');
  if (a_ns !== null) draw_line_at(c, view, a_ns, theme['cursor']!, 'A');
  if (b_ns !== null) draw_line_at(c, view, b_ns, theme['cursor']!, 'B');
}

/** What is under a point. */
export function span_at(view: View, x: number, y: number): { track: SpanTrack; span: Span } | null {
  const row = view.rows.find((one) => y >= one.top && y < one.top + one.height);
  if (!row || x < view.scale.left) return null;
  const ns = ns_at(view.scale, x), reach = ns_at(view.scale, x + 2) - ns;
  const span = row.track.spans[first_after(row.track.spans, ns - reach)];
  return span && span.at_ns <= ns + reach ? { track: row.track, span } : null;
}

export function span_text(track: SpanTrack, one: Span): string {
  const parts = [...(track.before ? ['first future'] : []), track.station ? `${track.station}: ${track.name}` : track.name];
  if ((one.count ?? 1) > 1) {
    parts.push(`${one.count} in ${duration_text(one.end_ns - one.at_ns)}, busy ${duration_text(one.busy_ns ?? 0)}`);
    if (one.least !== undefined) parts.push(`${one.least} … ${one.most}`);
    if (one.errors) parts.push(`${one.errors} with trouble`);
  } else {
    parts.push(one.text || String(one.value ?? ''), `at ${moment_text(one.at_ns)}`, duration_text(one.end_ns - one.at_ns));
    if (one.occurred_ns !== undefined && one.occurred_ns < one.at_ns) parts.push(`waited ${duration_text(one.at_ns - one.occurred_ns)}`);
    if (one.why) parts.push(one.why);
  }
  if (one.error !== undefined && !parts.some((part) => part.includes(one.error!))) parts.push(one.error);
  return with_times(parts.filter((part) => part !== '').join(' · '));
}
