// The report: what ran, with its verdicts, as a tree; a run is opened at what it found.
import { h, kept, type Child, type Part } from '../dom';
import { ask_why, ask_why_unanswered, in_short } from '../causes';
import { can_be_opened, choose_run } from '../report';
import { go_to } from '../session';
import { kRowsOnPaper, state } from '../state';
import { duration_text, moment_text } from '../words';
import { linked } from './causes';
import type { Exchange } from '../exchanges';
import type { Recorded, Report, ReportedFinding, ReportedRun } from '../protocol';

const kMarks: Record<string, string> = { passed: '✓', failed: '✗', skipped: '–', 'expected failure': '≈' };

/** `12 scenarios: 11 passed, 1 failed` */
function totals(runs: ReportedRun[]): string {
  const counts = Object.keys(kMarks).map((outcome) => [runs.filter((one) => one.outcome === outcome).length, outcome] as const);
  const said = counts.filter(([count]) => count > 0).map(([count, outcome]) => `${count} ${outcome}`).join(', ');
  return `${runs.length} ${runs.length === 1 ? 'scenario' : 'scenarios'}: ${said}`;
}

/** Where a finding is: there is a link to it if it is in the run that is open. */
async function show_finding(number: number, one: ReportedFinding, ask: boolean): Promise<void> {
  if (one.recording !== state.recording || state.run !== number) return choose_run(number, one.recording, one.at_ns);
  await go_to(one.at_ns!);
  if (ask) await ask_why();
}

function finding(number: number, one: ReportedFinding, i: number): Part {
  const place = one.at_ns === undefined ? null
    : h('span', { class: 'finding-tools' },
      h('button', { class: 'link', title: 'Go to this moment', onclick: () => void show_finding(number, one, false) }, moment_text(one.at_ns)),
      h('button', { class: 'why', title: 'What decided that it has come here', onclick: () => void show_finding(number, one, true) }, 'Why?'));
  return h('li', { key: i }, h('div', {}, one.line === undefined ? '' : `line ${one.line}: `, one.text, ' ', place),
    one.why ? h('pre', {}, one.why.map((line) => h('div', {}, linked(line)))) : null);
}

function power_ups(number: number, run: ReportedRun): Part | null {
  const count = run.recordings?.length ?? 0;
  if (count < 2) return null;
  return h('label', {}, 'Power-up ', h('select', { 'aria-label': 'Power-up', onchange: (event: Event) => choose_run(number, Number((event.target as HTMLSelectElement).value)) },
    run.recordings!.map((_, i) => h('option', { value: String(i), selected: state.recording === i }, `${i + 1} of ${count}`))));
}

function verdict(number: number, run: ReportedRun): Child[] {
  return [run.reason ? h('p', {}, run.reason) : null,
    run.findings.length > 0 ? h('ol', { class: 'findings' }, run.findings.map((one, i) => finding(number, one, i))) : null];
}

/** What is said of the run that is open. */
function details(number: number, run: ReportedRun): Part {
  return h('div', { class: 'run-details' },
    power_ups(number, run),
    verdict(number, run),
    can_be_opened(run) ? what_came(run.recordings?.[state.recording ?? 0]) : h('p', { class: 'hint' }, 'Its run is not in the report: it is of several tables of times, of a slave outside the simulation, or of a scenario that switches power or cuts a cable of a system.'));
}

function row(report: Report, number: number): Part {
  const run = report.runs[number]!, open = state.run === number;
  return h('li', { key: number, class: `run ${run.outcome.replace(' ', '-')}${open ? ' open' : ''}` },
    h('button', { class: 'plain run-name', 'aria-expanded': String(open), 'aria-label': `${run.name}, ${run.outcome}`, onclick: () => choose_run(number) },
      h('span', { class: 'mark', 'aria-hidden': 'true' }, kMarks[run.outcome] ?? ''), h('span', {}, run.name)),
    open ? details(number, run) : state.printing && run.outcome === 'failed' ? h('div', { class: 'run-details' }, verdict(number, run)) : null);
}

function scenarios(report: Report): Part {
  const files = [...new Set(report.runs.map((one) => one.file))];
  return h('div', { class: 'report-pane' },
    h('p', { class: 'totals' }, totals(report.runs)),
    files.map((file) => h('section', { key: file }, h('h3', {}, file),
      h('ul', { class: 'runs' }, report.runs.flatMap((run, number) => (run.file === file ? [row(report, number)] : []))))));
}

const kListed = 200;

/** `send 01 03 00 0a …`: an action as a saved session writes it, in a few words. */
function action_text(action: Record<string, unknown>): string {
  const [name, value] = Object.entries(action)[0] ?? ['', ''];
  if (name === 'host') return 'the other end of the bridge';
  const words = Array.isArray(value) ? value.map((one) => (Array.isArray(one) ? one.join('=') : String(one))).join(' ') : typeof value === 'object' ? '' : String(value);
  return `${name} ${words}`.trim();
}

