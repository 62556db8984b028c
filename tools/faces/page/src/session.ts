// What the page does with its session: commands, and the queries about what is seen, asked anew whenever it has moved.
import { changed, notice, show_pane, state, the_engine, type Watch } from './state';
import { kProtocol } from './protocol';
import type { Hello, Line, Notification, Outline, Past, PieceOfRun, Reply, Spans, Status, Stopped, Stops, Value } from './protocol';
import { line_of, Refused, word_of, words, type Command } from './commands';
import { query_of } from './formats';
import { load_marks } from './timeline/marks';
import { forget_pulses } from './pulses';
import { duration_text, moment_of_link, moment_text, moment_word, written_in_link } from './words';

/** Something that is seen: asked for again as soon as it may differ, one question at a time. */
export class Seen {
  private asking = false;
  private stale = false;

  constructor(private readonly ask: () => Promise<void>) {}

  refresh(): void {
    this.stale = true;
    if (!this.asking) void this.go();
  }

  private async go(): Promise<void> {
    this.asking = true;
    try {
      while (this.stale) {
        this.stale = false;
        await this.ask();
      }
    } finally {
      this.asking = false;
    }
    changed();
  }
}

const kind_of = (line: string): string => line.split(' ', 1)[0]!;

/** Says what is wrong with a command, until one of the same kind is carried out. */
function heard<Json>(line: string, reply: Reply<Json>): Reply<Json> {
  const kind = kind_of(line);
  if (reply.error !== undefined) notice(reply.error, 'error', kind);
  else if (state.notice?.of === kind) notice('');
  return reply;
}

/** What takes the session for itself and is not done yet, in the order in which it was asked, and since when the first one has it. */
const under_way = new Set<object>();
let first_since = 0;

async function taking<Json>(asked: Promise<Reply<Json>>): Promise<Reply<Json>> {
  const mine = {};
  if (under_way.size === 0) first_since = performance.now();
  under_way.add(mine);
  const reply = await asked;
  under_way.delete(mine);
  first_since = performance.now();
  return reply;
}

const kPatience = 1000;  // ms that what takes long may go on while something that was asked after it waits
const kLook = 100;  // ms until that is looked at again

/** Ends what was asked before and takes long. */
async function behind<Json>(asked: Promise<Reply<Json>>, before: object[]): Promise<Reply<Json>> {
  const look = setInterval(() => {
    if (before.some((one) => under_way.has(one)) && performance.now() - first_since > kPatience) the_engine().stop();
  }, kLook);
  const reply = await asked;
  clearInterval(look);
  return reply;
}

/** Asks what waits no longer than that for what takes long. */
function ask_in_turn<Json>(line: Exclude<Command, Refused>): Promise<Reply<Json>> {
  const before = [...under_way], asked = the_engine().command<Json>(line);
  return before.length === 0 ? asked : behind(asked, before);
}

/** A command that has not been one is not sent. */
const without_command = <Json>({ why }: Refused): Reply<Json> => ({ id: 0, text: '', json: null, moved: false, error: why });

function refused<Json>(line: Refused): Reply<Json> {
  return heard(line.kind, without_command<Json>(line));
}

/** Carries out a command: during a piece of a run at once, and after a stop that has come before it. */
export async function command<Json = unknown>(line: Command): Promise<Reply<Json>> {
  if (line instanceof Refused) return refused<Json>(line);
  let reply: Reply<Json>;
  do {
    interrupt_piece();
    reply = await ask_in_turn<Json>(line);
  } while (reply.undone);
  return heard(line, reply);
}

/** A long piece of this page's run is under way, and has been asked to end for a command. */
let in_piece = false, gives_way = false;

function interrupt_piece(): void {
  if (!in_piece || gives_way) return;
  gives_way = true;
  the_engine().stop();
}

