// The status chart, with switches of the inputs and lamps of the outputs above it.
import { h, kept, type Child, type Part } from '../dom';
import { kValues, line_of, value, word_of } from '../commands';
import { command, see_values } from '../session';
import { kFormats, query_of, text_in, type Format } from '../formats';
import { is_pulsing, kMostHertz, set_hertz, toggle_pulses } from '../pulses';
import { changed, notice, state, type ChartRow, type PointRow, type SwitchKind } from '../state';
import { level_of, switch_to, terminal_level } from '../switches';
import { remember, remembered } from '../kept';
import { chart_from, chart_text } from '../status_charts';
import type { Outline, Value } from '../protocol';
import { end_watch, open_menu } from './menu';
import { icon } from '../icons';

const kKept = 'chart';

export function load_chart(): void {
  try {
    const rows = JSON.parse(remembered(kKept) ?? '[]') as ChartRow[];
    state.chart = rows.filter((row) => typeof row?.address === 'string').map(({ address, format }) =>
      ({ address, format: kFormats.some((one) => one.format === format) ? format : 'signed', new_value: '' }));
  } catch {
    state.chart = [];
  }
}

function keep(): void {
  remember(kKept, JSON.stringify(state.chart.map(({ address, format }) => ({ address, format }))));
  see_values();
  changed();
}

export function add_to_chart(address: string): void {
  if (!state.chart.some((row) => row.address === address)) state.chart.push({ address, format: 'signed', new_value: '' });
  state.side = 'chart';
  state.pane = 'chart';
  keep();
}

function value_of(row: ChartRow): ReturnType<typeof state.values.get> {
  return state.values.get(query_of(row.address, row.format));
}

/** Micro/WIN's Write All: the new values that were typed take effect at the next scan. */
async function write_all(): Promise<void> {
  const rows = state.chart.filter((row) => row.new_value.trim() !== '');
  if (rows.length === 0) {
    notice('Type a new value first');
    return;
  }
  const wrong: string[] = [];
  for (const row of rows) wrong.push(...await write(row, 'set'));
  if (wrong.length > 0) notice(wrong[0]! + (wrong.length > 1 ? `; and ${wrong.length - 1} more ${wrong.length === 2 ? 'was' : 'were'} not written` : ''), 'error', 'set');
}

/** What is wrong with a value, of the cell that it was typed into; at the prompt it is of the whole word, `VB0=300`. */
function said_of_value(error: string, address: string, typed: string): string {
  if (/: write one address, =, and a value/.test(error)) return `'${typed}' is not ${kValues}`;
  const range = /: write a value that fits it: (.*)$/.exec(error)?.[1];
  return range ? `${typed} does not fit ${address}: ${range}` : error.replace(/^'.*' (?=cannot be forced: )/, `${address} `);
}

/** Returns what is wrong with it, which is said too. */
async function write(row: ChartRow, how: 'set' | 'force'): Promise<string[]> {
  const typed = row.new_value.trim();
  if (typed === '') {
    notice(`Type a new value for ${row.address} first`);
    return [];
  }
  const reply = await command(how === 'set' ? line_of`set ${row.address}=${value(typed)}` : line_of`force ${row.address}=${value(typed)}`);
  const wrong = reply.error === undefined ? [] : [said_of_value(reply.error, row.address, typed)];
  if (wrong.length > 0) notice(wrong[0]!, 'error', how);
  else if (row.new_value.trim() === typed) row.new_value = '';
  changed();
  return wrong;
}

async function toggle_force(row: ChartRow): Promise<void> {
  const now = value_of(row);
  if (now?.forced) await command(line_of`unforce ${row.address}`);
  else if (row.new_value.trim() !== '') await write(row, 'force');
  else if (now && now.error === undefined) await command(line_of`force ${row.address}=${now.number}`);
}

const kSparkWidth = 90, kSparkHeight = 18;