interface Came {
  at_ns: number;
  text: string;
  count: number;
  last_ns: number;
}

/** What came from outside; what was the same several times in a row is one. */
function all_that_came(recorded: Recorded): Came[] {
  const all: Came[] = [];
  let at_ns = 0;
  for (let i = 0; i < recorded.count; ++i) {
    at_ns += recorded.done.after_ns?.[i] ?? 0;
    const text = action_text(recorded.actions[recorded.done.action?.[i] ?? 0] ?? {}), last = all[all.length - 1];
    if (last?.text === text) {
      ++last.count;
      last.last_ns = at_ns;
    } else {
      all.push({ at_ns, text, count: 1, last_ns: at_ns });
    }
  }
  return all;
}

function moment_link(ns: number): Part {
  return h('button', { class: 'link', title: 'Go to this moment', onclick: () => void go_to(ns) }, moment_text(ns));
}

function came_row(one: Came, i: number): Part {
  return h('tr', { key: i }, h('td', {}, moment_link(one.at_ns)),
    h('td', { class: 'frame' }, one.text, one.count === 1 ? null : h('span', { class: 'hint' }, `, ${one.count} times, up to `, moment_link(one.last_ns))));
}

/** With its moments: that is what brought the run where it is. */
function table_of(recorded: Recorded, most: number): Part {
  const all = all_that_came(recorded), more = all.slice(most).reduce((sum, one) => sum + one.count, 0);
  return h('div', {}, h('h3', {}, 'From outside'), h('table', { class: 'exchanges' }, h('tbody', {}, all.slice(0, most).map(came_row))),
    more > 0 ? h('p', { class: 'hint' }, `and ${more} more`) : null);
}
const on_screen = kept((recorded: Recorded) => table_of(recorded, kListed)), on_paper = kept((recorded: Recorded) => table_of(recorded, kRowsOnPaper));

function what_came(recorded: Recorded | undefined): Part | null {
  return recorded && recorded.count > 0 ? (state.printing ? on_paper : on_screen)(recorded) : null;
}

/** How many answers there were in a long run, and the longest. */
function answers_text(recorded: Recorded | undefined): Child[] {
  const answers = recorded?.picture?.answers, longest = answers?.longest[0];
  if (!answers || !longest) return [];
  return [`${answers.count}, the longest after ${duration_text(longest.answer_ns - longest.end_ns)}, to the request at `, moment_link(longest.at_ns)];
}

const kUnanswered = 20;  // that are listed

function unanswered_item(one: Exchange, i: number): Part {
  return h('div', { class: 'unanswered', key: i }, moment_link(one.at_ns), h('span', { class: 'frame' }, ` ${in_short(one.request)} `),
    h('button', { class: 'why', title: 'What kept the program from an answer', onclick: () => void ask_why_unanswered(one) }, 'Why?'));
}

/** Which requests have no answer. */
function unanswered_list(): Child[] {
  const all = state.unanswered, more = all.length - kUnanswered;
  return [...all.slice(0, kUnanswered).map(unanswered_item), more > 0 ? `and ${more} more` : ''].filter((one) => one !== '');
}

/** Of a run that is no scenario. */
function summary(report: Report, run: ReportedRun): Part {
  const end_ns = run.recordings?.[0]?.end[2] ?? 0, actions = run.recordings?.[0]?.count ?? 0;
  const rows: [string, Child[]][] = [
    ['Command', [`s7200 ${report.verb}`]],
    run.system === undefined ? ['Program', [state.sources[0]?.name ?? '']] : ['System', [report.systems?.[run.system]?.name ?? '']],
    run.system === undefined ? ['CPU', [state.hello?.cpu ?? '']] : ['PLCs', [(state.hello?.stations ?? []).join(', ')]],
    ['Simulated time', [duration_text(end_ns)]],
    ['From outside', [actions === 0 ? 'nothing' : `${actions} ${actions === 1 ? 'action' : 'actions'}`]],
    ['Answers', answers_text(run.recordings?.[0])],
    ['No answer to', unanswered_list()],
  ];
  return h('div', { class: 'report-pane' },
    h('table', { class: 'summary' }, h('tbody', {}, rows.filter(([, said]) => said.length > 0).map(([name, said]) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, said))))),
    h('p', { class: 'hint' }, 'This page has the program, what came from outside and the simulator: it computes any moment of the run again, and runs on from there.'),
    what_came(run.recordings?.[0]));
}

export function report_pane(): Part {
  const report = state.report!;
  const only = report.runs.length === 1 ? report.runs[0]! : null;
  return only && only.name === '' ? summary(report, only) : scenarios(report);
}
