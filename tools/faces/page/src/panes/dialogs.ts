// The overlays: keys, and about.
import { h, type Child, type Part } from '../dom';
import { icon } from '../icons';
import { kActions, key_text, power_up } from '../actions';
import { can_open } from '../playground';
import { measurement } from './measurement';
import { show_dialog, state } from '../state';
import { duration_text } from '../words';

function close(): void {
  show_dialog(null);
}

function dialog(title: string, ...content: Child[]): Part {
  return h('div', { class: 'shade', onclick: (event: Event) => { if (event.target === event.currentTarget) close(); } },
    h('div', { class: `dialog ${title.toLowerCase()}`, role: 'dialog', 'aria-modal': 'true', 'aria-label': title, tabindex: '-1',
      ref: (node: HTMLElement) => { if (!node.contains(document.activeElement)) node.focus(); } },
    h('header', {}, h('h2', {}, title), h('button', { class: 'plain', 'aria-label': 'Close', onclick: close }, icon('close'))),
    ...content));
}

/** In a dialog that asks. */
function focus_first(button: HTMLElement): void {
  if (!button.closest('.dialog')!.contains(document.activeElement)) button.focus();
}

function help(): Part {
  const groups = [...new Set(kActions.map((one) => one.group))];
  return dialog('Keys',
    h('div', { class: 'key-groups' }, groups.map((group) => h('section', {}, h('h3', {}, group),
      h('dl', {}, kActions.filter((one) => one.group === group && one.keys.length > 0).map((one) => [
        h('dt', {}, one.keys.map((key) => h('kbd', {}, key_text(key)))), h('dd', {}, one.title)]))))),
    h('p', {}, 'Click an address for its menu, the margin of a line for a breakpoint, the timeline to go to a moment. ',
      'In the listing ↑ and ↓ choose a line, in the ladder a network; Tab reaches its addresses, and Enter goes to the last execution of a line. ',
      'Esc closes menus and leaves fields.'));
}

/** What the engine of the page in one file is linked with. */
const kLinked = [
  ['{fmt}', 'Copyright (c) 2012 - present, Victor Zverovich', 'MIT licence'],
  ['JSON for Modern C++', 'Copyright (c) 2013-2022 Niels Lohmann', 'MIT licence'],
  ['Boost (Spirit X3 and what it needs)', 'Copyright of its authors', 'Boost Software License 1.0'],
  ['libc++, libc++abi and compiler-rt of LLVM', 'Copyright of their authors', 'Apache License 2.0 with LLVM exceptions'],
  ['wasi-libc, with parts of musl', 'Copyright of their authors', 'Apache License 2.0 with LLVM exceptions, MIT licence'],
];

function licences(): Child[] {
  return [h('h3', {}, 'Licences'),
    h('p', {}, 'MIT licence. Copyright (c) 2026 the s7200 authors. The page is TypeScript of this project and contains no code of others.'),
    can_open() ? h('table', { class: 'licences' }, h('tbody', {}, kLinked.map((row) => h('tr', {}, row.map((cell) => h('td', {}, cell)))))) : null];
}

function about(): Part {
  const hello = state.hello;
  return dialog('About',
    h('p', {}, `s7200 ${hello?.version ?? ''}: runs SIMATIC S7-200 STL programs, instruction by instruction in simulated time.`),
    hello ? h('p', {}, `Program ${hello.program} on a CPU ${state.outline?.cpu ?? hello.cpu}.`) : null,
    h('p', {}, 'Execution times are estimates until you measure a real CPU.'),
    licences(),
    h('p', {}, 'SIMATIC and S7-200 are names of Siemens products; this project has no connection with Siemens.'));
}

export function dialogs(): Part | null {
  switch (state.dialog) {
    case 'help': return help();
    case 'about': return about();
    case 'power-up': return dialog('Power up again',
      h('p', {}, `The PLC begins again at 0 ms. What has run so far, ${duration_text(state.past?.newest_ns ?? 0)}, and what was done from outside meanwhile are gone then. Breakpoints and the status chart stay.`),
      h('div', { class: 'chart-tools' }, h('button', { id: 'power-up', ref: focus_first, onclick: () => void power_up() }, 'Power up again'), h('button', { onclick: close }, 'Cancel')));
    case 'measurement': return dialog('Measured', ...measurement());
    default: return null;
  }
}