/** The last values over simulated time, as steps. */
function sparkline(name: string): Part {
  const samples = state.samples.get(name) ?? [];
  let path = '';
  if (samples.length > 1) {
    const from = samples[0]!.at_ns, length = samples[samples.length - 1]!.at_ns - from || 1;
    const numbers = samples.map((one) => one.number);
    const least = Math.min(...numbers), most = Math.max(...numbers);
    const x = (ns: number): string => ((ns - from) / length * kSparkWidth).toFixed(1);
    const y = (number: number): string => (kSparkHeight - 2 - (most === least ? 0.5 : (number - least) / (most - least)) * (kSparkHeight - 4)).toFixed(1);
    path = samples.map((one, i) => (i === 0 ? `M0,${y(one.number)}` : `H${x(one.at_ns)}V${y(one.number)}`)).join('');
  }
  return h('svg', { class: 'spark', viewBox: `0 0 ${kSparkWidth} ${kSparkHeight}`, 'aria-hidden': 'true' }, h('path', { d: path || 'M0,0' }));
}

function is_analog_input(value: Value | undefined): boolean {
  return value?.error === undefined && /^AIW\d+$/.test(value?.address ?? '');
}

const kMostAnalog = 32000;  // what a converter of the S7-200 gives at the end of its range

/** An analog input is turned; only the last of the values that come while one is being set is set. */
let turned: { address: string; number: number } | null = null;
let turning = false;
async function turn(address: string, number: number): Promise<void> {
  turned = { address, number };
  if (turning) return;
  turning = true;
  while (turned) {
    const next: { address: string; number: number } = turned;
    turned = null;
    await command(line_of`set ${next.address}=${next.number}`);
  }
  turning = false;
}

/** What is forced stays as it is, whatever comes in. */
function slider(address: string, number: number, forced: boolean): Part {
  return h('input', { type: 'range', class: 'slider', min: 0, max: kMostAnalog, step: 8, value: String(number), 'aria-label': `Analog input ${address}`,
    disabled: forced, title: forced ? `${address} is forced: release it with the lock to turn it` : '',
    oninput: (event: Event) => void turn(address, Number((event.target as HTMLInputElement).value)) });
}

function format_choice(row: ChartRow): Part {
  return h('select', { 'aria-label': `Format of ${row.address}`, onchange: (event: Event) => {
    row.format = (event.target as HTMLSelectElement).value as Format;
    keep();
  } }, kFormats.map(({ format, name }) => h('option', { value: format, selected: row.format === format }, name)));
}

function chart_row(row: ChartRow, i: number): Part {
  const value = value_of(row);
  const bit = value?.type === 'bit';
  const forced = value?.forced === true;
  const wrong = value?.error ?? (row.address.trim() !== '' && word_of(row.address) === undefined ? 'an address or a symbol, one a row' : undefined);
  return h('tr', { class: forced ? 'forced' : '', key: i },
    h('td', {}, h('input', { class: 'address', 'aria-label': 'Address', value: row.address, spellcheck: 'false', autocomplete: 'off', placeholder: 'Address or symbol',
      title: value?.symbol ? `${value.symbol} (${value.address})` : row.address,
      onchange: (event: Event) => { row.address = (event.target as HTMLInputElement).value.trim(); keep(); } })),
    h('td', { class: 'format' }, bit ? 'Bit' : format_choice(row)),
    h('td', { class: `current${bit && Number(value.number) === 1 ? ' on' : ''}`, title: wrong ?? '' },
      wrong !== undefined ? h('span', { class: 'wrong' }, 'not known here') : [forced ? icon('lock') : null, value ? text_in(value, row.format) : '']),
    h('td', {}, h('input', { class: 'new-value', 'aria-label': `New value of ${row.address}`, value: row.new_value, autocomplete: 'off', spellcheck: 'false',
      oninput: (event: Event) => { row.new_value = (event.target as HTMLInputElement).value; changed(); },
      onkeydown: (event: KeyboardEvent) => { if (event.key === 'Enter') void write(row, event.shiftKey ? 'force' : 'set'); } })),
    h('td', { class: 'tools' },
      h('button', { class: forced ? 'forced' : '', 'aria-pressed': String(forced), 'aria-label': `Force ${row.address}`, title: forced ? 'Unforce' : 'Force the new value, or the current one',
        onclick: () => void toggle_force(row) }, icon('lock')),
      h('button', { class: 'plain', 'aria-label': `Menu of ${row.address}`, title: 'Chart, who, why', onclick: (event: MouseEvent) => open_menu(event, row.address, null) }, '⋯'),
      h('button', { class: 'plain', 'aria-label': `Remove ${row.address}`, title: 'Remove', onclick: () => { state.chart = state.chart.filter((one) => one !== row); keep(); } }, icon('close'))),
    h('td', {}, is_analog_input(value) ? slider(value!.address, Number(value!.number), forced) : sparkline(query_of(row.address, row.format))));
}

