// The ladder: networks as the session draws them, on a grid of characters, with power flow at the moment where it stands. Only the
// networks in view are asked for and made.
import { line_of } from '../commands';
import { h, is_press, type Child, type Part } from '../dom';
import { also_seen, fetch_chunk_of, query, Seen } from '../session';
import { in_formats } from '../formats';
import { changed, state } from '../state';
import type { LadderElement, LadderNetwork, Reply } from '../protocol';
import { open_menu, open_menu_at } from './menu';

const kCellWidth = 8, kCellHeight = 18;  // pixels of a character and a line
const kRail = 40;                        // from the left edge to the power rail
const kUnknownHeight = 140;

interface Place {
  line: number;
  name: string;
  first: number;
  end: number;
}

let scroller: HTMLElement | null = null;
let in_view: Place[] = [];
let followed: number | null = null;
let wrong = '';

function places(): Place[] {
  return (state.outline?.routines ?? []).flatMap((routine) =>
    routine.networks.filter((one) => one.end > one.first).map((one) => ({
      line: one.line, first: one.first, end: one.end,
      name: one.number === null ? routine.name : `${routine.name}, network ${one.number}${one.title ? `: ${one.title}` : ''}`,
    })));
}

const kMostParts = 20;

/** A network is several drawings where a label divides it. */
async function fetch_network(place: Place): Promise<void> {
  const parts: LadderNetwork[] = [];
  await fetch_chunk_of(place.line);
  for (let line: number | undefined = place.line; line !== undefined && parts.length < kMostParts;) {
    const reply: Reply<LadderNetwork> = await query<LadderNetwork>(line_of`ladder ${line}`);
    if (!reply.json) {
      wrong = reply.error ?? '';
      return;
    }
    if (reply.json.first_op >= place.end) break;  // the head of a routine stands alone: this is what follows it
    parts.push(reply.json);
    const next = reply.json.first_op + reply.json.ops;
    line = next < place.end ? [...state.lines.values()].find((one) => one.op === next)?.line : undefined;
  }
  wrong = '';
  state.ladder.set(place.line, parts);
}

const seen = new Seen(async () => {
  if (state.view !== 'ladder' || !state.has_ladder) return;
  for (const place of [...in_view]) await fetch_network(place);
});
also_seen(seen);

/** Of networks that have been in view, in pixels. */
const heights = new Map<number, number>();

function height_of(place: Place): number {
  return (state.ladder.has(place.line) ? heights.get(place.line) : undefined) ?? kUnknownHeight;
}

function measure(place: Place): (node: HTMLElement) => void {
  return (node) => {
    if (!state.ladder.has(place.line) || heights.get(place.line) === node.offsetHeight) return;
    heights.set(place.line, node.offsetHeight);
    changed();
  };
}

const middle_x = (column: number): number => kRail + column * kCellWidth;
const middle_y = (row: number): number => row * kCellHeight + kCellHeight / 2;

function cell_text(text: string, column: number, row: number, style: string): Part {
  return h('text', { x: middle_x(column) - kCellWidth / 2, y: middle_y(row) + 4, class: style, textLength: [...text].length * kCellWidth, lengthAdjust: 'spacingAndGlyphs' }, text);
}

/** Those of the chosen network can be reached with the tab key. */
function address_text(text: string, column: number, row: number, op: number | null, is_chosen: boolean): Child {
  if (text === '') return null;
  const address = text.includes(':') ? text.slice(text.lastIndexOf(':') + 1) : text;
  const part = cell_text(text, column, row, 'address');
  Object.assign(part.attributes, { role: 'button', tabindex: is_chosen ? '0' : '-1', onclick: (event: MouseEvent) => open_menu(event, address, op),
    onkeydown: (event: KeyboardEvent) => { if (is_press(event)) open_menu_at(event.currentTarget as Element, address, op); } });
  return part;
}

/** Two bars, and what stands between them: nothing, a slash, or letters. */
function contact_path(one: LadderElement): string {
  const narrow = one.symbol === '' || one.symbol === '/';
  const left = middle_x(one.column), right = middle_x(one.column + one.width - 1), y = middle_y(one.row), inset = narrow ? kCellWidth : 0;
  const bars = `M${left + inset} ${y - 8}V${y + 8}M${right - inset} ${y - 8}V${y + 8}`;
  const wires = narrow ? `M${left} ${y}H${left + inset}M${right - inset} ${y}H${right}` : '';
  return bars + wires + (one.symbol === '/' ? `M${left + inset + 2} ${y + 8}L${right - inset - 2} ${y - 8}` : '');
}

function coil_path(one: LadderElement): string {
  const left = middle_x(one.column), right = middle_x(one.column + one.width - 1), y = middle_y(one.row);
  return `M${left + 6} ${y - 8}Q${left - 6} ${y} ${left + 6} ${y + 8}M${right - 6} ${y - 8}Q${right + 6} ${y} ${right - 6} ${y + 8}`;
}

