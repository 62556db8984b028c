// What comes in between: answers that are late, a run that goes on, another session. The page's own modules without a browser, with an
// engine that answers when the test lets it.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { beforeEach, test } from 'node:test';
import vm from 'node:vm';

const kFolder = path.join(process.env.SOURCE, 'tools/faces/page/src');
const bundled = (source) => execFileSync('esbuild', ['--bundle', '--format=esm', '--platform=neutral'], { input: source, cwd: kFolder, encoding: 'utf8' });

const kept = new Map();
Object.assign(globalThis, {
  requestAnimationFrame: () => 0, location: { hash: '' }, matchMedia: () => ({ matches: false, addEventListener() {} }), document: { activeElement: null },
  localStorage: { getItem: (name) => kept.get(name) ?? null, setItem: (name, value) => kept.set(name, value) },
});
const kModules = ['state', 'session', 'running', 'pulses', 'causes', 'futures', 'playground', 'engine', 'dom', 'timeline/search', 'timeline/measure', 'timeline/view',
  'panes/chart', 'panes/line', 'panes/side'];
const folder = mkdtempSync(path.join(os.tmpdir(), 'page-'));
writeFileSync(path.join(folder, 'page.mjs'), bundled(kModules.map((one) => `export * from './${one}';`).join('\n')));
const page = await import(path.join(folder, 'page.mjs'));
rmSync(folder, { recursive: true });
const { state } = page;

const rest = (ms = 0) => new Promise((done) => setTimeout(done, ms));

/** It answers when it is told to; what `answers` has a reply for, at once. */
class Engine {
  can_be_stopped = true;
  asked = [];
  all = [];
  answers = {};

  command(line) {
    this.all.push(line);
    const known = Object.entries(this.answers).find(([begin]) => line.startsWith(begin));
    if (known) return Promise.resolve({ text: '', json: null, moved: false, ...(typeof known[1] === 'function' ? known[1](line) : known[1]) });
    return new Promise((done) => this.asked.push({ line, done }));
  }

  stop() {
    this.all.push('stop');
  }

  /** The next question that begins so, answered with that. */
  async answer(begin, reply = {}) {
    for (let i = 0; i < 200; ++i) {
      const at = this.asked.findIndex((one) => one.line.startsWith(begin));
      if (at >= 0) {
        this.asked.splice(at, 1)[0].done({ text: '', json: null, moved: false, ...reply });
        return rest();
      }
      await rest(5);
    }
    assert.fail(`nobody has asked '${begin}', but ${this.asked.map((one) => one.line)}`);
  }

  count(begin) {
    return this.all.filter((line) => line.startsWith(begin)).length;
  }
}

const moment = (now_ns, newest_ns = now_ns) => ({ now_ns, newest_ns, oldest_ns: 0, in_the_past: now_ns < newest_ns, station: '', scan: 1, mode: 'RUN', op: 0, line: 1, routine: 'main', fatal: 0 });
const outline = (lines) => ({ program: 'a', files: [], cpu: '214', lines, ops: 1, routines: [], symbols: [{ name: 'Pump', address: 'Q0.0', comment: '' }], points: [] });
const hello = (now = moment(0), more = {}) => ({ event: 'hello', protocol: 1, version: '', program: 'a', cpu: '214', stations: [], may: [], live: false, now, ...more });
const moved = (now, by = 'x') => page.notified({ event: 'moved', now, by });

let engine;
const kSpans = { json: { from_ns: 0, to_ns: 0, tracks: [] } };
/** A session that stands somewhere, whose panes have what they ask for at once. */
async function begin(now = moment(0), more = {}) {
  engine = new Engine();
  engine.answers = { listing: (line) => ({ json: line === 'listing' ? outline(1000) : { text: [] } }), help: {}, status: { json: { lines: [], since_ns: 0 } }, values: { json: { at_ns: 0, values: [] } }, spans: kSpans, past: { json: now },
    actions: { json: { count: 0, actions: [] } } };
  engine.answers['break'] = { json: { stops: [] } };
  page.use_engine(engine);
  Object.assign(state, { hello: null, past: null, outline: null, chart: [], notice: null, pane: 'program', side: 'chart', pace: 1, dialog: null, menu: null, connection: 'connected' });
  page.notified(hello(now, more));
  await rest(5);
  engine.all = [];
}
beforeEach(() => begin());

