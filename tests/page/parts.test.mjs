// The page's own reckoning, without a browser: moments, formats, exchanges, scales, addresses with a program in them.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';

const kParts = ['state', 'words', 'commands', 'formats', 'exchanges', 'files', 'status_charts', 'causes', 'timeline/draw', 'timeline/scale', 'timeline/measure'];
const source = kParts.map((one) => `export * from './${one}';`).join('\n');
const bundle = execFileSync('esbuild', ['--bundle', '--format=esm', '--platform=neutral'],
  { input: source, cwd: path.join(process.env.SOURCE, 'tools/faces/page/src'), encoding: 'utf8' });
const folder = mkdtempSync(path.join(os.tmpdir(), 'page-'));
writeFileSync(path.join(folder, 'parts.mjs'), bundle);
const parts = await import(path.join(folder, 'parts.mjs'));
rmSync(folder, { recursive: true });

test('moments are read in every unit that a command takes, and written so that none is rounded', () => {
  const read = { '15.193ms': 15193000, '2 s': 2e9, '1h': 3600e9, '20 min': 1200e9, '7,5ms': 7500000, '250us': 250000, '5ns': 5, '13:30': 48600e9, '0:01:30,5': 90.5e9 };
  for (const [text, ns] of Object.entries(read)) assert.equal(parts.moment_from(text), ns, text);
  for (const text of ['', '5', 'ms', '-1ms', '1 day', '1:60', '1:2', '0:01:60']) assert.equal(parts.moment_from(text), undefined, text);
  assert.equal(parts.moment_text(102605583), '102.605583 ms');
  assert.equal(parts.moment_text(123456789000), '123.456789 s');
  assert.equal(parts.moment_word(102605583), '102605583ns');
  for (const ns of [0, 1, 15193000, 102605583, 86400e9]) assert.equal(parts.moment_of_link(parts.link_of(ns)), ns);
  assert.equal(parts.moment_of_link('#p=abc&t=5ms'), 5000000);
  for (const none of ['#other', '#t=%', '#t=%ff']) assert.equal(parts.moment_of_link(none), undefined, none);
});

test('marks of a day are hours and minutes, as far apart as those of a clock', () => {
  const scale = (hours) => ({ from_ns: 0, to_ns: hours * 3600e9, left: 0, right: 1100 });
  assert.deepEqual([24, 6, 1, 1 / 60, 24 * 30].map((hours) => parts.step_of(scale(hours), 110) / 1e9), [10800, 3600, 600, 10, 5 * 86400]);
  assert.equal(parts.clock_text(48600e9, 'minutes'), '13:30');
  assert.equal(parts.clock_text(90e9, 0), '0:01:30');
  assert.equal(parts.moment_from(parts.clock_text(86399e9, 0)), 86399e9);
});

test('a moment after an hour is that of a clock, and can be typed', () => {
  assert.equal(parts.moment_text(3599999999000), '3599.999999 s');
  assert.equal(parts.moment_text(43200000250000), '12:00:00.000250');
  assert.equal(parts.moment_text(3599999999999), '3600.000000 s');
  assert.equal(parts.moment_text(7199999999999), '2:00:00.000000');
  assert.equal(parts.moment_from('12:00:00.000250'), 43200000250000);
});

test('what the session says has its times as the page writes them', () => {
  const said = { '43200000.000 ms passed': '12:00:00.000000 passed', 'stopped at 599999.913600 ms,': 'stopped at 599.999914 s,',
    'after 15.464 ms': 'after 15.464 ms', 'at 210.020664 ms': 'at 210.020664 ms', 'it took 12.5 us': 'it took 12.5 µs', 'send 75 73 us': 'send 75 73 µs', 'VW5 users': 'VW5 users' };
  for (const [text, text_here] of Object.entries(said)) assert.equal(parts.with_times(text), text_here);
});

