// A program that is dropped on the page, checked, and run in the browser.
import { is_program, sources_in, sources_of } from './files';
import { pause } from './session';
import { changed, notice, state, the_engine } from './state';
import type { Opened, Source } from './protocol';

export function can_open(): boolean {
  return the_engine().open !== undefined;
}

/** A file that is no text, a document perhaps, is not kept: what was there before it still is. */
function leave_out_unreadable(error: string, given: Source[]): void {
  const kept = state.sources.filter((one) => !given.includes(one) || !error.startsWith(`cannot read ${one.name}: `));
  if (kept.length === state.sources.length) return;
  state.sources = kept;
  state.opening = state.outline === null;
  changed();
}

const kUsualCpu = '214';

/** What the command notes beside mistakes: how the text was read, and for which CPU if it is not the usual one. */
function notes_of(opened: Opened): string[] {
  const cpu = opened.cpu ?? kUsualCpu, of_cpu = `It runs as on a CPU ${cpu}, which its head names or which is the first that can run it; PLC type chooses another`;
  return [...(opened.notes ?? []), ...(state.cpu === '' && cpu !== kUsualCpu ? [of_cpu] : [])];
}

/** Checks the program; if it is fine there is a session, which says hello by itself. What ran before does not run on behind its mistakes. */
export async function open_program(note = ''): Promise<void> {
  const engine = the_engine();
  if (!engine.open) return;
  if (state.sources.every((one) => one.text.trim() === '')) {
    notice('There is no program yet: drop one on the page, or type it');
    return;
  }
  notice('');
  if (state.running) pause();
  const given = state.sources;
  const sources = given.map(({ name, text, hex }) => (hex === undefined ? { name, text } : { name, hex }));
  const reply = await engine.open({ sources, options: state.cpu === '' ? {} : { cpu: state.cpu } });
  if (reply.error !== undefined || !reply.json) {
    notice(reply.error ?? 'the program could not be opened', 'error');
    leave_out_unreadable(reply.error ?? '', given);
    return;
  }
  const read = new Map(reply.json.sources?.map(({ name, text }) => [name, text])), is_as_given = state.sources === given;
  state.sources = state.sources.map((one) => (one.hex === undefined || !given.includes(one) ? one : { name: one.name, text: read.get(one.name) ?? one.text }));
  state.check_text = reply.json.text;
  state.check_notes = [...(note === '' ? [] : [note]), ...notes_of(reply.json)];
  state.opening = !reply.json.opened || !is_as_given;  // someone types on
  if (reply.json.opened && state.check_notes.length > 0) notice(state.check_notes.join('\n'));
  changed();
}

function names_of(sources: Source[]): string {
  return sources.map((one) => one.name).join(', ');
}

/** What the command alone opens: a system or a file of scenarios names further files. */
function names_other_files(one: Source): boolean {
  return /\.ya?ml$/i.test(one.name);
}

export function use_sources(given: Source[]): void {
  const refused = given.find(names_other_files), sources = given.filter((one) => !names_other_files(one));
  if (refused) notice(`A system or a file of scenarios names other files, which this page cannot read: s7200 view ${refused.name} shows it`, 'error');
  if (sources.length === 0) return;
  const old = state.sources.filter((one) => one.text.trim() !== ''), names = new Set(sources.map((one) => one.name));
  const has_program = sources.some(is_program), is_another = has_program && old.some(is_program) && !old.some((one) => is_program(one) && names.has(one.name));
  if (is_another) replaced = old;
  const kept = is_another ? [] : old.filter((one) => !names.has(one.name));
  state.sources = has_program ? [...sources, ...kept] : [...kept, ...sources];
  state.opening = true;
  changed();
  void open_program(is_another ? `${sources[0]!.name} replaces ${names_of(old)}; Edit leads back` : '');
}

/** What another program was dropped over, its symbol tables included. */
let replaced: Source[] = [];

export function names_of_replaced(): string {
  return names_of(replaced);
}

export function take_back_replaced(): void {
  [state.sources, replaced] = [replaced, state.sources];
  void open_program();
}

export function accept_drops(): void {
  addEventListener('dragover', (event) => {
    if (!can_open()) return;
    event.preventDefault();
    document.documentElement.classList.add('dropping');
  });
  addEventListener('dragleave', (event) => {
    if (event.relatedTarget === null) document.documentElement.classList.remove('dropping');
  });
  addEventListener('drop', (event) => {
    document.documentElement.classList.remove('dropping');
    if (!can_open() || !event.dataTransfer) return;
    event.preventDefault();
    void sources_of(event.dataTransfer.files).then(use_sources);
  });
}

export async function open_from_address(): Promise<void> {
  const sources = await sources_in(location.hash);
  if (sources.length > 0) use_sources(sources);
}