function symbol_text(one: LadderElement): Child {
  if (one.symbol === '' || (one.kind === 'contact' && one.symbol === '/')) return null;
  return cell_text(one.symbol, one.column + (one.width - [...one.symbol].length) / 2, one.row, '');
}

function box(one: LadderElement, is_chosen: boolean): Child[] {
  const left = middle_x(one.column), right = middle_x(one.column + one.width - 1);
  const top = one.row * kCellHeight + 1, bottom = middle_y(one.row + one.height - 1);
  return [h('rect', { class: 'box', x: left, y: top, width: right - left, height: bottom - top }),
    ...one.pins.flatMap((pin) => [
      pin.name === '' ? null : cell_text(pin.name, pin.name_column, pin.row, ''),
      address_text(pin.operand, pin.operand_column, pin.row, one.op, is_chosen)])];
}

/** What the element's power flow is: from where it takes it, and where it lets it through. */
function element(one: LadderElement, power: boolean[], is_chosen: boolean): Part {
  const on = one.to === null ? power[one.from] === true : power[one.to] === true;
  const value = one.value ?? '';
  const here = one.op !== null && one.op === state.past?.op;
  return h('g', { class: `${on ? 'on' : ''}${here ? ' here' : ''}`, onclick: () => { state.selected_line = one.line; changed(); } },
    h('title', {}, `line ${one.line}${value ? `: ${in_formats(value)}` : ''}`),
    filling(one, power), one.kind === 'box' ? box(one, is_chosen) : h('path', { class: 'wire', d: one.kind === 'contact' ? contact_path(one) : coil_path(one) }),
    symbol_text(one), one.operands.map((text) => address_text(text.text, text.column, text.row, one.op, is_chosen)));
}

/** A contact that is closed is filled, as in Micro/WIN. */
function filling(one: LadderElement, power: boolean[]): Child {
  if (one.kind !== 'contact' || !is_closed(one, power)) return null;
  const narrow = one.symbol === '' || one.symbol === '/', inset = narrow ? kCellWidth : 0;
  const left = middle_x(one.column) + inset + 2, right = middle_x(one.column + one.width - 1) - inset - 2;
  return h('rect', { class: 'closed', x: left, y: middle_y(one.row) - 6, width: Math.max(1, right - left), height: 12 });
}

/** By the value of its bit; of another contact only what its power flow says. */
function is_closed(one: LadderElement, power: boolean[]): boolean {
  const bit = /=([01])$/.exec(one.value ?? '');
  if (!bit || /[<>=]/.test(one.symbol)) return power[one.from] === true && one.to !== null && power[one.to] === true;
  return (bit[1] === '1') !== one.symbol.startsWith('/');
}

/** What boxes and comparisons found or left, and the symbols of the addresses, below the drawing. */
function values(network: LadderNetwork): Child {
  const all = (network.elements ?? []).filter((one) => one.kind === 'box' || /[<>=]/.test(one.symbol)).map((one) => one.value ?? '');
  const said = [...new Set(all.filter((text) => text !== ''))];
  const symbols = network.notes.filter((note) => note.symbol !== '');
  if (said.length + symbols.length === 0) return null;
  return h('div', { class: 'ladder-values' }, said.map((text) => h('span', {}, in_formats(text))),
    symbols.map((note) => h('span', { class: 'hint', title: note.comment }, `${note.text} ${note.symbol}`)));
}

function drawing(network: LadderNetwork, is_chosen: boolean): Part {
  const grid = network.grid!, power = network.power ?? [];
  const width = kRail + (grid.columns + 2) * kCellWidth, height = grid.rows * kCellHeight + 10;
  return h('svg', { class: 'ladder', width, height, viewBox: `0 0 ${width} ${height}`, role: 'group', 'aria-label': `Network ${network.network} as ladder` },
    h('path', { class: `rail${power[0] ? ' on' : ''}`, d: `M${kRail} 0V${grid.rows * kCellHeight}` }),
    grid.wires.map((wire) => h('path', { class: `wire${power[wire.point] ? ' on' : ''}`,
      d: `M${middle_x(wire.column)} ${middle_y(wire.row)}L${middle_x(wire.to_column)} ${middle_y(wire.to_row)}` })),
    (network.elements ?? []).map((one) => element(one, power, is_chosen)),
    grid.connectors.map((one) => cell_text(one.text, one.column, one.row, 'address')));
}

