// Program status: the listing with power flow and values at the moment where the session stands. Only the lines in view are made.
import { h, is_press, kept, type Child, type Part } from '../dom';
import { line_of } from '../commands';
import { command, fetch_chunk_of, go_to, see_lines, take_over } from '../session';
import { changed, notice, state } from '../state';
import { in_formats, operand_text } from '../formats';
import { duration_text, moment_text } from '../words';
import type { Execution, Line, Operand, Outline } from '../protocol';
import { executed_text } from '../timeline/executions';
import { open_menu, open_menu_at } from './menu';
import { ladder_view, show_in_ladder } from './ladder';
import { opener } from './opener';
import { can_open } from '../playground';

const kRow = 20;  // pixels, as page.css has it
const kMore = 8;         // rows above and below those in view

let scroller: HTMLElement | null = null;
let followed: number | null = null;
let followed_in: Outline | null = null;
let found_at = 0;

function line_at_top(): number {
  return scroller ? Math.floor(scroller.scrollTop / kRow) + 1 : 1;
}

function scroll_to(line: number): void {
  if (!scroller) return;
  scroller.scrollTop = Math.max(0, (line - 1) * kRow - scroller.clientHeight / 3);
  changed();
}

/** The line where the CPU stands comes into view when it has gone elsewhere. */
function follow(): void {
  const line = state.past?.line ?? null;
  if (!scroller || !state.follow || line === null || (line === followed && followed_in === state.outline)) return;
  followed = line;
  followed_in = state.outline;
  const top = (line - 1) * kRow;
  if (top < scroller.scrollTop || top > scroller.scrollTop + scroller.clientHeight - 2 * kRow) scroll_to(line);
}

export async function toggle_breakpoint(line: number | null): Promise<void> {
  if (line === null) return;
  const number = state.breakpoints.get(line);
  await command(number === undefined ? line_of`break ${line} always` : line_of`delete ${number}`);
}

function has_text(line: Line, wanted: string): boolean {
  const symbols = line.operands?.map((one) => `${one.symbol} ${one.address}`).join(' ') ?? '';
  return `${line.text} ${symbols}`.toLowerCase().includes(wanted);
}

/** The next line with that text, symbol or address: an instruction if there is one, for the tables of symbols have them all. Lines
 * that are not here yet are asked for by the way. */
async function next_with(wanted: string, lines: number): Promise<number> {
  const start = found_at === 0 ? line_at_top() : found_at + 1;
  let elsewhere = 0;
  for (let i = 0; i < lines; ++i) {
    const number = ((start - 1 + i) % lines) + 1;
    await fetch_chunk_of(number);
    const line = state.lines.get(number);
    if (!line || !has_text(line, wanted)) continue;
    if (line.op !== null) return number;
    if (elsewhere === 0) elsewhere = number;
  }
  return elsewhere;
}

async function find(text: string): Promise<void> {
  if (!state.outline || text === '') return;
  state.view = 'stl';
  const is_wanted = take_over(), found = await next_with(text.toLowerCase(), state.outline.lines);
  if (!is_wanted()) return;
  found_at = found;
  if (found_at === 0) {
    notice(`'${text}' is not in the program`);
    return;
  }
  state.selected_line = found_at;
  scroll_to(found_at);
}

/** Those of the selected line can be reached with the tab key. */
function operand(one: Operand, value: number | boolean | null | undefined, line: Line): Part {
  const on = value === true || value === 1;
  return h('span', {
    class: `operand${on ? ' on' : ''}`, role: 'button', tabindex: line.line === state.selected_line ? '0' : '-1',
    title: one.symbol ? `${one.symbol} (${one.address})` : one.address,
    onclick: (event: MouseEvent) => { event.stopPropagation(); open_menu(event, one.address, line.op); },
    onkeydown: (event: KeyboardEvent) => { if (is_press(event)) open_menu_at(event.target as Element, one.address, line.op); },
  }, one.text);
}

/** The text of a line with its addresses to click at, and its comment. */
function text_of(line: Line, execution: Execution | undefined): Child[] {
  const parts: Child[] = [];
  let rest = line.text;
  (line.operands ?? []).forEach((one, i) => {
    const place = rest.indexOf(one.text, parts.length === 0 ? (line.mnemonic?.length ?? 0) : 0);
    if (place < 0 || one.text === '') return;
    if (place > 0) parts.push(rest.slice(0, place));
    parts.push(one.address === '' ? one.text : operand(one, execution?.values[i], line));
    rest = rest.slice(place + one.text.length);
  });
  const comment = rest.indexOf('//');
  if (comment < 0) parts.push(rest);
  else parts.push(rest.slice(0, comment), h('span', { class: 'comment' }, rest.slice(comment)));
  return parts;
}

