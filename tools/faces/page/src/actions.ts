// Everything that one can do, once: buttons, keys and the help read this table.
import { changed, notice, show_dialog, show_pane, state } from './state';
import { line_of, type Command } from './commands';
import { command, go_to, go_to_named, move, pause } from './session';
import { run } from './running';
import { ask_why } from './causes';
import { address_of } from './files';
import { compare_futures } from './futures';
import { next_mark, toggle_mark } from './timeline/marks';
import { can_open } from './playground';
import { remember, remembered } from './kept';
import { keys_to, kPanes, type PaneName } from './pane_table';
import { run_in_link } from './report';
import { link_of, moment_from } from './words';
import type { Stopped } from './protocol';
import * as search from './timeline/search';
import { measure } from './timeline/measure';
import * as timeline from './timeline/view';
import { close_menu } from './panes/menu';
import { toggle_breakpoint } from './panes/program';

export interface Action {
  id: string;
  group: 'Run' | 'Steps' | 'Go to' | 'Program' | 'Timeline' | 'Page';
  title: string;
  keys: string[];
  does: () => void;
}

function toggle_run(): void {
  if (state.running) pause();
  else void run();
}

function step(line: Command): () => void {
  return () => void move(line);
}

/** To the next interrupt, or to the one before; if there is none, it stays where it was. */
async function step_to_interrupt(direction: 1 | -1): Promise<void> {
  if (!state.outline?.routines.some((one) => /^INT/.test(one.name))) {
    notice('The program has no interrupt routine');
    return;
  }
  const reply = await move<Stopped>(direction > 0 ? line_of`interrupt` : line_of`rinterrupt`);
  const found = reply.error !== undefined || (direction > 0 ? reply.json?.stopped !== 'limit' : state.past?.now_ns !== state.past?.oldest_ns);
  if (found) return;
  await move(line_of`back`);
  notice(direction > 0 ? 'No interrupt within 10 s after this moment' : 'No interrupt before this moment');
}

/** There is no way back from it to what has run. */
function ask_to_power_up(): void {
  if ((state.past?.newest_ns ?? 0) === 0) void power_up();
  else show_dialog('power-up');
}

export async function power_up(): Promise<void> {
  show_dialog(null);
  await move(line_of`restart`);
}

function go_to_mark(direction: 1 | -1): void {
  const mark = next_mark(direction);
  if (mark === undefined) notice(direction > 0 ? 'No mark after this moment' : 'No mark before this moment');
  else void go_to(mark);
}

function focus_field(which: string): void {
  const field = document.querySelector<HTMLInputElement>(which);
  field?.focus();
  field?.select();
}

export function go_to_typed(text: string): void {
  const ns = moment_from(text);
  if (ns === undefined) notice(`'${text}' is not a time; write for example 15.193ms, 2s or 1h`, 'error');
  else void go_to_named(ns);
}

/** This moment in the address; of the playground its program too, if it is small. */
async function copy_link(): Promise<void> {
  const moment = link_of(state.past?.now_ns ?? 0) + run_in_link();
  const program = can_open() && !state.report ? await address_of(state.sources) : undefined;
  history.replaceState(null, '', program ? `${moment}&${program}` : moment);
  const what = program ? 'Link to this program and moment' : 'Link to this moment';
  navigator.clipboard?.writeText(location.href).then(
    () => notice(`${what} copied: ${moment}`), () => notice(`${what}, in the address bar now: ${moment}`));
}

const kPrefersDark = matchMedia('(prefers-color-scheme: dark)');

/** Paper is light. */
export function apply_theme(): void {
  const system = kPrefersDark.matches && !state.printing ? 'dark' : 'light';
  document.documentElement.dataset['theme'] = state.theme === 'system' || state.printing ? system : state.theme;
  changed();
}

export function begin_theme(): void {
  const kept = remembered('theme');
  if (kept === 'light' || kept === 'dark') state.theme = kept;
  kPrefersDark.addEventListener('change', apply_theme);
  apply_theme();
}

function next_theme(): void {
  const themes = ['system', 'light', 'dark'] as const;
  state.theme = themes[(themes.indexOf(state.theme) + 1) % themes.length]!;
  remember('theme', state.theme);
  apply_theme();
}

export function toggle_dialog(which: 'help' | 'about'): () => void {
  return () => {
    state.dialog = state.dialog === which ? null : which;
    changed();
  };
}