/** Carries out a piece of a run. One that has only given way to a command counts as one whose length has passed. */
export async function run_piece_of<Json = unknown>(line: Command, is_long: boolean, run: PieceOfRun): Promise<Reply<Json> & { gave_way?: boolean }> {
  if (line instanceof Refused) return refused<Json>(line);
  in_piece = is_long;
  gives_way = false;
  const reply = await the_engine().command<Json>(line, run), gave_way = gives_way && reply.interrupted === true;
  in_piece = gives_way = false;
  return { ...heard(line, reply), gave_way };
}

/** The same without a word: queries of what may not be there. One that was dropped because a run was stopped is asked again. */
export async function query<Json>(line: Command): Promise<Reply<Json>> {
  if (line instanceof Refused) return without_command(line);
  for (;;) {
    const reply = await the_engine().command<Json>(line);
    if (!reply.interrupted || reply.json !== null) return reply;
  }
}

/** A query of a search, which may take long: what is wanted next ends it. One that has ended for a command is asked again. */
export async function look_through<Json>(line: Command, is_wanted: () => boolean): Promise<Reply<Json>> {
  if (line instanceof Refused) return without_command(line);
  ++searches;
  let reply: Reply<Json>;
  do reply = await taking(ask_in_turn<Json>(line)); while (reply.interrupted && is_wanted());
  --searches;
  return reply;
}

const kChunk = 200;  // lines of the program that are asked for at once
let chunks = new Map<number, Promise<void>>();  // here, or under way; another map of another program
let seen_lines: [number, number] = [1, 60];

/** The lines of the program around that one, unless they are here. */
export function fetch_chunk_of(line: number): Promise<void> {
  const chunk = Math.floor(line / kChunk);
  if (!state.outline) return Promise.resolve();
  let here = chunks.get(chunk);
  if (!here) chunks.set(chunk, here = fetch_chunk(chunk, state.outline.lines));
  return here;
}

async function fetch_chunk(chunk: number, all_lines: number): Promise<void> {
  const from = Math.max(1, chunk * kChunk), to = Math.min(all_lines, (chunk + 1) * kChunk - 1), of_program = chunks;
  if (from > to) return;
  const reply = await query<{ text: Line[] }>(line_of`listing ${from} ${to}`);
  if (of_program !== chunks) return;
  if (reply.json) for (const one of reply.json.text) state.lines.set(one.line, one);
  else chunks.delete(chunk);
}

async function fetch_lines(): Promise<void> {
  for (let line = seen_lines[0]; line < seen_lines[1] + kChunk; line += kChunk) await fetch_chunk_of(Math.min(line, seen_lines[1]));
}

async function fetch_status(): Promise<void> {
  if (!state.outline) return;
  const first = seen_lines[0], last = Math.min(seen_lines[1], state.outline.lines), reply = await query<Status>(line_of`status ${first} ${last}`);
  if (!reply.json) return;
  state.executions = new Map(reply.json.lines.map((one) => [one.op, one]));
  state.executions_known = { first, last, since_ns: reply.json.since_ns };
}

const lines = new Seen(fetch_lines);
const status = new Seen(fetch_status);

/** The program pane shows these lines of the program. */
export function see_lines(first: number, last: number): void {
  if (first === seen_lines[0] && last === seen_lines[1]) return;
  seen_lines = [first, last];
  lines.refresh();
  status.refresh();
}

/** All addresses that are shown somewhere, each once, as they are asked for. */
function asked_addresses(): string[] {
  const all = state.chart.map((row) => query_of(row.address, row.format))
    .concat(state.inputs.map((row) => row.address), state.outputs);
  return [...new Set(all.filter((one) => word_of(one) !== undefined))];
}

const kSamples = 300;

function keep_sample(name: string, at_ns: number, number: number): void {
  let samples = state.samples.get(name);
  if (!samples) state.samples.set(name, (samples = []));
  while (samples.length > 0 && samples[samples.length - 1]!.at_ns >= at_ns) samples.pop();
  samples.push({ at_ns, number });
  if (samples.length > kSamples) samples.shift();
}