/** Pasted rows of a status chart, from Micro/WIN or from here. */
function paste(event: ClipboardEvent): void {
  const text = event.clipboardData?.getData('text') ?? '';
  if (!/[\n\t]/.test(text.trim())) return;
  event.preventDefault();
  for (const row of chart_from(text)) if (!state.chart.some((one) => one.address === row.address)) state.chart.push(row);
  keep();
}

function copy_chart(): void {
  const rows = state.chart.map((row) => {
    const value = value_of(row);
    return { row, current: value ? text_in(value, row.format) : '', bit: value?.type === 'bit' };
  });
  navigator.clipboard?.writeText(chart_text(rows)).then(() => notice('The chart is copied: paste it into Micro/WIN or a table'), () => notice('This browser does not let the page copy', 'error'));
}

function add_row(): Part {
  return h('form', { class: 'add', onsubmit: (event: Event) => {
    event.preventDefault();
    const field = (event.target as HTMLElement).querySelector('input')!;
    if (field.value.trim() === '') return;
    add_to_chart(field.value.trim());
    field.value = '';
  } }, h('input', { id: 'add-address', placeholder: 'Add an address or symbol', title: 'Paste a status chart here for all its rows', onpaste: paste, 'aria-label': 'Add an address or symbol', list: 'symbols', autocomplete: 'off', spellcheck: 'false' }),
  h('button', { 'aria-label': 'Add' }, icon('plus')));
}

function symbol_of(address: string): string {
  return state.values.get(address)?.symbol ?? '';
}

const kKinds: Record<SwitchKind, string> = { switch: 'switch', push: 'push button', pulses: 'pulse train' };

function next_kind(row: PointRow): SwitchKind {
  const kinds = Object.keys(kKinds) as SwitchKind[];
  return kinds[(kinds.indexOf(row.kind) + 1) % kinds.length]!;
}

/** The pulse train that a right click has just made: its field has the focus, so that one can type how many pulses. */
let begun_pulses = '';

function focus_field(field: HTMLInputElement, address: string): void {
  if (begun_pulses !== address) return;
  begun_pulses = '';
  field.focus();
  field.select();
}

async function change_kind(row: PointRow, with_mouse: boolean): Promise<void> {
  if (is_pulsing(row.address)) await toggle_pulses(row);
  row.kind = next_kind(row);
  if (row.kind === 'pulses' && with_mouse) begun_pulses = row.address;
  changed();
}

/** After a click with the mouse Space is Run again, not the switch. */
function leave_to_keys(event?: MouseEvent): void {
  if (event && event.detail > 0) (event.currentTarget as HTMLElement).blur();
}

/** A switch stays where it is put, a push button returns when it is let go, a pulse train begins and ends with a click. */
function input_switch(row: PointRow): Part {
  const { address, kind } = row, pulsing = is_pulsing(address);
  const on = kind === 'pulses' ? pulsing : terminal_level(address) === 1;
  const forced = state.values.get(address)?.forced === true;
  const press = (level: number) => (event: { button?: number }) => { if (kind === 'push' && !event.button) void switch_to(address, level); };
  const name = `${symbol_of(address)} ${kKinds[kind]}; right click or Shift+F10: ${kKinds[next_kind(row)]}`.trim();
  return point(address,
    h('button', { class: `switch ${kind}${on ? ' on' : ''}${forced ? ' forced' : ''}`, role: 'switch', 'aria-checked': String(on),
      'aria-label': `Input ${address} ${symbol_of(address)}`.trim(), title: name,
      onclick: (event?: MouseEvent) => { leave_to_keys(event); if (kind === 'switch') void switch_to(address, on ? 0 : 1); else if (kind === 'pulses') void toggle_pulses(row); },
      onpointerdown: press(1), onpointerup: press(0), onpointerleave: () => { if (kind === 'push' && on) void switch_to(address, 0); },
      onkeydown: (event: KeyboardEvent) => {
        if (event.key === ' ' && !event.repeat) press(1)({});
        if (event.key !== 'ContextMenu' && !(event.key === 'F10' && event.shiftKey)) return;
        event.preventDefault();
        void change_kind(row, false);
      },
      onkeyup: (event: KeyboardEvent) => { if (event.key === ' ') press(0)({}); },
      oncontextmenu: (event: Event) => { event.preventDefault(); void change_kind(row, true); } },
    kind === 'pulses' ? h('svg', { viewBox: '0 0 34 14', 'aria-hidden': 'true' }, h('path', { d: 'M3 11H8V3H14V11H20V3H26V11H31' })) : h('i', {})),
    kind === 'pulses' ? hertz_field(row) : null);
}