function stl_of(network: LadderNetwork): Part {
  const lines = [...state.lines.values()].filter((line) => line.op !== null && line.op >= network.first_op && line.op < network.first_op + network.ops);
  return h('div', { class: 'ladder-stl' }, network.why_not ? h('div', { class: 'hint' }, `No form in ladder: ${network.why_not}`) : null,
    h('pre', {}, lines.sort((a, b) => a.line - b.line).map((line) => `${line.text}\n`)));
}

function network_part(one: LadderNetwork, is_chosen: boolean): Child[] {
  return [one.comments.map((comment) => h('div', { class: 'comment', title: comment }, comment)),
    one.head !== null ? h('div', { class: 'ladder-stl' }, one.head) : one.grid ? [drawing(one, is_chosen), values(one)] : stl_of(one)];
}

function follow(all: { place: Place; top: number; height: number }[]): void {
  const op = state.past?.op ?? null;
  if (!scroller || !state.follow || op === null || op === followed) return;
  followed = op;
  wanted_line = null;
  const found = all.find(({ place }) => op >= place.first && op < place.end);
  const seen_height = Math.min(found?.height ?? 0, scroller.clientHeight - 20);
  if (found && (found.top < scroller.scrollTop || found.top + seen_height > scroller.scrollTop + scroller.clientHeight)) scroller.scrollTop = Math.max(0, found.top - 20);
}

/** The line whose network stays at the top until one scrolls: how high those above it are is known only when they are drawn, and as they
    come to be known the browser scrolls as well. */
let wanted_line: number | null = null;

/** Brings the network of that line into view, or the first one after it. */
export function show_in_ladder(line: number): void {
  wanted_line = line;
  followed = state.past?.op ?? null;  // where the CPU stands is left until it stands elsewhere
  changed();
}

function keep_in_view(all: { place: Place; top: number }[]): void {
  const wanted = wanted_line === null ? undefined : all.find(({ place }) => place.line >= wanted_line!);
  if (!scroller || !wanted) return;
  scroller.scrollTop = wanted.top;
}

/** Wheel, scroll bar, finger or a key: from then on one scrolls. */
function take_hold(): void {
  wanted_line = null;
}

/** The network that was chosen with the keyboard or a click: that of the selected line, else the one where the CPU stands. */
function chosen_of(all: Place[]): number {
  const line = state.selected_line ?? state.past?.line ?? 0;
  return Math.max(0, all.findIndex((place, i) => line >= place.line && line < (all[i + 1]?.line ?? Infinity)));
}

function on_key(event: KeyboardEvent): void {
  const step = { ArrowUp: -1, ArrowDown: 1 }[event.key], all = places();
  take_hold();
  if (step === undefined) return;
  event.preventDefault();
  const next = all[chosen_of(all) + step];
  if (!next) return;
  state.selected_line = next.line;
  const shown = document.querySelector(`#network-${next.line}`);
  if (shown) shown.scrollIntoView({ block: 'nearest' });
  else show_in_ladder(next.line);
  changed();
}

/** Networks of two programs may begin in the same lines. */
function words_of(all: Place[]): string {
  return all.map((one) => `${one.line} ${one.first} ${one.end} ${one.name}`).join('\n');
}

export function ladder_view(): Part {
  let top = 0;
  const networks = places(), chosen = networks[chosen_of(networks)]?.line;
  const all = networks.map((place) => {
    const placed = { place, top, height: height_of(place) };
    top += placed.height;
    return placed;
  });
  const from = scroller?.scrollTop ?? 0, to = from + (scroller?.clientHeight ?? 600);
  const shown = all.filter((one) => one.top + one.height > from - 100 && one.top < to + 100);
  if (words_of(shown.map((one) => one.place)) !== words_of(in_view)) {
    in_view = shown.map((one) => one.place);
    seen.refresh();
  }
  return h('div', { class: 'listing ladders', tabindex: '0', role: 'group', 'aria-label': 'Ladder: arrows choose a network, Tab reaches its addresses', onscroll: changed, onwheel: take_hold, onpointerdown: take_hold, ontouchmove: take_hold, onkeydown: on_key,
    ref: (node: HTMLElement) => { const first = scroller !== node; scroller = node; if (first) requestAnimationFrame(changed); follow(all); keep_in_view(all); } },
  h('div', { class: 'rows', style: { height: `${top}px` } }, shown.map(({ place, top: y }) =>
    h('section', { id: `network-${place.line}`, 'aria-label': place.name, class: `ladder-network${place.line === chosen ? ' chosen' : ''}${state.past?.op !== null && state.past && state.past.op! >= place.first && state.past.op! < place.end ? ' here' : ''}`, key: place.line, ref: measure(place), style: { top: `${y}px` } },
      h('h3', {}, place.name), (state.ladder.get(place.line) ?? []).map((one) => network_part(one, place.line === chosen)),
      state.ladder.has(place.line) ? null : h('div', { class: 'hint' }, wrong || '…')))));
}