/** Each by the name that it was asked for by, which all values of `VB0:4` have. */
function by_name(values: Value[]): Map<string, Value> {
  const all = new Map<string, Value>();
  for (const one of values) all.set(one.name, all.has(one.name) ? { ...one, error: `${one.name} is several values: one address a row` } : one);
  return all;
}

async function fetch_values(): Promise<void> {
  const asked = asked_addresses();
  if (asked.length === 0) return;
  const reply = await query<{ at_ns: number; values: Value[] }>(line_of`values ${asked}`);
  if (!reply.json) return;
  state.values = by_name(reply.json.values);
  for (const name of state.samples.keys()) if (!state.values.has(name)) state.samples.delete(name);
  for (const [name, value] of state.values) if (value.error === undefined) keep_sample(name, reply.json.at_ns, Number(value.number));
}

const values = new Seen(fetch_values);
export function see_values(): void {
  values.refresh();
}

/** `gateway: VW100 (Level low) is 16#0000 (0)`: the PLC is said in a system only. */
function watch_of({ number, text }: Stops['stops'][number]): Watch {
  const station = state.hello?.stations.find((one) => text.startsWith(`${one}: `)), of_station = station === undefined ? text : text.slice(station.length + 2);
  return { number, station: station ?? '', address: of_station.split(' ', 1)[0]! };
}

/** The breakpoints and watches as the session has them. */
const stops = new Seen(async () => {
  const reply = await query<Stops>(line_of`break`);
  if (!reply.json) return;
  state.breakpoints = new Map();
  for (const stop of reply.json.stops)
    if (stop.line !== undefined && (stop.station ?? '') === (state.past?.station ?? '')) state.breakpoints.set(stop.line, stop.number);
  state.watches = reply.json.stops.filter((one) => one.kind === 'watch').map(watch_of);
});

/** Mode and errors, which commands change without going elsewhere. */
const past = new Seen(async () => {
  const reply = await query<Past>(line_of`past`);
  if (reply.json) stand_at(reply.json);
});

/** What else is asked for when the session has moved: panes add themselves. */
const others: Seen[] = [];
export function also_seen(seen: Seen): void {
  others.push(seen);
}

function refresh_all(): void {
  status.refresh();
  values.refresh();
  others.forEach((one) => one.refresh());
}

function forget_program(): void {
  chunks = new Map();
  state.lines.clear();
  state.executions.clear();
  state.executions_known = null;
  state.ladder.clear();
}

/** The program's outline: first of all, and whenever another PLC is looked at. */
async function get_acquainted(): Promise<void> {
  forget_program();
  const of_program = chunks, reply = await query<Outline>(line_of`listing`);
  if (of_program !== chunks) return;
  if (reply.json) {
    forget_program();  // what was in view meanwhile was asked for by the outline of the one before
    state.outline = reply.json;
    propose_points(reply.json);
  }
  state.has_ladder = (await query(line_of`help ladder`)).error === undefined;
  lines.refresh();
  stops.refresh();
  refresh_all();
}

/** Whether it is not the session that was known before a connection was lost. */
function is_another(hello: Hello): boolean {
  const ended = state.why_ended !== '' || the_engine().open !== undefined;
  return ended || hello.program !== state.hello?.program || hello.now.newest_ns < (state.past?.newest_ns ?? 0);
}

/** The run that was known is asked for anew: what is true of it may have changed meanwhile. */
function forget_answers(): void {
  take_over();
  ++movements;
  state.running = false;
  state.own_run = false;
  state.others_run = false;
  state.spans = null;
  state.exchanges = null;
  state.selected_span = null;
  state.first_future = null;
  state.samples.clear();
  state.switched.clear();
  state.done = null;
  forget_pulses();
}

/** A session begins, perhaps with another program: what was known of the one before says nothing of it. */
function forget_session(): void {
  state.why_ended = '';
  state.window = null;
  state.cursors = { a_ns: null, b_ns: null };
  state.trail = [];
  forget_points();
  show_picture();
}