function hertz_field(row: PointRow): Part {
  return h('input', { class: 'hertz', ref: (field: HTMLInputElement) => focus_field(field, row.address), value: `${row.hertz} Hz`, 'aria-label': `Pulses a second at ${row.address}`, title: `Pulses a second, up to ${kMostHertz}`, autocomplete: 'off', spellcheck: 'false',
    onchange: (event: Event) => {
      const field = event.target as HTMLInputElement;
      if (!set_hertz(row, field.value)) notice(`'${field.value}' is not a number of pulses a second from 0.01 to ${kMostHertz}`, 'error', 'hertz');
      else if (state.notice?.of === 'hertz') notice('');
      field.value = `${row.hertz} Hz`;
    } });
}

/** What the program names bit by bit, its symbols included. */
const named_points = kept((outline: Outline | null) => new Set([...outline?.points ?? [], ...(outline?.symbols ?? []).map((one) => one.address.toUpperCase())]));

function point(address: string, ...shown: Child[]): Part {
  return h('div', { class: named_points(state.outline).has(address) ? 'point' : 'point unnamed', key: address }, ...shown, point_name(address));
}

function point_name(address: string): Part {
  const symbol = symbol_of(address), is_named = named_points(state.outline).has(address);
  return h('button', { class: 'plain point-name', title: `${symbol} ${address}`.trim() + (is_named ? '' : ': the program does not name it'), onclick: (event: MouseEvent) => open_menu(event, address, null) },
    address, symbol === '' ? null : h('span', { class: 'point-symbol' }, symbol));
}

function output_lamp(address: string): Part {
  const on = level_of(address) === 1;
  const forced = state.values.get(address)?.forced === true;
  return point(address,
    h('span', { class: `bulb${on ? ' on' : ''}${forced ? ' forced' : ''}`, role: 'img', 'aria-label': `Output ${address} ${on ? 'on' : 'off'}${forced ? ', forced' : ''}`, title: symbol_of(address) }));
}

function points(name: string, all: string[], content: Child[]): Part {
  return h('div', { class: all.some(symbol_of) ? 'points with-symbols' : 'points', role: 'group', 'aria-label': name }, h('span', { class: 'points-name' }, name), ...content);
}

/** What a run stops at beside the breakpoints of the listing. */
function watches(): Part | null {
  if (state.watches.length === 0) return null;
  return h('div', { class: 'chart-tools watches', role: 'group', 'aria-label': 'Stops when it changes' }, h('span', { class: 'hint' }, 'Stops when it changes:'),
    state.watches.map((one) => {
      const name = `${one.station ? `${one.station} ` : ''}${one.address}`;
      return h('span', { class: 'watch', key: one.number }, name,
        h('button', { class: 'plain', 'aria-label': `No longer stop when ${name} changes`, title: 'No longer stop at it', onclick: () => void end_watch(one) }, icon('close')));
    }));
}

export function chart_pane(): Part {
  const forced = [...state.values.values()].some((value) => value.forced);
  return h('div', { class: 'chart-pane' },
    points('Inputs', state.inputs.map((row) => row.address), state.inputs.map(input_switch)),
    points('Outputs', state.outputs, state.outputs.map(output_lamp)),
    h('div', { class: 'chart-tools' },
      h('button', { onclick: () => void write_all(), title: 'Write all new values' }, 'Write all'),
      h('button', { onclick: () => void command(line_of`unforce all`), disabled: !forced, title: 'Release everything that is forced' }, 'Unforce all'),
      h('button', { onclick: copy_chart, disabled: state.chart.length === 0, title: 'Copy the chart as Micro/WIN has it' }, 'Copy')),
    watches(),
    h('table', { class: 'chart' },
      h('thead', {}, h('tr', {}, ['Address', 'Format', 'Current value', 'New value', '', 'Trend'].map((name) => h('th', {}, name)))),
      h('tbody', {}, state.chart.map(chart_row))),
    add_row());
}