function pane_actions(): Action[] {
  return [...kPanes].sort((a, b) => a.key.localeCompare(b.key)).map((one) => ({ id: `pane-${one.pane}`, group: 'Page', title: 'title' in one ? one.title : one.name, keys: [one.key],
    does: () => { if (one.pane !== 'report' || state.report) focus_pane(one.pane); } }));
}

export const kActions: Action[] = [
  { id: 'run', group: 'Run', title: 'Run or pause', keys: [' ', 'F5'], does: toggle_run },
  { id: 'mode-run', group: 'Run', title: 'Switch the CPU to RUN', keys: ['Shift+R'], does: () => void command(line_of`mode run`) },
  { id: 'mode-stop', group: 'Run', title: 'Switch the CPU to STOP', keys: ['Shift+P'], does: () => void command(line_of`mode stop`) },
  { id: 'restart', group: 'Run', title: 'Power up again', keys: ['Shift+U'], does: ask_to_power_up },

  { id: 'step', group: 'Steps', title: 'Instruction', keys: ['.', 'F11'], does: step(line_of`step`) },
  { id: 'rstep', group: 'Steps', title: 'Back by an instruction', keys: [',', 'Shift+F11'], does: step(line_of`rstep`) },
  { id: 'over', group: 'Steps', title: 'Instruction, over a CALL', keys: ['o', 'F10'], does: step(line_of`over`) },
  { id: 'rover', group: 'Steps', title: 'Back over a CALL', keys: ['Shift+O', 'Shift+F10'], does: step(line_of`rover`) },
  { id: 'network', group: 'Steps', title: 'Network', keys: ['n'], does: step(line_of`network`) },
  { id: 'rnetwork', group: 'Steps', title: 'Back by a network', keys: ['Shift+N'], does: step(line_of`rnetwork`) },
  { id: 'scan', group: 'Steps', title: 'Scan', keys: ['s'], does: step(line_of`scan`) },
  { id: 'rscan', group: 'Steps', title: 'Back by a scan', keys: ['Shift+S'], does: step(line_of`rscan`) },
  { id: 'interrupt', group: 'Steps', title: 'Interrupt', keys: ['i'], does: () => void step_to_interrupt(1) },
  { id: 'rinterrupt', group: 'Steps', title: 'Back to the last interrupt', keys: ['Shift+I'], does: () => void step_to_interrupt(-1) },

  { id: 'start', group: 'Go to', title: 'Start of the past', keys: ['Home'], does: () => void move(line_of`at start`) },
  { id: 'end', group: 'Go to', title: 'Newest moment', keys: ['End'], does: () => void move(line_of`at end`) },
  { id: 'moment', group: 'Go to', title: 'A moment', keys: ['g'], does: () => focus_field('#moment') },
  { id: 'rcontinue', group: 'Go to', title: 'Back to the last breakpoint or answer', keys: ['Shift+B'], does: step(line_of`rcontinue`) },
  { id: 'why', group: 'Go to', title: 'Why has it come here?', keys: ['w'], does: () => void ask_why() },
  { id: 'link', group: 'Go to', title: 'Copy a link to this moment', keys: ['l'], does: () => void copy_link() },

  { id: 'breakpoint', group: 'Program', title: 'Breakpoint in the selected line', keys: ['b', 'F9'],
    does: () => void toggle_breakpoint(state.selected_line ?? state.past?.line ?? null) },
  { id: 'find', group: 'Program', title: 'Find in the program', keys: ['/'], does: () => focus_field('#find') },
  { id: 'view', group: 'Program', title: 'STL or ladder', keys: ['v'],
    does: () => { state.view = state.view === 'stl' ? 'ladder' : 'stl'; changed(); } },
  { id: 'follow', group: 'Program', title: 'Show where the CPU stands', keys: ['f'],
    does: () => { state.follow = !state.follow; changed(); } },

  { id: 'zoom-in', group: 'Timeline', title: 'Zoom in', keys: ['+', '='], does: () => timeline.zoom_by(0.5) },
  { id: 'zoom-out', group: 'Timeline', title: 'Zoom out', keys: ['-'], does: () => timeline.zoom_by(2) },
  { id: 'zoom-all', group: 'Timeline', title: 'The whole past', keys: ['0'], does: timeline.show_all },
  { id: 'left', group: 'Timeline', title: 'Earlier', keys: ['ArrowLeft'], does: () => timeline.move_by(-0.2) },
  { id: 'right', group: 'Timeline', title: 'Later', keys: ['ArrowRight'], does: () => timeline.move_by(0.2) },
  { id: 'cursor-a', group: 'Timeline', title: 'Cursor A here', keys: ['['], does: () => timeline.set_cursor('a') },
  { id: 'cursor-b', group: 'Timeline', title: 'Cursor B here', keys: [']'], does: () => timeline.set_cursor('b') },
  { id: 'measure', group: 'Timeline', title: 'Measure between the cursors, or what is in view', keys: ['Shift+M'], does: () => void measure() },
  { id: 'next-error', group: 'Timeline', title: 'Next lost character or error', keys: ['e'], does: () => void search.find_error(1) },
  { id: 'previous-error', group: 'Timeline', title: 'Previous one', keys: ['Shift+E'], does: () => void search.find_error(-1) },
  { id: 'next-unanswered', group: 'Timeline', title: 'Next unanswered request', keys: ['u'], does: () => void search.find_unanswered() },
  { id: 'condition', group: 'Timeline', title: 'Next time that a condition holds', keys: ['x'], does: () => focus_field('#condition') },
  { id: 'longest', group: 'Timeline', title: 'Longest answer', keys: ['Shift+L'], does: () => void search.find_longest() },
  { id: 'longest-scan', group: 'Timeline', title: 'Longest scan', keys: ['Shift+C'], does: () => void search.find_longest_scan() },

  { id: 'mark', group: 'Timeline', title: 'Mark this moment, or take the mark away', keys: ['m'], does: toggle_mark },
  { id: 'next-mark', group: 'Timeline', title: 'Next mark', keys: ['>'], does: () => go_to_mark(1) },
  { id: 'previous-mark', group: 'Timeline', title: 'Previous mark', keys: ['<'], does: () => go_to_mark(-1) },
  { id: 'compare', group: 'Timeline', title: 'Two futures: keep this one, change something, compare', keys: ['c'], does: () => void compare_futures() },

  ...pane_actions(),
  { id: 'theme', group: 'Page', title: 'Light, dark or as the system', keys: ['t'], does: next_theme },
  { id: 'help', group: 'Page', title: 'Keys', keys: ['?', 'F1'], does: toggle_dialog('help') },
  { id: 'about', group: 'Page', title: 'About', keys: [], does: toggle_dialog('about') },
];