let shown_picture: Spans | null = null;

/** Where something else was done in the run of a report, its end is another one. */
function forget_picture_of_another_end(): void {
  if (state.picture && state.picture === shown_picture && (state.past?.newest_ns ?? 0) < state.picture.to_ns) state.picture = null;
}

/** What is known of a run of a report before any of it is computed. */
function show_picture(): void {
  shown_picture = state.picture;
  if (!state.picture) return;
  state.spans = state.picture;
  const { from_ns, to_ns } = state.picture;
  state.window = { from_ns, to_ns: to_ns + (to_ns - from_ns) / 30 };  // room for the present at its end
}

let at_first_moment = async (_may_go: boolean): Promise<void> => {};
/** What is done once the page stands where it begins, unless its address names a moment; it may go on from there unless the reader has. */
export function when_begun(does: (may_go: boolean) => Promise<void>): void {
  at_first_moment = does;
}

const kRunsForLink = 60e9;  // ns that a session is run for a link in which nothing has run yet

/** Goes to the moment that the address of the page names, if it names one. What has not been yet is run to if the reader asks for it. */
export async function follow_address(): Promise<void> {
  const written = written_in_link(location.hash), ns = moment_of_link(location.hash), newest_ns = state.past?.newest_ns ?? 0;
  if (written === undefined || ns === state.past?.now_ns) return;
  if (ns === undefined) notice(`'${written}' in the address is no moment; write for example #t=15.193ms`, 'error');
  else if (ns > newest_ns && (newest_ns > 0 || ns > kRunsForLink))
    notice(`The address leads to ${moment_text(ns)}, which is still to come: the newest moment is ${moment_text(newest_ns)}. Type it as the moment (g) to run on to it`);
  else await go_to_named(ns);
}

/** Where the page begins, once there is a session. */
async function go_to_begin(): Promise<void> {
  const asked = state.first_moment ?? undefined;
  state.first_moment = null;
  if (written_in_link(location.hash) !== undefined) return follow_address();
  const is_there = asked === undefined || asked === state.past?.now_ns || await go_to(asked);
  await at_first_moment(is_there);
}

/** The inputs and outputs of the program, its symbols and the first bytes of the CPU, as switches and lamps. */
function propose_points(outline: Outline): void {
  if (state.inputs.length > 0 || state.outputs.length > 0) return;
  const first_byte = (area: string): string[] => Array.from({ length: 8 }, (_, bit) => `${area}0.${bit}`);
  const named = [...outline.points, ...outline.symbols.map((one) => one.address.toUpperCase())];
  const points = (area: string): string[] => {
    const all = named.filter((address) => new RegExp(`^${area}\\d+\\.\\d$`).test(address));
    return [...new Set([...first_byte(area), ...all])].sort((a, b) => Number(a.slice(1)) - Number(b.slice(1)));
  };
  state.inputs = points('I').map((address) => ({ address, kind: 'switch', hertz: 10 }));
  state.outputs = points('Q');
}

/** What moves the session was begun by another page, or by a prompt. */
function is_of_others(): boolean {
  return !state.own_run && moving === 0;
}

function others_run(goes_on: boolean): void {
  state.others_run = goes_on;
  state.running = goes_on;
}

/** What a scenario has found begins the trail that leads to its cause. */
function show_found({ found, now }: Hello): void {
  if (found === undefined || state.trail.length > 0) return;
  const [question = '', ...text] = found.trimEnd().split('\n');
  state.trail = [{ question, at_ns: now.now_ns, text: text.map((line) => line.trim()).join('\n'), cause: null }];
  show_pane('causes');
}

