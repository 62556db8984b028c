// The menu of an address: what one can ask and do about it.
import { h, type Part } from '../dom';
import { add_to_chart } from './chart';
import { ask_effect, ask_where_used, ask_who, ask_why, ask_why_not } from '../causes';
import { line_of, symbol_named } from '../commands';
import { command } from '../session';
import { watch_address } from '../timeline/view';
import { changed, notice, state, type Watch } from '../state';

function open_at(x: number, y: number, address: string, op: number | null): void {
  state.menu = { x, y, address, op };
  changed();
}

/** A button that was pressed with the keyboard says no place. */
export function open_menu(event: MouseEvent, address: string, op: number | null): void {
  if (event.detail === 0 && event.currentTarget instanceof Element) open_menu_at(event.currentTarget, address, op);
  else open_at(event.clientX, event.clientY, address, op);
}

/** Below an element that was chosen with the keyboard. */
export function open_menu_at(element: Element, address: string, op: number | null): void {
  const box = element.getBoundingClientRect();
  open_at(box.left, box.bottom, address, op);
}

export function close_menu(): void {
  if (!state.menu) return;
  state.menu = null;
  changed();
}

function watches_of(name: string): Watch[] {
  const address = (symbol_named(name)?.address ?? name).toUpperCase();
  return state.watches.filter((one) => one.address.toUpperCase() === address && one.station === (state.past?.station ?? ''));
}

async function toggle_watch(name: string): Promise<void> {
  const set = watches_of(name);
  if (set.length > 0) return set.forEach((one) => void end_watch(one));
  const reply = await command(line_of`watch ${name}`);
  if (reply.error === undefined) notice(`A run stops when ${name} changes`);
}

export async function end_watch({ number, address }: Watch): Promise<void> {
  const reply = await command(line_of`delete ${number}`);
  if (reply.error === undefined) notice(`A run no longer stops when ${address} changes`);
}

const kItems: { title: (address: string) => string; does: (address: string) => void; of_bits?: boolean }[] = [
  { title: () => 'Add to status chart', does: add_to_chart },
  { title: () => 'Show on the timeline', does: watch_address },
  { title: () => 'Why has it this value?', does: (address) => void ask_why(address) },
  { title: () => 'What keeps it so?', does: (address) => void ask_why_not(address), of_bits: true },
  { title: () => 'What came of its last change?', does: (address) => void ask_effect(address) },
  { title: () => 'Where is it used?', does: (address) => void ask_where_used(address) },
  { title: () => 'Who wrote it last?', does: (address) => void ask_who(address) },
  { title: (address) => (watches_of(address).length > 0 ? 'No longer stop when it changes' : 'Stop when it changes'), does: (address) => void toggle_watch(address) },
];

export function menu(): Part | null {
  const open = state.menu;
  if (!open) return null;
  return h('div', { class: 'menu-shade', onclick: close_menu, oncontextmenu: (event: Event) => { event.preventDefault(); close_menu(); } },
    h('div', { class: 'menu', role: 'menu', 'aria-label': open.address, ref: (node: HTMLElement) => keep_inside(node, open.x, open.y) },
      h('div', { class: 'menu-title' }, name_of(open.address)),
      kItems.filter((item) => !item.of_bits || is_bit(open.address)).map((item) => h('button', { role: 'menuitem', onclick: () => { close_menu(); item.does(open.address); } }, item.title(open.address)))));
}

function is_bit(name: string): boolean {
  const symbol = state.outline?.symbols.find((one) => one.name.toUpperCase() === name.toUpperCase());
  return /\.[0-7]$|^[TC]\d+$/i.test(symbol?.address ?? name);
}

function name_of(address: string): string {
  const symbol = state.outline?.symbols.find((one) => one.address.toUpperCase() === address.toUpperCase());
  return symbol ? `${symbol.name}  ${address}` : address;
}

function keep_inside(node: HTMLElement, x: number, y: number): void {
  node.style.left = `${Math.max(4, Math.min(x, innerWidth - node.offsetWidth - 4))}px`;
  node.style.top = `${Math.max(4, Math.min(y, innerHeight - node.offsetHeight - 4))}px`;
  if (!node.contains(document.activeElement)) node.querySelector<HTMLElement>('button')?.focus();
  node.onkeydown = (event) => {
    const all = Array.from(node.querySelectorAll<HTMLElement>('button'));
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    all[(all.indexOf(document.activeElement as HTMLElement) + step + all.length) % all.length]?.focus();
  };
}