/** What is drawn on a canvas: texts, and the lines of each stroke in their colour. */
function drawn(view) {
  const texts = [], lines = [], rects = [];
  let from, path = [];
  const c = { texts, lines, measureText: (text) => ({ width: 6 * text.length }), fillText(text, x, y) { texts.push({ text, x, y, colour: this.fillStyle }); }, beginPath: () => { path = []; },
    moveTo: (x, y) => { from = [x, y]; }, lineTo: (x, y) => { path.push([from, [x, y]]); from = [x, y]; }, stroke() { for (const line of path) lines.push({ colour: this.strokeStyle, line }); } };
  c.fillRect = function (x, y, width, height) { rects.push({ colour: this.fillStyle, x, y, width, height }); };
  for (const name of ['strokeRect', 'fill']) c[name] = () => {};
  parts.draw(c, { now_ns: 0, newest_ns: view.scale.to_ns, cursors: { a_ns: null, b_ns: null }, marks: [], selected: null, ...view }, new Proxy({}, { get: (_none, name) => name }));
  return { texts, lines, rects };
}

test('late in a run the ruler counts seconds, then as a clock', () => {
  const marks = (from_ns, to_ns) => drawn({ scale: { from_ns, to_ns, left: 0, right: 1200 }, rows: [], width: 1200, height: 200 }).texts.map((one) => one.text);
  assert.equal(marks(599.8e9, 600e9)[1], '599.82 s');
  assert.equal(marks(43200e9, 43200.2e9)[1], '12:00:00.02');
  assert.equal(marks(0, 200e6)[1], '20 ms');
});

test('what an interrupt has waited is drawn above its track, not over the words in it', () => {
  const spans = [{ at_ns: 0, end_ns: 60, text: 'INT 0: event 10 (timed interrupt 0)' }, { at_ns: 70, end_ns: 100, occurred_ns: 30, text: 'INT 0: event 10' }];
  const rows = parts.rows_of({ tracks: [{ kind: 'interrupts', name: 'INT 0', exact: true, spans }] }, 0);
  const { texts, lines } = drawn({ scale: { from_ns: 0, to_ns: 100, left: 0, right: 1000 }, rows, width: 1000, height: 200 });
  const words = texts.find((one) => one.text.startsWith('INT 0')), waits = lines.filter((one) => one.colour === 'wait');
  assert.ok(waits.some(({ line: [a, b] }) => a[0] === 300 && b[0] === 700), 'from the event to its interrupt');
  for (const { line } of waits) for (const [, y] of line) assert.ok(y < words.y - 4.5, `${y} is above the letters at ${words.y}`);
});

test('what differs is marked from where it is in view to its end, and no further', () => {
  const spans = [{ at_ns: -500, end_ns: 50, text: '', value: 0, differs: true }, { at_ns: 50, end_ns: 90, text: '', value: 1 }];
  const rows = parts.rows_of({ tracks: [{ kind: 'value', name: 'Q0.0', exact: true, spans }] }, 0);
  const { rects } = drawn({ scale: { from_ns: 0, to_ns: 100, left: 0, right: 1000 }, rows, width: 1000, height: 200 });
  assert.deepEqual(rects.filter((one) => one.colour === 'cursor').map(({ x, width }) => [x, width]), [[0, 500]]);
  const [row] = rows, ended = [{ ...row, track: { ...row.track, spans: [{ ...spans[0], differs_until_ns: 20 }, spans[1]] } }];
  assert.deepEqual(drawn({ scale: { from_ns: 0, to_ns: 100, left: 0, right: 1000 }, rows: ended, width: 1000, height: 200 }).rects.filter((one) => one.colour === 'cursor').map(({ x, width }) => [x, width]), [[0, 200]],
    'to the end of the other future');
});

test('the numbers of the ruler make room for cursors and the present, on the side of them where their line is', () => {
  const scale = { from_ns: 0, to_ns: 1000, left: 0, right: 1000 }, none = { a_ns: null, b_ns: null };
  const at = (now_ns, cursors = none) => drawn({ scale, rows: [], width: 1000, height: 200, now_ns, cursors }).texts.find((one) => one.text === '0.4 µs')?.x;
  const width = 36;
  assert.equal(at(950), 403.5);
  assert.ok(at(950, { a_ns: 395, b_ns: null }) > 395 + 13, 'right of a cursor that is left of the line, whose letter covers it');
  for (const ns of [401, 404, 420]) {
    const x = at(950, { a_ns: ns, b_ns: null });
    assert.ok(x > 320 && x + width < 400, `a cursor at ${ns} is right of the line, its number at ${x}`);
  }
  for (const ns of [401, 410]) assert.ok(at(ns) + width < Math.min(400, ns - 5), `the present at ${ns}`);
  assert.equal(at(404, { a_ns: 380, b_ns: null }), undefined, 'there is no room on either side');
});