/** The inputs of a CALL with parameters are in its words only, `S0=1 VW0=16#0007`; its outputs are not known when it begins. */
function inputs_of_call(execution: Execution): Part[] {
  return [...in_formats(execution.text).matchAll(/(\S+)=(\S+)/g)].filter((one) => one[1] !== 'S0')
    .map((one) => h('span', { class: 'value' }, h('span', { class: 'name' }, `${one[1]!}=`), one[2]!));
}

function values_of(line: Line, execution: Execution): Part[] {
  if (line.mnemonic === 'CALL') return inputs_of_call(execution);
  return (line.operands ?? []).flatMap((one, i) => {
    const value = execution.values[i];
    if (one.address === '' || value === null || value === undefined) return [];
    return [h('span', { class: 'value' }, h('span', { class: 'name' }, `${one.symbol || one.text}=`), operand_text(one.address, value, execution.text))];
  });
}

function go_to_execution(line: Line | undefined): void {
  if (!line || line.op === null) return;
  const execution = state.executions.get(line.op), told = executed_text({ line: line.line, op: line.op });
  if (execution) void go_to(execution.at_ns);
  else if (told !== '') notice(`Line ${line.line}: ${told}`);
}

function row(number: number, headings: Set<number>): Part {
  const line = state.lines.get(number);
  const op = line?.op ?? null;
  const execution = op === null ? undefined : state.executions.get(op);
  const here = state.past?.line === number;
  const file = file_of(number), begins_file = file !== undefined && file.line === number;
  const stop = state.breakpoints.has(number);
  const flow = execution ? (execution.powerFlow ? 'flows' : 'dead') : 'never';
  const classes = ['row', here ? 'here' : '', headings.has(number) ? 'heading' : '', op !== null ? `op ${flow}` : '',
    state.selected_line === number ? 'selected' : '', begins_file ? 'file-begin' : ''].filter(Boolean).join(' ');
  const age = execution && state.past ? state.past.now_ns - execution.at_ns : 0;
  return h('div', { class: classes, key: number, id: `line-${number}`, style: { top: `${(number - 1) * kRow}px` }, role: 'row', 'aria-rowindex': number,
    'aria-selected': String(state.selected_line === number),
    onclick: () => { state.selected_line = number; changed(); },
    ondblclick: () => go_to_execution(line) },
  h('span', { class: `margin${stop ? ' stop' : ''}`, role: 'button', 'aria-label': `${stop ? 'Remove' : 'Set'} breakpoint in line ${number}`,
    title: op === null ? '' : 'Click: breakpoint', onclick: (event: Event) => { event.stopPropagation(); void toggle_breakpoint(number); } },
  stop ? '●' : '', here ? h('span', { class: 'arrow' }, '➤') : null),
  h('span', { class: 'number', role: 'rowheader' }, String(number - (file?.line ?? 1) + 1)),
  h('span', { class: 'flow', role: 'gridcell', 'aria-label': execution ? `power flow ${execution.powerFlow ? 1 : 0}` : undefined, title: execution ? `power flow ${execution.powerFlow ? 1 : 0}; executed ${duration_text(age)} ago, at ${moment_text(execution.at_ns)}` : '' },
    execution ? (execution.top ? '1' : '0') : ''),
  h('span', { class: 'text', role: 'gridcell' }, line ? text_of(line, execution) : '…'),
  begins_file ? h('span', { class: 'file-name', role: 'gridcell' }, file.name) : null,
  execution && line ? h('span', { class: 'values', role: 'gridcell' }, values_of(line, execution)) : null);
}

/** The file after the first that a line is in, a symbol table or a data block; its lines count from 1. */
function file_of(line: number): Outline['files'][number] | undefined {
  return state.outline?.files.slice(1).filter((one) => one.line <= line).pop();
}

function heading_lines(): Set<number> {
  const all = new Set<number>();
  for (const routine of state.outline?.routines ?? []) {
    all.add(routine.line);
    for (const network of routine.networks) if (network.number !== null) all.add(network.line);
  }
  return all;
}

function listing(): Part {
  const lines = state.outline?.lines ?? 0;
  const [first, last] = made_lines(lines);
  if (last >= first) queueMicrotask(() => see_lines(first, last));
  const headings = heading_lines(), selected = state.selected_line;
  const rows: Part[] = [];
  for (let number = first; number <= last; ++number) rows.push(row(number, headings));
  return h('div', { class: 'listing', role: 'grid', 'aria-label': 'Listing', 'aria-rowcount': lines, tabindex: '0',
    'aria-activedescendant': selected !== null && selected >= first && selected <= last ? `line-${selected}` : undefined, onscroll: changed, onkeydown: on_key,
    ref: (node: HTMLElement) => { const first_time = scroller !== node; scroller = node; if (first_time) requestAnimationFrame(changed); follow(); } },
  h('div', { class: 'rows', style: { height: `${lines * kRow}px` } }, rows));
}