/** The first element with such attributes. */
function find(part, is) {
  if (typeof part !== 'object' || part === null) return undefined;
  return is(part.attributes) ? part : part.children.map((one) => find(one, is)).find((one) => one);
}

test('a row of the chart that is several values takes no other row with it', async () => {
  const value = (name, number) => ({ name, address: name, symbol: '', type: 'byte', text: `${number}`, number, forced: false });
  engine.answers.values = { json: { at_ns: 5, values: [value('VB0:4', 1), value('VB0:4', 2), value('VB0:4', 3), value('VB0:4', 4), value('VB9', 9)] } };
  state.chart = ['VB0:4', 'VB9'].map((address) => ({ address, format: 'signed', new_value: '' }));
  page.see_values();
  await rest();
  assert.equal(state.values.get('VB9').number, 9);
  assert.match(state.values.get('VB0:4').error, /several values/);
  assert.deepEqual([...state.samples.keys()], ['VB9']);
  engine.answers.values = { json: { at_ns: 6, values: [value('VB9', 9)] } };
  page.see_values();
  await rest();
  assert.deepEqual([...state.samples.keys()], ['VB9'], 'what is shown no more has no trend');
});

test('what begins by itself leaves the reader where he has gone meanwhile', async () => {
  let may_go;
  page.when_begun(async (may) => { may_go = may; });
  for (const reader of [() => {}, () => void page.move('at start')]) {
    state.first_moment = 50;
    page.notified(hello(moment(0, 100)));
    await rest(5);
    reader();
    await engine.answer('at 50ns');
    assert.equal(may_go, engine.asked.length === 0);
  }
  await engine.answer('at start');
  page.when_begun(async () => {});
});