test('the name of a network without power flow, which is pale, is dark', () => {
  const spans = [0, 1].map((value) => ({ at_ns: 50 * value, end_ns: 50 * value + 50, text: `network ${value}`, value }));
  const rows = parts.rows_of({ tracks: [{ kind: 'networks', name: 'networks', exact: true, spans }] }, 0);
  const { texts } = drawn({ scale: { from_ns: 0, to_ns: 100, left: 0, right: 1000 }, rows, width: 1000, height: 200 });
  assert.deepEqual(texts.filter((one) => one.text.startsWith('network')).map((one) => one.colour), ['text', 'on-colour']);
});

test('durations are said in the unit that fits', () => {
  const said = { 0: '0 ns', 3200: '3.2 µs', 20830000: '20.83 ms', 37251712: '37.252 ms', 1500000000: '1.5 s', 90000000000: '1.5 min' };
  for (const [ns, text] of Object.entries(said)) assert.equal(parts.duration_text(Number(ns)), text);
});

test('a value is the same bits in every format', () => {
  const word = { type: 'word', number: -2, text: '-2' };
  const said = { signed: '-2', unsigned: '65534', hex: '16#FFFE', binary: '2#1111_1111_1111_1110', ascii: "'..'" };
  for (const [format, text] of Object.entries(said)) assert.equal(parts.text_in(word, format), text);
  assert.equal(parts.text_in({ type: 'byte', number: 200, text: '200' }, 'signed'), '200', 'a byte has no sign');
  assert.equal(parts.text_in({ type: 'bit', number: 1, text: '1' }, 'hex'), '2#1');
  assert.equal(parts.text_in({ type: 'real', number: 1.5, text: '1.5' }, 'hex'), '16#3FC00000');
  assert.equal(parts.text_in({ type: 'dword', number: -1, text: '-1' }, 'hex'), '16#FFFFFFFF');
  assert.equal(parts.query_of('VD20', 'real'), 'VD20:real');
  assert.equal(parts.query_of('VD20', 'hex'), 'VD20');
});

test('listing and ladder show a value in the format that the chart has for it', () => {
  parts.state.chart = [{ address: 'VW2', format: 'hex' }, { address: 'Level', format: 'binary' }, { address: 'VD8', format: 'real' }, { address: 'T37', format: 'unsigned' }];
  parts.state.values = new Map([['Level', { address: 'VB0' }]]);
  assert.equal(parts.in_formats('VB0=16#C8 Speed:VW2=16#FFFB'), 'VB0=2#1100_1000 Speed:VW2=16#FFFB');
  assert.equal(parts.in_formats('VW100=16#FFFB VD8=16#3FC00000 (1.5) VD12=16#3FC00000 (1.5) I0.0=1'), 'VW100=-5 VD8=1.5 VD12=1.5 I0.0=1');
  assert.equal(parts.operand_text('VW2', -5, 'S0=1 VW2=16#FFFB'), '16#FFFB');
  assert.equal(parts.operand_text('VB0', 200, 'S0=1 Level:VB0=16#C8'), '2#1100_1000');
  assert.equal(parts.operand_text('VW100', -5, 'S0=1 VW100=16#FFFB'), '-5');
  assert.equal(parts.operand_text('I0.0', true, 'S0=1 I0.0=1'), '1');
  parts.state.chart = [];
});

const symbols = (...names) => ({ symbols: names.map((name, i) => ({ name, address: `M0.${i}`, comment: '' })) });

test('only one word or a symbol is asked for, a symbol in quotation marks', () => {
  for (const good of ['VW100', 'Pump', '"Level low"', '"a; quit"', '*VD4', '#level', "in's", '"a":real']) assert.equal(parts.word_of(good), good);
  for (const bad of ['', '#', 'VW1 VW2', 'VW1; quit', '"open', 'a"b', '//', '/x', 'VB0//x', "'", "'VB0", '"a" "b"', '"a\\"', 'VB0\nVB1', 'VB0\u0001']) assert.equal(parts.word_of(bad), undefined, bad);
  parts.state.outline = symbols('Level low', 'a; quit', 'all', 'x"; quit', 'y\\', 'Q1.0');
  const asked = (...names) => names.map(parts.word_of);
  assert.deepEqual(asked(' level LOW ', 'a; quit', 'ALL', 'Q1.0', 'b; quit'), ['"Level low"', '"a; quit"', '"all"', 'Q1.0', undefined]);
  assert.deepEqual(asked('x"; quit', 'y\\'), ['M0.3', 'M0.4'], 'no quotation could hold the name');
  assert.equal(parts.query_of('Level low', 'real'), '"Level low":real');
  parts.state.outline = null;
});