/** Which lines are made, and printed: those in view and a few around them. */
function made_lines(lines: number): [number, number] {
  const height = scroller?.clientHeight ?? 600;
  return [Math.max(1, line_at_top() - kMore), Math.min(lines, line_at_top() + Math.ceil(height / kRow) + kMore)];
}

function printed_part(): string {
  const lines = state.outline?.lines ?? 0, [first, last] = made_lines(lines);
  return state.view === 'ladder' && state.has_ladder ? 'the networks in view' : first > 1 || last < lines ? `lines ${first} to ${last} of ${lines}` : '';
}

function on_key(event: KeyboardEvent): void {
  if (event.key === 'Enter' && event.target === event.currentTarget) go_to_execution(state.lines.get(state.selected_line ?? 0));
  const step = { ArrowUp: -1, ArrowDown: 1, PageUp: -20, PageDown: 20 }[event.key];
  if (step === undefined || !state.outline) return;
  event.preventDefault();
  event.stopPropagation();
  const line = Math.min(state.outline.lines, Math.max(1, (state.selected_line ?? state.past?.line ?? 1) + step));
  state.selected_line = line;
  const top = (line - 1) * kRow;
  if (scroller && (top < scroller.scrollTop || top > scroller.scrollTop + scroller.clientHeight - kRow)) scroll_to(line);
  changed();
}

/** A line that an answer names. */
export function show_line(line: number): void {
  state.selected_line = line;
  state.pane = 'program';
  if (state.view === 'ladder') show_in_ladder(line);
  else scroll_to(line);
  changed();
}

/** Further files have no ladder. */
function show_place(place: string): void {
  const file = /^file (\d+)$/.exec(place);
  if (file) state.view = 'stl';
  if (file) scroll_to(Number(file[1]));
  else (state.view === 'ladder' ? show_in_ladder : scroll_to)(Number(place));
}

/** Blocks, networks and further files to jump to. */
const block_choice = kept((outline: Outline | null): Part =>
  h('select', { class: 'navigator', 'aria-label': 'Go to block or network', value: '', onchange: (event: Event) => {
    const field = event.target as HTMLSelectElement;
    if (field.value !== '') show_place(field.value);
    field.value = '';
  } }, h('option', { value: '' }, 'Block, network …'),
  (outline?.routines ?? []).map((routine) => h('optgroup', { label: routine.name }, [
    h('option', { value: String(Math.min(routine.line, routine.networks[0]?.line ?? routine.line)) }, routine.name),
    ...routine.networks.filter((one) => one.number !== null).map((one) =>
      h('option', { value: String(one.line) }, `Network ${one.number}${one.title ? `  ${one.title}` : ''}`))])),
  (outline?.files.length ?? 0) < 2 ? null : h('optgroup', { label: 'Further files' }, outline!.files.slice(1).map((one) => h('option', { value: `file ${one.line}` }, one.name)))));

function view_button(view: 'stl' | 'ladder', name: string): Part {
  return h('button', { 'aria-pressed': String(state.view === view), onclick: () => { state.view = view; changed(); } }, name);
}

/** A program is typed or chosen: there is nothing else to see. */
export function is_opener_shown(): boolean {
  return can_open() && (state.opening || (state.outline === null && !state.report));
}

function content(): Part {
  if (is_opener_shown()) return opener();
  if (state.outline === null) return h('p', { class: 'empty' }, 'Waiting for the program …');
  return state.view === 'ladder' && state.has_ladder ? ladder_view() : listing();
}

export function program_pane(): Part {
  return h('section', { id: 'pane-program', class: 'pane program', 'aria-label': 'Program status', tabindex: '-1' },
    h('header', {}, h('h2', {}, 'Program status'), state.printing ? h('span', { class: 'small' }, printed_part()) : null, block_choice(state.outline),
      h('form', { class: 'find', onsubmit: (event: Event) => { event.preventDefault(); void find((event.target as HTMLElement).querySelector('input')!.value); } },
        h('input', { id: 'find', type: 'search', placeholder: 'Find (/)', 'aria-label': 'Find in the program', oninput: () => { found_at = 0; } })),
      h('button', { class: 'toggle', 'aria-pressed': String(state.follow), title: 'Show where the CPU stands (f)', onclick: () => { state.follow = !state.follow; followed = null; changed(); } }, 'Follow'),
      can_open() && !state.opening && state.outline ? h('button', { id: 'open-program', title: 'Another program, or this one changed', onclick: () => { state.opening = true; changed(); } }, 'Edit') : null,
      !state.has_ladder ? null : h('div', { class: 'choice', role: 'group', 'aria-label': 'View' }, view_button('stl', 'STL'), view_button('ladder', 'LAD'))),
    content());
}