const by_id = new Map(kActions.map((one) => [one.id, one]));
export function action(id: string): Action {
  return by_id.get(id)!;
}

/** At once if it is there, so that the next key finds it. */
function focus_pane(pane: PaneName): void {
  const focus = (): void => document.querySelector<HTMLElement>(keys_to(pane))?.focus();
  show_pane(pane);
  focus();
  requestAnimationFrame(focus);
}

/** `Shift+F10`, as the table writes keys; a shifted character is the character that it makes. */
function key_of(event: KeyboardEvent): string {
  const letter = /^[a-z]$/i.test(event.key);
  const shifted = event.shiftKey && (letter || event.key.length > 1);
  return (shifted ? 'Shift+' : '') + (letter ? (shifted ? event.key.toUpperCase() : event.key.toLowerCase()) : event.key);
}

function is_typing(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && target.matches('input, select, textarea');
}

/** A control under the focus takes these keys itself. */
function is_taken(event: KeyboardEvent): boolean {
  if (!(event.target instanceof Element)) return false;
  if (event.target.matches('button, summary, [role=button], a')) {
    if (event.key === ' ' || event.key === 'Enter') return true;
  }
  return event.target.matches('[role=switch]') && event.key === 'F10' && event.shiftKey;  // asks for its menu
}

export function on_key(event: KeyboardEvent): void {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.key === 'Escape') {
    if (state.dialog === null && state.menu === null) state.notice = null;
    state.dialog = null;
    close_menu();
    if (is_typing(event.target)) (event.target as HTMLElement).blur();
    changed();
    return;
  }
  const function_key = /^F\d+$/.test(event.key);
  if ((is_typing(event.target) && !function_key) || is_taken(event)) return;
  const found = kActions.find((one) => one.keys.includes(key_of(event)));
  if (!found || ((state.dialog !== null || state.menu !== null) && found.id !== state.dialog)) return;
  event.preventDefault();
  found.does();
}

const kKeyNames: Record<string, string> = { ' ': 'Space', ArrowLeft: '←', ArrowRight: '→' };
export function key_text(key: string): string {
  return kKeyNames[key] ?? key;
}
/** `Scan (S)`: for tooltips. */
export function title_with_key(one: Action): string {
  return one.keys.length === 0 ? one.title : `${one.title} (${key_text(one.keys[0]!)})`;
}