test('a command is one command, whatever is typed into it', () => {
  const { line_of, words, value } = parts, is = (text) => words(text, 'a condition');
  assert.equal(line_of`break ${is(' "a; b" > 5 and VW0 = 2 ')}`, 'break "a; b" > 5 and VW0 = 2');
  assert.equal(line_of`send ${is("'a;b\\';c' crc")}`, "send 'a;b\\';c' crc");
  for (const bad of ['VW0 > 5; quit', '; quit', 'VW0 // x', '// x', 'VW0 # x', '#', '"open', "it's 'open", "'a'; quit", "x'; quit", "'a\\'; quit", 'VW0\nquit'])
    assert.match(line_of`break ${is(bad)}`.why ?? '', /is not a condition$/, bad);
  assert.deepEqual(['- 5', '16#FF', "'a b'", '1;quit', '1\u0000', ''].map((one) => String(line_of`set ${'VW0'}=${value(one)}`.why ?? line_of`set ${'VW0'}=${value(one)}`).slice(0, 15)),
    ['set VW0=-5', 'set VW0=16#FF', "''a b'' is not a", "'1;quit' is not", "'1\u0000' is not a value", "'' is not a val"].map((one) => one.slice(0, 15)));
  assert.deepEqual({ ...line_of`why not ${'VW0; quit'}` }, { kind: 'why', why: "'VW0; quit' is not an address or a symbol; write for example Q0.1, VW100 or T37" });
});

const frame = (text, at_ns, end_ns, more) => ({ text, at_ns, end_ns, ...more });
const frames = (...spans) => ({ tracks: [{ kind: 'frames', name: 'port 0 frames', exact: true, spans }] });

test('an answer belongs to the request before it, and its latency counts from the end of that', () => {
  const [one] = parts.exchanges_of(frames(frame('received 01 03', 10, 20), frame('sent 01 83', 50, 60)), 100);
  assert.deepEqual([one.request, one.answer, one.latency_ns], ['01 03', '01 83', 30]);
});

test('a request that is late may be asked about before its time is over', () => {
  const after = (ms) => parts.exchanges_of(frames(frame('received 01 03', 0, 20)), 20 + ms * 1e6)[0];
  assert.ok(!parts.is_overdue(after(50)));
  assert.ok(parts.is_overdue(after(150)) && !parts.is_unanswered(after(150)));
  assert.ok(parts.is_unanswered(after(1500)));
});

test('an answer to a request before the part that is looked at is no request', () => {
  const asked = 'received 01 06: station 1: write single register', part = (...spans) => ({ ...frames(...spans), from_ns: 5 });
  for (const first of ['sent 01 03 04: an answer of station 1', 'received 01 83: an answer of station 1', 'sent 01 06: station 1: write single register']) {
    const all = parts.exchanges_of(part(frame(first, 10, 20), frame(asked, 50, 60), frame('sent 01 06: written', 70, 80)), 100);
    assert.deepEqual(all.map((one) => [one.sent, one.answer]), [[false, '01 06: written']], first);
  }
  const master = parts.exchanges_of(part(frame('sent 01 06: station 1: write single register', 10, 20), frame('received 01 06: written', 30, 40)), 100);
  assert.deepEqual(master.map((one) => [one.sent, one.answer]), [[true, '01 06: written']]);
});

test('a frame that is text has it beside its bytes', () => {
  assert.equal(parts.with_text('48 45 4c 4c 4f 0d'), "48 45 4c 4c 4f 0d  'HELLO\\r'");
  for (const other of ['01 03 00 0a', '4f', '48 49: station 72: function 73', '']) assert.equal(parts.with_text(other), other);
});