test('a row that would be a comment is not asked for', async () => {
  state.chart = ['#', 'VB0//x', 'VB9', '"a // b"', '#level'].map((address) => ({ address, format: 'signed', new_value: '' }));
  page.see_values();
  await rest();
  assert.match(engine.all.at(-1), /^values VB9 "a \/\/ b" #level I/);
});

test('what a stop has dropped is carried out after it', async () => {
  const done = page.command('input I0.0=1');
  await engine.answer('input', { interrupted: true, undone: true });
  await engine.answer('input', { json: {} });
  assert.equal((await done).undone, undefined);
});

test('as fast as it goes a command is carried out at once, and the run goes on', async () => {
  state.pace = 0;
  const run = page.run();
  await rest();
  void page.command('input I0.0=1');
  void page.command('input I0.1=1');
  assert.deepEqual(engine.all, ['continue 50000000ns', 'stop', 'input I0.0=1', 'input I0.1=1']);
  await engine.answer('continue', { interrupted: true, json: { stopped: 'request' } });
  assert.equal(state.running, true);
  assert.equal(engine.count('continue'), 2);
  page.pause();
  await engine.answer('continue', { interrupted: true, json: { stopped: 'request' } });
  await run;
  assert.equal(state.running, false);
});

test('a run that is paused and begun again is one run', async () => {
  void page.run();
  await rest();
  page.pause();
  moved(moment(10), 'continue 10ns');
  void page.run();
  await engine.answer('continue', { json: { stopped: 'limit' } });
  assert.deepEqual([state.own_run, state.running], [true, true], 'the end of the first does not end the second');
  await rest(120);
  assert.equal(engine.asked.filter((one) => one.line.startsWith('continue')).length, 1);
  page.pause();
  await engine.answer('continue', { json: { stopped: 'limit' } });
});

test('to go elsewhere ends a run, at once', async () => {
  state.pace = 0;
  void page.run();
  await rest();
  void page.go_to(0);
  await engine.answer('continue', { interrupted: true, json: { stopped: 'request' } });
  await rest();
  assert.deepEqual(engine.all.filter((line) => !/^(past|status|values|spans)/.test(line)), ['continue 50000000ns', 'stop', 'at 0ns']);
  assert.deepEqual([state.own_run, state.running], [false, true], 'it is on its way');
  await engine.answer('at');
  assert.equal(state.running, false);
  void page.run();
  await rest();
  void page.move('at start');
  await engine.answer('continue', { json: { stopped: 'limit' } });
  await engine.answer('at start');
  await rest(80);
  assert.deepEqual(engine.asked, [], 'and it does not go on from there');
});

test('pulses wait while a session that follows the clock stands', async () => {
  await begin(moment(0), { live: true });
  engine.answers.input = { json: {} };
  const row = { address: 'I0.0', kind: 'pulses', hertz: 1000 };
  await page.toggle_pulses(row);
  await rest(30);
  assert.equal(engine.count('input'), 0);
  state.running = true;
  await rest(150);
  assert.ok(engine.count('input') > 10);
  moved(moment(5, 10));
  engine.all = [];
  await rest(100);
  assert.equal(engine.count('input'), 0, 'in the past it would begin another future');
  await page.toggle_pulses(row);
});

test('pulses that take longer than their period do not pile up', async () => {
  await begin(moment(0), { live: true });
  state.running = true;
  const row = { address: 'I0.0', kind: 'pulses', hertz: 1000 };
  await page.toggle_pulses(row);
  await rest(50);
  assert.equal(engine.asked.length, 1);
  engine.answers.input = { json: {} };
  await engine.answer('input');
  await page.toggle_pulses(row);
});

test('lines that are under way are waited for', async () => {
  await begin();
  delete engine.answers.listing;
  let here = false;
  void page.fetch_chunk_of(500);
  void page.fetch_chunk_of(501).then(() => { here = true; });
  await rest();
  assert.equal(here, false);
  await engine.answer('listing 400 599', { json: { text: [{ line: 501, text: 'LD I0.0', op: 1 }] } });
  assert.equal(here, true);
  assert.equal(engine.count('listing'), 1);
});

test('lines that were asked for by an earlier outline are asked for again', async () => {
  await begin();
  delete engine.answers.listing;
  page.notified(hello(moment(0), { program: 'b' }));
  void page.fetch_chunk_of(900);
  await engine.answer('listing', { json: outline(2000) });
  await engine.answer('listing 800 999', { json: { text: [{ line: 900, text: 'old', op: 1 }] } });
  void page.fetch_chunk_of(900);
  assert.equal(state.lines.has(900), false);
  await engine.answer('listing 800 999', { json: { text: [{ line: 900, text: 'new', op: 1 }] } });
  assert.equal(state.lines.get(900).text, 'new');
});

test('another session ends what the one before looked for', () => {
  const is_wanted = page.take_over();
  page.notified(hello(moment(0), { program: 'c' }));
  assert.equal(is_wanted(), false);
});

test('a future is run past answers, and is as long as it was run', async () => {
  engine.answers.spans = { json: { from_ns: 0, to_ns: 70, tracks: [] } };
  void page.compare_futures();
  void page.compare_futures();
  await engine.answer('continue 200000000ns', { json: { stopped: 'answer' } });
  moved(moment(70));
  await engine.answer('continue', { json: { stopped: 'stop point' } });
  assert.equal(engine.count('continue'), 2);
  await engine.answer('at 0ns');
  assert.equal(state.first_future.until_ns, 70);
  state.first_future = null;
});

test('a future is not kept where something else was wanted meanwhile', async () => {
  void page.compare_futures();
  await rest();
  page.take_over();
  await engine.answer('continue', { json: { stopped: 'limit' } });
  assert.equal(state.first_future, null);
  assert.equal(engine.count('at'), 0);
});

test('a moment that is yet to come is run to past answers', async () => {
  const there = page.go_to(100);
  await engine.answer('continue 100ns', { json: { stopped: 'answer' } });
  moved(moment(60));
  await engine.answer('continue', { json: { stopped: 'answer' } });
  moved(moment(100));
  await engine.answer('continue', { json: { stopped: 'limit' } });
  assert.equal(await there, true);
});

const kHour = 3600e9;
/** The moves and stops, without what panes ask for. */
const asked = () => engine.all.filter((line) => !/^(past|status|values|spans|actions)/.test(line));

test('a moment that is wanted during a long go-to is gone to at once, from where that has come to', async () => {
  void page.go_to(20 * kHour);
  await rest();
  moved(moment(50), '');
  engine.answers.past = { json: moment(60) };
  const there = page.go_to_named(1000);
  await engine.answer('continue', { interrupted: true, json: { stopped: 'request' } });
  await rest();
  assert.deepEqual(asked(), ['continue 72000000000000ns', 'stop', 'continue 940ns']);
  moved(moment(1000));
  await engine.answer('continue', { json: { stopped: 'limit' } });
  await there;
  assert.equal(state.notice, null);
});

test('a go-to that is paused says nothing of moments', async () => {
  const there = page.go_to_named(1000);
  await rest();
  page.pause();
  await engine.answer('continue', { interrupted: true, json: { stopped: 'request' } });
  moved(moment(500, 2000));
  await there;
  assert.equal(state.notice, null);
  const back = page.go_to_named(10);
  await rest();
  page.pause();
  await engine.answer('at', { interrupted: true, undone: true });
  await back;
  assert.equal(state.notice, null);
  assert.equal(engine.count('at'), 1, 'it was paused');
});

test('a step and a command wait for a short go-to, and end a long one', async () => {
  for (const [line, ask] of [['scan', () => page.move('scan')], ['input', () => page.command('input I0.0=1')]]) {
    await begin();
    void page.go_to(20 * kHour);
    await rest();
    const done = ask();
    await rest(300);
    assert.equal(engine.count('stop'), 0);
    await rest(1000);
    assert.ok(engine.count('stop') > 0);
    await engine.answer('continue', { interrupted: true, json: { stopped: 'request' } });
    await engine.answer(line, { interrupted: true, undone: true });
    await engine.answer(line, { json: {} });
    assert.equal((await done).undone, undefined, line);
  }
});

test('what is wanted during a search ends it', async () => {
  await begin(moment(0, 100 * kHour));
  delete engine.answers.spans;
  const search = page.find_unanswered();
  await rest();
  void page.move('scan');
  assert.deepEqual(asked(), ['stop', 'scan']);
  const { length } = engine.asked;
  await engine.answer('spans 1ns', { interrupted: true, ...kSpans });
  await search;
  assert.equal(engine.asked.length, length - 1, 'and it is not begun again');
  await engine.answer('scan');
});

test('an engine that hears of nothing meanwhile runs to a moment part by part', async () => {
  engine.can_be_stopped = false;
  const there = page.go_to(kHour);
  await engine.answer('continue 1000000000ns', { json: { stopped: 'limit' } });
  page.pause();
  moved(moment(5e9));
  await engine.answer('continue', { json: { stopped: 'limit' } });
  assert.equal(await there, false);
  assert.equal(engine.count('continue'), 2);
});

/** The CPU stands a little after what is gone to. */
const kLate = 7;
const stands_late = (newest_ns) => {
  engine.answers.at = (line) => {
    moved(moment(Number(/\d+/.exec(line)[0]) + kLate, newest_ns), line);
    return {};
  };
};
const in_part = (line, spans) => {
  const [from, to] = line.match(/\d+/g).map(Number);
  return spans.filter((one) => one.at_ns <= to && one.end_ns >= from);
};
/** Where each step of a search comes to, until it stays. */
async function places(search) {
  const all = [];
  for (let i = 0; i < 5; ++i) {
    const before = state.past.now_ns;
    await search();
    if (state.past.now_ns === before) break;
    all.push(state.past.now_ns - kLate);
  }
  return all;
}

test('errors are walked through one by one, forwards and back', async () => {
  const errors = [200, 500, 503, 900].map((at_ns) => ({ at_ns, end_ns: at_ns, text: 'lost', error: 'lost' }));
  await begin(moment(0, 1000));
  engine.answers.spans = (line) => ({ json: { from_ns: 0, to_ns: 1000, tracks: [{ kind: 'errors', name: 'errors', exact: true, spans: in_part(line, errors) }] } });
  stands_late(1000);
  assert.deepEqual(await places(() => page.find_error(1)), [200, 500, 503, 900]);
  assert.match(state.notice.text, /after this moment/);
  assert.deepEqual(await places(() => page.find_error(-1)), [503, 500, 200]);
  assert.match(state.notice.text, /before this moment/);
});

test('requests without an answer are walked through one by one, from within one too', async () => {
  const frames = [100, 400, 700].map((at_ns) => ({ at_ns, end_ns: at_ns + 50, text: 'received 01 03: station 1: read holding registers' }));
  await begin(moment(0, 5e9));
  engine.answers.spans = (line) => ({ json: { from_ns: 0, to_ns: 5e9, tracks: [{ kind: 'frames', name: 'port 0', exact: true, spans: in_part(line, frames) }] } });
  stands_late(5e9);
  assert.deepEqual(await places(page.find_unanswered), [100, 400, 700]);
  assert.equal(state.notice.text, 'No unanswered request after this moment');
  moved(moment(120, 5e9));
  assert.deepEqual(await places(page.find_unanswered), [400, 700]);
});

test('of a report that is run on beyond its end only what is new is computed, and all of it in another future', async () => {
  const track = (at_ns) => ({ kind: 'scans', name: 'scans', exact: false, spans: [{ at_ns, end_ns: at_ns + 5, text: `scan ${at_ns}` }] });
  state.picture = { from_ns: 0, to_ns: 1e6, tracks: [track(0)] };
  await begin(moment(1e6));
  const spans = () => engine.all.filter((line) => line.startsWith('spans'));
  moved(moment(5e5, 1e6));
  page.zoom_by(1);
  await rest();
  assert.deepEqual(spans(), []);
  assert.equal(state.spans, state.picture);
  const later = [999e3, 1000500].flatMap((at_ns) => track(at_ns).spans);
  engine.answers.spans = { json: { from_ns: 1e6, to_ns: 1001e3, tracks: [{ ...track(0), spans: later }] } };
  moved(moment(1001e3));
  page.zoom_by(1);
  await rest();
  assert.deepEqual(spans(), ['spans 1000000ns 1001000ns 3000']);
  assert.deepEqual(state.spans.tracks[0].spans.map((one) => one.at_ns), [0, 1000500]);
  moved(moment(5e5));
  page.zoom_by(1);
  await rest();
  assert.equal(state.picture, null);
  assert.equal(spans().at(-1), 'spans 0ns 500000ns 3000');
});

test('a search for a condition that is paused says nothing of the condition', async () => {
  for (const end of [{ interrupted: true, json: { stopped: 'request' } }, { error: 'no', json: null }, { json: { stopped: 'CPU' }, text: 'STOP' }]) {
    await begin();
    engine.answers['break VW0'] = engine.answers.break = { json: { stops: [{ number: 3 }] } };
    const found = page.find_condition('VW0 > 5');
    await engine.answer('continue', end);
    await engine.answer('delete 3');
    await found;
    assert.doesNotMatch(state.notice?.text ?? '', /does not come to hold/);
  }
});

test('a measurement does not open over a dialog or after something else', async () => {
  await begin(moment(100));
  delete engine.answers.spans;
  for (const meanwhile of [() => page.show_dialog('help'), () => page.take_over()]) {
    const measured = page.measure();
    meanwhile();
    await engine.answer('spans', kSpans);
    await measured;
    assert.notEqual(state.dialog, 'measurement');
    state.dialog = null;
  }
});

test('a late answer to why leaves the pane that was chosen meanwhile', async () => {
  const asked = page.ask_why();
  page.show_pane('line');
  await engine.answer('why', { text: 'so' });
  await asked;
  assert.equal(state.side, 'line');
  engine.answers.why = { text: 'so' };
  for (let i = 0; i < 210; ++i) await page.ask_why();
  assert.equal(state.side, 'causes');
  assert.equal(state.trail.length, 200);
});

test('the line is listed anew for another future and another session', async () => {
  await begin(moment(100, 200));
  const spans = () => engine.all.filter((line) => line.startsWith('spans') && line.includes(' 20000')).length;
  page.see_exchanges();
  page.see_exchanges();
  await rest();
  assert.equal(spans(), 1);
  moved(moment(100, 100));
  page.see_exchanges();
  await rest();
  assert.equal(spans(), 2, 'another future begins here');
  page.notified(hello(moment(100)));
  page.see_exchanges();
  await rest();
  assert.equal(spans(), 3);
  assert.notEqual(state.exchanges, null);
});

test('what was sent waits for Run in its own session only', async () => {
  state.send_text = '01';
  find(page.line_pane(), (one) => one.class === 'send').attributes.onsubmit({ preventDefault() {} });
  await engine.answer('send 01');
  assert.ok(find(page.line_pane(), (one) => one.class === 'waits'));
  page.notified(hello());
  assert.equal(find(page.line_pane(), (one) => one.class === 'waits'), undefined);
});

test('a value that is typed while another is being written stays', async () => {
  state.chart = [{ address: 'VB0', format: 'signed', new_value: '5' }];
  find(page.chart_pane(), (one) => one.class === 'new-value').attributes.onkeydown({ key: 'Enter' });
  state.chart[0].new_value = '67';
  await engine.answer('set VB0=5', { json: {} });
  assert.equal(state.chart[0].new_value, '67');
});

test('a chart that was kept in another format is signed', () => {
  kept.set('s7200.chart', JSON.stringify([{ address: 'VB0', format: 'unknown' }, { address: 'VB1', format: 'hex' }, null, { format: 'hex' }]));
  page.load_chart();
  assert.deepEqual(state.chart.map((row) => row.format), ['signed', 'hex']);
});

test('symbols are proposed wherever an address is asked for', () => {
  for (const side of ['chart', 'causes']) {
    state.side = side;
    assert.ok(find(page.side_pane(), (one) => one.list === 'symbols') && find(page.side_pane(), (one) => one.id === 'symbols'), side);
  }
});

test('a program that is typed on while it is checked stays open, and what is dropped meanwhile is read', async () => {
  let opened;
  engine.open = () => new Promise((done) => { opened = done; });
  state.sources = [{ name: 'a.awl', text: 'LD I0.0' }];
  const open = page.open_program();
  const dropped = { name: 'b.txt', text: '?', hex: 'ff' };
  state.sources = [{ name: 'a.awl', text: 'LD I0.0\n= Q0.0' }, dropped];
  opened({ text: '', json: { opened: true, text: '', diagnostics: [], cpu: '214' } });
  await open;
  assert.equal(state.opening, true);
  assert.deepEqual(state.sources[1], dropped);
  state.sources = [];
});

/** The worker with a module that fails at its first message. */
async function failing_worker() {
  const thrown = [];
  const self = { postMessage() {}, location: { href: 'http://a/' } };
  const exports = { memory: { buffer: new ArrayBuffer(64) }, _initialize() {}, room: () => 0, take() { throw new Error('unreachable'); }, next: () => -1, message: () => 0 };
  vm.runInNewContext(bundled("import './worker';").replace(/^export \{\};?$/m, ''), {
    self, TextEncoder, TextDecoder, Uint8Array, DataView, URL, fetch: async () => ({ arrayBuffer: async () => new ArrayBuffer(0) }),
    WebAssembly: { instantiate: async () => ({ instance: { exports } }) },
    setTimeout: (does) => { try { does(); } catch (error) { thrown.push(error.message); } },
  });
  self.onmessage({ data: '{}' });
  await rest(20);
  return thrown;
}

test('an engine that fails is an error of its worker, and what is asked after it has an answer', async () => {
  assert.deepEqual(await failing_worker(), ['unreachable']);
  let worker;
  globalThis.Worker = class { constructor() { worker = this; } postMessage() {} };
  const states = [];
  const one = new page.WorkerEngine('x', { notified() {}, connection: (now) => states.push(now) });
  const before = one.command('step');
  worker.onerror({ message: 'unreachable' });
  for (const reply of [await before, await one.command('step')]) assert.match(reply.error, /has failed: unreachable/);
  assert.deepEqual(states, ['connected', 'ended']);
});