export function notified(note: Notification): void {
  switch (note.event) {
    case 'hello':
      if (note.protocol !== kProtocol) notice(`s7200 speaks protocol ${note.protocol}, this page protocol ${kProtocol}: load the page anew`, 'error');
      forget_answers();
      if (is_another(note)) {
        if (state.hello && !the_engine().open) notice('s7200 was started again: this is another session');
        forget_session();
      }
      state.hello = note;
      state.past = note.now;
      others_run(note.running !== undefined);
      show_found(note);
      load_marks();
      void get_acquainted().then(go_to_begin);
      break;
    case 'moved':
      if (is_of_others()) {
        if (!state.running) begin_anew();
        others_run(note.by === '');
      } else if (!state.own_run) {
        state.running = note.by === '';
      }
      came_to(note.now);
      break;
    case 'changed':
      past.refresh();
      stops.refresh();
      refresh_all();
      break;
    case 'running':
      if (!state.running) begin_anew();
      if (is_of_others()) others_run(true);
      break;
    case 'stopped':
      if (is_of_others()) others_run(false);
      break;
    case 'printed':
      print(note.text);
      break;
    case 'ended':
      state.why_ended = note.why;
      state.connection = 'ended';
      others_run(false);
      break;
  }
  changed();
}

const kPrinted = 500;
/** Where it stands and the next instruction are shown elsewhere. */
const kShownElsewhere = /^\s*$|^ *> |^\d+\.\d+ ms  scan \d+/;

function lines_to_say(text: string): string[] {
  return text.split('\n').filter((line) => !kShownElsewhere.test(line));
}

const kLinesOfNotice = 3;

/** A breakpoint, or the CPU gone to STOP: a notice. */
export function say_why_stopped(reply: Reply<Stopped>): void {
  const why = reply.json?.stopped;
  if (why === 'stop point' || why === 'CPU')
    notice(lines_to_say(reply.text).slice(0, kLinesOfNotice).join('\n').trim(), why === 'CPU' ? 'error' : 'info');
}

export function print(text: string): void {
  state.printed.push(...lines_to_say(text));
  if (state.printed.length > kPrinted) state.printed.splice(0, state.printed.length - kPrinted);
  changed();
}

/** Where the session stands; who hears first that it looks at another PLC gets acquainted with that one's program. Returns whether it does. */
function stand_at(now: Past): boolean {
  const is_another = state.past !== null && state.past.station !== now.station;
  state.past = now;
  forget_picture_of_another_end();
  if (is_another) {
    forget_points();
    void get_acquainted();
  }
  return is_another;
}

/** Points, and what was seen of them, are those of a PLC. */
function forget_points(): void {
  state.inputs = [];
  state.outputs = [];
  state.samples.clear();
  state.switched.clear();
  state.selected_line = null;
  forget_pulses();
}

function came_to(now: Past): void {
  if (!stand_at(now)) refresh_all();
  changed();
}

/** Looks at another PLC of a system. */
export async function look_at(station: string): Promise<void> {
  await command(line_of`station ${words(station, 'a name that a command can have: give the station another one')}`);
  const reply = await query<Past>(line_of`past`);
  if (reply.json) came_to(reply.json);
}

let tasks = 0;
let searches = 0;  // queries of searches that are under way

/** What takes long is given up when something else is wanted. Returns whether nothing has been since. */
export function take_over(): () => boolean {
  ++tasks;
  if (searches > 0) the_engine().stop();
  return unless_taken_over();
}

/** The same for what does not begin where the session is on its way to: what moves it ends at once. */
export async function take_over_at_once(): Promise<() => boolean> {
  const is_wanted = take_over();
  if (moving > 0) await run_ended();
  return is_wanted;
}

/** The same for what begins by itself: it ends nothing that the reader wants. */
export function unless_taken_over(): () => boolean {
  const mine = tasks;
  return () => mine === tasks;
}

/** What was said of the moment before is not true of the next one. */
export function begin_anew(): void {
  state.notice = null;
  state.printed = [];
}

let movements = 0;
let pauses = 0;
let moving = 0;  // how many commands of this page are under way that move the session