test('what all PLCs of a line hear is one request: of the one that answers', () => {
  const of = (station, ...spans) => ({ kind: 'frames', name: 'port 0 frames', station, exact: true, spans });
  const two = '02 03: station 2: read holding registers', answer = '02 03 04 00 00 aa bb', nine = '09 03: station 9: read holding registers';
  const hears = (station) => of(station, frame(`received ${two}`, 10, 20), frame(`received ${answer}: station 2: read holding registers`, 50, 60), frame(`received ${nine}`, 100, 110));
  const slave2 = of('slave2', frame(`received ${two}`, 10, 20), frame(`sent ${answer}: 2 registers`, 50, 60), frame(`received ${nine}`, 100, 110));
  const seen = (...tracks) => parts.exchanges_of({ from_ns: 0, to_ns: 5e9, tracks }, 5e9).map((one) => [one.at_ns, one.asker, one.station, one.answer?.slice(0, 5), one.others]);
  assert.deepEqual(seen(hears('slave1'), slave2, hears('slave3')), [[10, undefined, 'slave2', '02 03', 2], [100, undefined, 'slave1', undefined, 2]]);
  const master = of('master', frame(`sent ${two}`, 10, 20), frame(`received ${answer}: 2 registers`, 50, 60), frame(`sent ${nine}`, 100, 110));
  assert.deepEqual(seen(master, hears('slave1'), slave2), [[10, 'master', 'slave2', '02 03', 1], [100, 'master', 'slave1', undefined, 1]]);
  assert.deepEqual(seen(master), [[10, undefined, 'master', '02 03', undefined], [100, undefined, 'master', undefined, undefined]]);
});

test('what is wrong with an element is said once', () => {
  const track = { kind: 'events', name: 'events', exact: true, spans: [] }, lost = 'INT 10 LOST: its queue is full';
  const say = (error) => parts.span_text(track, { text: lost, at_ns: 0, end_ns: 0, error });
  assert.equal(say('LOST: its queue is full').match(/LOST/g).length, 1);
  assert.match(say('parity error'), /parity error$/);
});

