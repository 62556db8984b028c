// What the playground shows before there is a program, or while it has mistakes: files, text, and what check says.
import { h, type Part } from '../dom';
import { icon } from '../icons';
import { names_of_replaced, open_program, take_back_replaced, use_sources } from '../playground';
import { sources_of } from '../files';
import { changed, state } from '../state';

const kTyped = 'program.awl';
const kCpus = ['212', '214', '215', '216', '221', '222', '224', '224XP', '226'];
const kExample = `NETWORK 1 // the pump runs from start to stop
LD     I0.0
O      Q0.0
AN     I0.1
=      Q0.0
MEND
`;

function program_text(): string {
  return state.sources[0]?.text ?? '';
}

function type_program(text: string): void {
  const [first, ...others] = state.sources;
  state.sources = [{ name: first?.name ?? kTyped, text }, ...others];
}

function file(name: string): Part {
  return h('span', { class: 'file', key: name }, name, h('button', { class: 'plain', 'aria-label': `Leave out ${name}`, onclick: () => {
    state.sources = state.sources.filter((one) => one.name !== name);
    changed();
  } }, icon('close')));
}

/** Selects a line of the program where it is edited. */
function show_line(number: number): void {
  const field = document.querySelector<HTMLTextAreaElement>('.opener textarea');
  if (!field) return;
  const lines = field.value.split('\n');
  const start = lines.slice(0, number - 1).reduce((sum, line) => sum + line.length + 1, 0);
  field.focus();
  field.setSelectionRange(start, start + (lines[number - 1]?.length ?? 0));
  field.scrollTop = (number - 3) * parseFloat(getComputedStyle(field).lineHeight);
}

const kPlace = /^(.*):(\d+):\d+: (error|warning): /;

/** A source line and the marks below it keep their columns: `VW100, VB2` and `^~~~~`. Sentences go on in the next line. */
function keeps_columns(line: string, before: string | undefined, after: string | undefined): boolean {
  const is_mark = (text: string | undefined): boolean => text !== undefined && /^\s*\^~*\s*$/.test(text);
  return is_mark(line) || is_mark(after) || (kPlace.test(before ?? '') && line.trim() !== '' && !/^(hint|note): /.test(line));
}

function said(): Part | null {
  if (state.check_text === '') return null;
  const said_lines = state.check_text.trimEnd().split('\n'), summary = said_lines.pop()!;
  return h('pre', { class: 'diagnostics', role: 'status', 'aria-label': 'What check says' }, h('div', { class: 'total' }, summary), said_lines.map((line, i, all) => {
    const place = kPlace.exec(line);
    if (!place) return h('div', { class: keeps_columns(line, all[i - 1], all[i + 1]) ? 'columns' : '' }, line === '' ? ' ' : line);
    const shows = place[1] === state.sources[0]?.name ? () => show_line(Number(place[2])) : undefined;
    return h(shows ? 'button' : 'div', { class: `${place[3]}${shows ? ' leads' : ''}`, title: shows ? 'Show the line' : '', onclick: shows }, line);
  }), state.check_notes.map((note) => h('div', { class: 'note' }, `note: ${note}`)));
}

export function opener(): Part {
  return h('div', { class: 'opener' },
    h('div', { class: 'files' },
      h('input', { type: 'file', multiple: true, hidden: true, id: 'choose-files', onchange: (event: Event) => {
        const chosen = (event.target as HTMLInputElement).files;
        if (chosen) void sources_of(chosen).then(use_sources);
      } }),
      h('button', { onclick: () => document.querySelector<HTMLInputElement>('#choose-files')?.click() }, 'Choose files …'),
      state.sources.length === 0 ? h('button', { onclick: () => { type_program(kExample); changed(); } }, 'Example') : null,
      state.sources.map((one) => file(one.name)),
      names_of_replaced() === '' ? null : h('button', { id: 'take-back', onclick: take_back_replaced }, `Back to ${names_of_replaced()}`),
      h('select', { 'aria-label': 'PLC type', onchange: (event: Event) => { state.cpu = (event.target as HTMLSelectElement).value; } },
        h('option', { value: '', selected: state.cpu === '' }, 'PLC type: found'), kCpus.map((cpu) => h('option', { value: cpu, selected: state.cpu === cpu }, `CPU ${cpu}`))),
      h('button', { id: 'check-and-run', onclick: () => void open_program() }, icon('run'), 'Check and run')),
    h('p', { class: 'hint' }, 'Drop an .awl or STL listing here, with its symbol table and data block; or type a program. Nothing leaves this PC.'),
    h('div', { class: 'opener-work' }, said(), h('textarea', { 'aria-label': 'Program', placeholder: 'Type or paste a program', spellcheck: 'false', wrap: 'off', value: program_text(), oninput: (event: Event) => type_program((event.target as HTMLTextAreaElement).value) })));
}