/** Something moves the session from now on. Returns whether nothing else has begun to since. */
export function begin_to_move(): () => boolean {
  const mine = ++movements;
  state.running = true;
  begin_anew();
  changed();
  return () => mine === movements;
}

/** Ends what goes on, whoever has begun it. */
export function pause(): void {
  ++pauses;
  state.own_run = false;
  if (state.others_run) others_run(false);
  the_engine().stop(true);
}

/** Ends a run: then it is known how far it has come. */
async function run_ended(): Promise<void> {
  pause();
  const reply = await query<Past>(line_of`past`);
  if (reply.json) stand_at(reply.json);
}

/** Carries out something that moves the session, which ends a run; what it says is shown where it stops. */
export async function move<Json = unknown>(line: Command): Promise<Reply<Json>> {
  take_over();
  return move_on<Json>(line);
}

/** The same as a step of something that goes on after it. */
export async function move_on<Json = unknown>(line: Command): Promise<Reply<Json>> {
  if (line instanceof Refused) return refused<Json>(line);
  if (state.own_run || state.others_run) pause();
  const is_last = begin_to_move(), pauses_before = pauses;
  ++moving;
  let reply: Reply<Json>;
  do reply = await taking(ask_in_turn<Json>(line)); while (reply.undone && pauses === pauses_before);
  --moving;
  heard(line, reply);
  say_why_stopped(reply as Reply<any>);
  if (is_last()) state.running = false;
  changed();
  return reply;
}

const kFirstPart = 1e9;  // ns
const kPartTakes = 300;  // ms of the reader's time

/**
 * Runs to a moment or a stop point: an answer to a master's request, at which `continue` ends, is none. An engine that hears of nothing
 * before it is done runs part by part. Returns why it has ended; nothing where there is nothing left to run.
 */
export async function run_to(end_ns: number, is_wanted: () => boolean): Promise<Reply<Stopped> | undefined> {
  const left = (): number => end_ns - (state.past?.now_ns ?? end_ns), pauses_before = pauses;
  let run: Reply<Stopped> | undefined;
  for (let part = the_engine().can_be_stopped ? Infinity : kFirstPart; left() > 0;) {
    const length = Math.min(part, left()), began = performance.now();
    run = await move_on<Stopped>(line_of`continue ${moment_word(length)}`);
    if (pauses !== pauses_before) return { ...run, interrupted: true };
    const goes_on = run.json?.stopped === 'answer' || (length === part && run.json?.stopped === 'limit');
    if (!is_wanted() || run.interrupted || !goes_on) return run;
    part *= Math.min(4, Math.max(0.25, kPartTakes / Math.max(1, performance.now() - began)));
  }
  return run;
}

/** A moment that has not been yet is run to. Returns whether it is there, and nothing else was wanted meanwhile. */
export async function go_to(ns: number): Promise<boolean> {
  const wanted = Math.max(0, Math.round(ns)), is_wanted = await take_over_at_once();
  if (state.own_run || state.others_run) await run_ended();
  if (!is_wanted()) return false;
  if (wanted <= (state.past?.newest_ns ?? 0)) {
    const went = await move_on(line_of`at ${moment_word(wanted)}`);
    return is_wanted() && !went.interrupted;
  }
  if (state.past?.in_the_past && (await move_on(line_of`at end`)).interrupted) return false;
  return is_wanted() && !(await run_to(wanted, is_wanted))?.interrupted && is_wanted();
}

/** Goes to a moment that someone has named. The CPU stands between instructions only: it says so if none begins right then. */
export async function go_to_named(ns: number): Promise<void> {
  if (!await go_to(ns)) return;
  const past = state.past, late_ns = (past?.now_ns ?? 0) - Math.max(0, Math.round(ns));
  if (!past || late_ns <= 0 || state.notice) return;
  const what = past.op === null ? 'the next moment at which the CPU can stand' : 'the next one';
  notice(`No instruction begins at ${moment_text(ns)}: this is ${what}, ${duration_text(late_ns)} later`);
}