/** How light a colour is, as WCAG 2.1 reckons it. */
function luminance(colour) {
  const [r, g, b] = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16) / 255).map((c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

test('what is written on tracks can be read: its contrast is 4.5 at least, in the dark too', () => {
  const style = readFileSync(path.join(process.env.SOURCE, 'tools/faces/page/page.css'), 'utf8'), [light, dark] = style.split(':root[data-theme="dark"]');
  for (const theme of [light, dark]) {
    const colour = (name) => new RegExp(`--${name}: (#[0-9a-f]{6})`).exec(theme)[1];
    for (const name of ['received', 'sent', 'interrupts', 'scans', 'networks', 'routines']) {
      const [low, high] = [luminance(colour(name)), luminance(colour('on-colour'))].sort((a, b) => a - b);
      assert.ok((high + 0.05) / (low + 0.05) >= 4.5, `${name}: ${(high + 0.05) / (low + 0.05)}`);
    }
  }
});

test('errors are the first track', () => {
  const tracks = ['characters', 'scans', 'errors', 'value'].map((kind) => ({ kind, name: kind, exact: true, spans: [] }));
  assert.deepEqual(parts.rows_of({ tracks }, 0).map((row) => row.track.kind), ['errors', 'characters', 'scans', 'value']);
});

test('a request without an answer is unanswered, unless the answer may still come', () => {
  const spans = frames(frame('received 01', 10, 20), frame('received 02', 5e9, 5e9 + 10));
  const early = parts.exchanges_of(spans, 5e9 + 20);
  assert.deepEqual(early.map(parts.is_unanswered), [true, false]);
  assert.deepEqual(parts.exchanges_of(spans, 8e9).map(parts.is_unanswered), [true, true]);
});

test('what is sent unasked is no answer', () => {
  assert.deepEqual(parts.exchanges_of(frames(frame('sent 48 49', 10, 20)), 100), []);
});

test('the scale finds the first element that is in view', () => {
  const all = [0, 10, 20, 30].map((at_ns) => ({ at_ns, end_ns: at_ns + 5 }));
  assert.equal(parts.first_after(all, -1), 0);
  assert.equal(parts.first_after(all, 12), 1);
  assert.equal(parts.first_after(all, 15), 2);
  assert.equal(parts.first_after(all, 99), 4);
  const scale = { from_ns: 100, to_ns: 1100, left: 0, right: 500 };
  assert.equal(parts.x_of(scale, 600), 250);
  assert.equal(parts.ns_at(scale, 250), 600);
  assert.equal(parts.step_of(scale, 100), 200);
});

test('what reaches over an end of a measured part, or still goes on, counts for no length', () => {
  parts.state.past = { oldest_ns: 0, newest_ns: 1000, now_ns: 0 };
  const scan = (at_ns, end_ns) => ({ text: 'scan', at_ns, end_ns });
  const of = (from, to, ...spans) => parts.measured({ kind: 'scans', name: 'scans', exact: true, spans }, from, to)[0];
  const [one, open] = [of(100, 400, scan(99, 120), scan(120, 220), scan(220, 400), scan(400, 401)), of(0, 1000, scan(0, 10), scan(900, 1000))];
  assert.deepEqual([one.count, one.cut, one.average, one.least.at_ns, one.most.at_ns], [2, 1, 140, 120, 220]);
  assert.deepEqual([open.count, open.cut, open.most.end_ns], [1, 1, 10]);
  parts.state.past = null;
});

test('the bits of a character are those of the line', () => {
  const format = { baud: 9600, data_bits: 8, parity: 'even', stop_bits: 1 };
  assert.equal(parts.levels_of(format, 0x01).join(''), '01000000011');
  assert.equal(parts.levels_of(format, 0x03).join(''), '01100000001');
  assert.equal(parts.levels_of({ ...format, parity: 'odd' }, 0x03).join(''), '01100000011');
  assert.equal(parts.levels_of({ ...format, parity: 'none', data_bits: 7, stop_bits: 2 }, 0x41).join(''), '0100000111');
  assert.equal(parts.levels_of(format, 0x03, 'parity error').join(''), '01100000011');
  assert.equal(parts.levels_of(format, 0x03, 'framing error').join(''), '01100000000');
});

test('files are read as they are encoded', () => {
  const bytes = (...all) => Uint8Array.from(all);
  assert.deepEqual(parts.source_of('a', bytes(0xff, 0xfe, 0x4c, 0, 0x44, 0)), { name: 'a', text: 'LD' });
  assert.deepEqual(parts.source_of('a', bytes(0x50, 0xc3, 0xbc)), { name: 'a', text: 'Pü' });
  assert.deepEqual(parts.source_of('a', bytes(0x50, 0xfc, 0x0a)), { name: 'a', text: 'Pü\n', hex: '50fc0a' }, 'the session finds out its code page');
});

test('a small program fits into an address and comes back, a damaged address brings nothing', async () => {
  const sources = [{ name: 'a.awl', text: 'LD I0.0\n= Q0.0 // ä\n' }];
  const address = await parts.address_of(sources);
  assert.deepEqual(await parts.sources_in(`#t=1ms&${address}`), sources);
  assert.deepEqual(await parts.sources_in('#p=AAAA'), []);
  const noise = Array.from({ length: 30000 }, (_, i) => (i * 2654435761 % 4294967296).toString(36)).join('');
  assert.equal(await parts.address_of([{ name: 'a.awl', text: noise }]), undefined);
});

test('an address is used where memory of it is', () => {
  const pairs = [['V10.3', 'VB10'], ['VW9', 'VB10'], ['VD7', 'V10.7'], ['Q0.0', 'q0.0'], ['T37', 'T37'], ['AIW0', 'AIW0'], ['SMB30', 'SM30.1']];
  for (const [one, other] of pairs) assert.ok(parts.overlap(one, other) && parts.overlap(other, one), `${one} ${other}`);
  for (const [one, other] of [['V10.3', 'V10.4'], ['VW9', 'VB11'], ['VB0', 'MB0'], ['T37', 'C37'], ['AIW0', 'AIW2'], ['SMB30', 'MB30']]) assert.ok(!parts.overlap(one, other), `${one} ${other}`);
});

test('a status chart of Micro/WIN is read, and written as it is', () => {
  const text = readFileSync(path.join(process.env.SOURCE, 'tests/exports/pump_chart.txt'), 'utf8');
  const rows = parts.chart_from(text);
  assert.deepEqual(rows.map((row) => [row.address, row.format]), [['Q0.0', 'signed'], ['VW100', 'signed'], ['VD104', 'unsigned']]);
  const written = parts.chart_text(rows.map((row, i) => ({ row, current: '0', bit: i === 0 })));
  assert.deepEqual(parts.chart_from(written), rows);
  assert.deepEqual(parts.chart_from('"Level low":I0.1\tBit\r\n\t\t\nVD20:real\t\t\t5\n').map((row) => row.address), ['I0.1', 'VD20:real']);
});
