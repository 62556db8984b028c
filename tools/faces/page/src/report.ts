// What a report carries: runs of programs, with what came from outside, each of which is computed again here.
import { changed, notice, show_pane, state, the_engine } from './state';
import { go_to_verdict } from './causes';
import { exchanges_of, is_unanswered } from './exchanges';
import { unless_taken_over, when_begun } from './session';
import { spans_between } from './timeline/view';
import type { Openable, Report, ReportedRun } from './protocol';

/** The report in the page; null if it has none, or a damaged one. */
async function report_in_page(): Promise<Report | null> {
  const packed = document.querySelector('#report')?.textContent?.trim() ?? '';
  if (packed === '') return null;
  try {
    const bytes = Uint8Array.from(atob(packed), (one) => one.charCodeAt(0));
    const text = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'))).text();
    return JSON.parse(text) as Report;
  } catch {
    notice('The report in this page is damaged', 'error');
    return null;
  }
}

export function can_be_opened(run: ReportedRun): boolean {
  return (run.program !== undefined || run.system !== undefined) && (run.recordings?.length ?? 0) > 0;
}

function what_ran(report: Report, run: ReportedRun): Openable {
  if (run.system !== undefined) return { system: report.systems![run.system]! };
  return { sources: report.programs[run.program!]!, options: run.options ?? {} };
}

/** The number of the run that the address names; null if it names none. */
function run_of_link(report: Report): number | null {
  const asked = Number(/[#&]run=(\d+)/.exec(location.hash)?.[1] ?? 0) - 1;
  return report.runs[asked] ? asked : null;
}

/** The run that the address names, else the first that failed, else the first one. */
function first_run(report: Report): number {
  const asked = run_of_link(report);
  if (asked !== null) return asked;
  const failed = report.runs.findIndex((one) => one.outcome === 'failed' && can_be_opened(one));
  return failed >= 0 ? failed : Math.max(0, report.runs.findIndex(can_be_opened));
}

const kShort = 600e9;  // ns: the end of a shorter run is computed before one has looked up

const kMostFrames = 20000;

/** Where a request of `send` or `master` had no answer, the report opens: what they say has waited for all of them. */
async function open_at_unanswered(may_go: boolean): Promise<void> {
  const run = state.report?.runs[state.run ?? 0], end_ns = run?.recordings?.[state.recording ?? 0]?.end[2] ?? 0;
  if (!['send', 'master'].includes(state.report?.verb ?? '') || end_ns > kShort) return;
  const is_wanted = unless_taken_over(), { run: number, recording } = state;
  const unanswered = exchanges_of(await spans_between(0, end_ns, kMostFrames), Infinity).filter(is_unanswered);
  if (state.run !== number || state.recording !== recording) return;
  state.unanswered = unanswered;
  changed();
  if (may_go && is_wanted() && state.unanswered[0]) await go_to_verdict(state.unanswered[0]);
}

/** Opens a run, at what it found or else at its end; the end of a long one is computed when one goes there. */
export async function open_run(number: number, recording?: number, at_ns?: number): Promise<void> {
  const report = state.report, run = report?.runs[number];
  if (!report || !run || !the_engine().open) return;
  state.run = number;
  changed();
  if (!can_be_opened(run)) return;
  const finding = run.findings.find((one) => one.at_ns !== undefined);
  const which = recording ?? finding?.recording ?? run.recordings!.length - 1;
  const recorded = run.recordings![which]!;
  const end_ns = recorded.end[2];
  state.recording = which;
  state.unanswered = [];
  state.sources = run.system === undefined ? report.programs[run.program!]! : [];
  state.picture = recorded.picture ?? null;
  state.first_moment = at_ns ?? (finding?.recording === which ? finding.at_ns! : end_ns <= kShort ? end_ns : 0);
  const reply = await the_engine().open!(what_ran(report, run), recorded);
  if (reply.error !== undefined || !reply.json?.opened) notice(reply.error ?? 'the run cannot be opened', 'error');
}

/** Opens the report that the page carries. Returns whether it has one. */
export async function open_report(): Promise<boolean> {
  const report = await report_in_page();
  if (!report) return false;
  state.report = report;
  changed();
  if (report.conversation) return true;
  show_pane('report');
  when_begun(open_at_unanswered);
  await open_run(first_run(report));
  return true;
}

/** Goes to another run: the address names it from then on. */
export function choose_run(number: number, recording?: number, at_ns?: number): void {
  history.replaceState(null, '', `#run=${number + 1}`);
  void open_run(number, recording, at_ns);
}

/** Opens the run that the address has come to name, at the moment in it. Returns whether it is another one. */
export function opens_another_run(): boolean {
  const asked = state.report ? run_of_link(state.report) : null;
  if (asked === null || asked === state.run) return false;
  void open_run(asked);
  return true;
}

/** `&run=3`: which run an address is about; nothing if there is but one. */
export function run_in_link(): string {
  return state.report && state.report.runs.length > 1 && state.run !== null ? `&run=${state.run + 1}` : '';
}
