// Reports: pages that compute a run again. The command writes them, Chromium opens them as files.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync, statSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { deflateSync, inflateSync } from 'node:zlib';
import { after, before, test } from 'node:test';
import { browser, kDesktop, kPhone, moment, picture } from './support.mjs';

const kSlave = 'stl_programs/modbus_slave.stl';
const kMost = 2e6;  // bytes
const kOfADay = 145e3;  // bytes that a day polled each second adds to the page: tests/page/bench
const file = (name) => path.join(process.env.REPORTS, name);
let chrome;
before(async () => { chrome = await browser(); });
after(() => chrome?.close());

/** Runs the command in the source folder; `code` is what it has to end with. */
function s7200(code, ...words) {
  const done = spawnSync(process.env.S7200, words, { cwd: process.env.SOURCE, encoding: 'utf8' });
  assert.equal(done.status, code, `${words.join(' ')}\n${done.stdout}${done.stderr}`);
  return done.stdout;
}

async function open(name, { hash = '', viewport = kDesktop, colorScheme = 'light' } = {}) {
  const context = await chrome.newContext({ viewport, colorScheme, offline: true });
  const page = await context.newPage();
  page.setDefaultTimeout(20000);
  page.troubles = [];
  page.on('pageerror', (error) => page.troubles.push(error.message));
  page.on('console', (message) => { if (message.type() === 'error') page.troubles.push(message.text()); });
  page.on('request', (request) => { if (!/^(file|data|blob):/.test(request.url())) page.troubles.push(request.url()); });
  await page.goto(`file://${file(name)}${hash}`);
  await page.waitForSelector('.row', { state: 'attached' });
  page.end = async () => {
    assert.deepEqual(page.troubles, []);
    await context.close();
  };
  return page;
}

const stands_at = (page, ms, within = 1) => page.waitForFunction(([ms, within]) => {
  const text = document.querySelector('#moment').value;
  return Math.abs(parseFloat(text) * (text.endsWith(' s') ? 1000 : 1) - ms) <= within;
}, [ms, within]);

test('an exchange is in its report, to the instant', async () => {
  const said = JSON.parse(s7200(0, 'send', kSlave, '--crc', '0103000a0002', '--set', 'VW20=77', '--json', '--report', file('send.html')));
  const page = await open('send.html');
  await page.click('#tab-line');
  await page.waitForSelector('.exchanges tbody tr:has-text("16#004D")');
  const latency = parseFloat(await page.textContent('.exchanges tbody .number'));
  assert.ok(Math.abs(latency - said.exchanges[0].latency_us / 1000) < 0.001, `${latency} ms, and ${said.exchanges[0].latency_us} us`);
  await page.end();
});

test('a request without an answer is in the summary, and has none wherever one stands', async () => {
  s7200(1, 'send', kSlave, '01 03 00 0a 00 02 00 00', '--report', file('lost.html'));
  const page = await open('lost.html');
  await page.waitForSelector('.summary .unanswered:has-text("01 03 00 0a 00 02 00 00")');
  await stands_at(page, 181, 2);
  await page.click('.summary .unanswered .why');
  await page.waitForSelector('.trail:has-text("JMP 255 in line 141")');
  await page.click('#tab-line');
  await page.click('.exchanges tbody .link');
  await stands_at(page, 71);
  await page.waitForTimeout(500);
  assert.match(await page.textContent('.exchanges tr.trouble'), /no answerWhy\?/);
  assert.match(await page.textContent('.line-pane'), /1 request, 1 without an answer/);
  await page.end();
});

test('a report of a master opens at its first request without an answer', async () => {
  s7200(1, 'master', kSlave, 'read', '40001', '--station', '9', 'read', '40002', '--report', file('nobody.html'));
  const page = await open('nobody.html');
  await page.waitForSelector('.summary .unanswered >> nth=1');
  await stands_at(page, 181, 2);
  await page.click('.summary .unanswered .why');
  await page.waitForSelector('.trail:has-text("the request was for station 9")');
  await page.end();
});

test('the address names the moment', async () => {
  const page = await open('send.html', { hash: '#t=60.5ms' });
  await stands_at(page, 60.5);
  await page.waitForSelector('.tag.past');
  await page.keyboard.press('l');
  await page.waitForFunction(() => Math.abs(parseFloat(location.hash.slice(3)) - parseFloat(document.querySelector('#moment').value)) < 1e-6);
  await page.end();
});

test('an hour of polling opens with its picture, and any moment of it is computed', async () => {
  s7200(0, 'master', kSlave, 'read', '40011:2', '--every', '1s', '--count', '3600', '--report', file('hour.html'));
  assert.ok(statSync(file('hour.html')).size < kMost, `${statSync(file('hour.html')).size} bytes`);
  const empty = statSync(file('share/s7200/page.html')).size;
  assert.ok(empty + kOfADay < kMost, `${empty} bytes of the page leave too little for a day`);
  const page = await open('hour.html');
  assert.equal(await moment(page), 0, 'nothing is computed before one looks');
  await page.waitForFunction(() => document.querySelector('.track-names').textContent.includes('port 0 frames'));
  await picture(page, 'report_hour');
  const said = await page.textContent('.report-pane');
  assert.match(said, /Answers3600, the longest after [\d.]+ ms/, said);
  assert.match(said, /send .*, 3600 times, up to 3599/, said);
  await page.fill('#moment', '30 min');
  await page.press('#moment', 'Enter');
  await stands_at(page, 1800e3, 2);
  await page.click('#tab-line');
  await page.waitForSelector('.part:has-text("Only 0:29:00 to 0:31:00 of ")');
  assert.match(await page.textContent('.line-pane'), /1(19|20|21) requests, 0 without an answer/);
  await page.click('#exchanges-before');
  await page.waitForSelector('.part:has-text("Only 0:27:00 to 0:29:00")');
  await page.click('#exchanges-after');
  await page.waitForSelector('.part:has-text("Only 0:29:00 to 0:31:00")');
  await page.fill('.line-pane input[type=search]', 'nothing has this');
  await page.waitForFunction(() => /^0 of 1\d\d pass the filter/.test(document.querySelector('.chart-tools .hint').textContent));
  await page.end();
});

/** The report in a page, and the page with another one in it. */
const kPlace = /(<script id="report" type="text\/plain">)([^<]+)/;
const report_in = (page) => JSON.parse(inflateSync(Buffer.from(kPlace.exec(page)[2], 'base64')).toString());
const with_report = (page, report) => page.replace(kPlace, (_all, head) => head + deflateSync(JSON.stringify(report)).toString('base64'));

test('a long run has checkpoints, and a damaged one is said', async () => {
  const page = readFileSync(file('hour.html'), 'utf8'), report = report_in(page);
  const [recording] = report.runs[0].recordings;
  assert.ok(recording.checkpoints.length > 100, `${recording.checkpoints.length}`);
  recording.checkpoints[5] = recording.checkpoints[5].replace(/..$/, '77');
  writeFileSync(file('damaged.html'), with_report(page, report));
  const context = await chrome.newContext({ offline: true });
  const damaged = await context.newPage();
  await damaged.goto(`file://${file('damaged.html')}`);
  await damaged.waitForSelector('.notice.error:has-text("a checkpoint in it is damaged")');
  await context.close();
});

test('the longest answer of a long run is gone to, and what it waited for is said', async () => {
  const { picture: known } = report_in(readFileSync(file('hour.html'), 'utf8')).runs[0].recordings[0];
  assert.equal(known.answers.count, 3600);
  const page = await open('hour.html');
  await page.click('#tab-line');
  await page.click('text=Longest answer');
  await page.waitForSelector('.notice:has-text("The longest of 3600 answers: after 16.")');
  assert.match(await page.textContent('.trail li'), /wait for\?.*until event 10/);
  await page.waitForFunction(() => / ms in view$/.test(document.querySelector('.readout').textContent));
  await page.waitForSelector('.track-name:has-text("networks")');
  await picture(page, 'report_longest');
  await page.end();
});

test('any moment has the same values with checkpoints and without', async () => {
  const page = readFileSync(file('hour.html'), 'utf8'), report = report_in(page);
  delete report.runs[0].recordings[0].checkpoints;
  writeFileSync(file('plain.html'), with_report(page, report));
  const seen = [];
  for (const name of ['hour.html', 'plain.html']) {
    const one = await open(name, { hash: '#t=3000.0123s' });
    await stands_at(one, 3000012.3, 2);
    await one.waitForFunction(() => document.querySelectorAll('.row .flow').length > 0);
    seen.push(await one.evaluate(() => [document.querySelector('.scan-number').textContent, document.querySelector('#moment').value, document.querySelector('.status-bar .place').textContent]));
    await one.end();
  }
  assert.deepEqual(seen[0], seen[1]);
});

test('what was done at the prompt is done again, and the run goes on from there', async () => {
  s7200(0, 'debug', kSlave, '-x', 'continue 80ms; set VW40=1234; send 01 03 00 14 00 01 crc; continue 80ms; at 60ms', '--report', file('debug.html'));
  const page = await open('debug.html');
  await page.click('#tab-chart');
  await page.fill('#add-address', 'VW40');
  await page.press('#add-address', 'Enter');
  await page.waitForFunction(() => document.querySelector('.chart .current')?.textContent === '1234');
  const end = await moment(page);
  await page.click('#do-end');
  await page.click('#do-run');
  await page.waitForFunction((end) => parseFloat(document.querySelector('#moment').value) > end + 50, end);
  await page.click('#do-run');
  await page.end();
});

const kHostile = '<img src=x onerror=alert(1)> & "quoted"';
const kScenarios = `program: ${path.join(process.env.SOURCE, kSlave)}
scenarios:
  - name: reads a register
    steps:
      - set: {VW20: 5}
      - {read: holding 10, expect: [5]}
  - name: '${kHostile}'
    steps:
      - set: {VW20: 5}
      - {read: holding 10, expect: [6]}
`;

test('a failed scenario opens where it failed, the others by a click', async () => {
  writeFileSync(file('both.yaml'), kScenarios);
  s7200(1, 'test', file('both.yaml'), '--report', file('test.html'), '--junit', file('junit.xml'));
  const junit = readFileSync(file('junit.xml'), 'utf8');
  assert.match(junit, /<property name="report" value="[^"]*test\.html#run=2"\/>/);
  const page = await open('test.html');
  await page.waitForSelector('.totals');
  assert.equal(await page.textContent('.totals'), '2 scenarios: 1 passed, 1 failed');
  assert.match(await page.textContent('.run.open'), /onerror=alert/, 'names are text');
  assert.equal(await page.$('.run img'), null);
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 10);
  await page.waitForSelector('.findings .link');
  await picture(page, 'report_test');
  await page.click('.run-name:has-text("reads a register")');
  await page.waitForSelector('.run.passed.open');
  await page.waitForFunction(() => location.hash === '#run=1');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 10);
  await page.end();
});

test('a link of the JUnit file leads to its scenario', async () => {
  const page = await open('test.html', { hash: '#run=1' });
  await page.waitForSelector('.run.passed.open');
  await page.end();
});

test('the links of the Markdown file lead to the failed step, in a page that is open too', async () => {
  s7200(1, 'test', file('both.yaml'), '--report', file('a report.html'), '--markdown', file('summary.md'));
  const markdown = readFileSync(file('summary.md'), 'utf8');
  assert.match(markdown, /^<!-- Results of s7200 test -->\n## ✗ 2 scenarios: 1 passed, 1 failed\n/);
  assert.match(markdown, /### ✗ \[\\<img src=x onerror=alert\(1\)\\> \\& "quoted"\]\(a%20report\.html#run=2\)/);
  const [, link, ns] = /- \[line 10\]\((a%20report\.html#run=2&t=(\d+)ns)\): /.exec(markdown);
  const page = await open('a report.html', { hash: '#run=1' });
  await page.waitForSelector('.run.passed.open');
  await page.evaluate((hash) => { location.hash = hash; }, link.split('#')[1]);
  await page.waitForSelector('.run.failed.open');
  await stands_at(page, Number(ns) / 1e6, 1e-3);
  await page.end();
  const fresh = await open('a report.html', { hash: `#${link.split('#')[1]}` });
  await fresh.waitForSelector('.run.failed.open');
  await stands_at(fresh, Number(ns) / 1e6, 1e-3);
  await fresh.end();
});

test('what is sent with many tables of times has the run of the first with which it failed', async () => {
  s7200(0, 'send', kSlave, '--crc', '0103000a0002', '--times-band', '5', '--report', file('band.html'));
  const page = await open('band.html');
  await page.click('#tab-line');
  await page.waitForSelector('.line-pane .exchanges tbody tr');
  assert.equal(await page.locator('.exchanges tbody tr').count(), 1);
  await page.end();
});

test('a PLC that is a master asks, and is answered', async () => {
  s7200(0, 'run', 'stl_programs/systems/gateway.yaml', '--for', '2s', '--report', file('gateway.html'));
  const page = await open('gateway.html');
  assert.match(await page.textContent('.report-pane'), /PLCsgateway, pump/);
  await page.click('#tab-line');
  await page.waitForSelector('.exchanges tbody tr');
  const rows = await page.locator('.exchanges tbody tr').allTextContents();
  for (const who of ['gateway is asked', 'gateway asks pump']) assert.ok(rows.some((row) => row.includes(`${who}05 03 00 00 00 02 c5 8f: station 5: `)), who);
  for (const row of rows) assert.match(row, /05 03 04 12 34 00 00 fb 45: 2 registers: .* ms$|under way …$/);
  await page.click('text=Longest answer');
  await page.waitForSelector('.notice:has-text("The longest of ")');
  assert.match(await page.textContent('.notice'), /after 4\d\.\d+ ms, to 05 03 00 00 00 02 c5 8f: station 5/);
  await picture(page, 'gateway_longest');
  await page.end();
});

test('a system is in its report, each of its PLCs at any moment', async () => {
  s7200(0, 'run', 'stl_programs/systems/polled_slaves.yaml', '--for', '3s', '--report', file('system.html'));
  const page = await open('system.html');
  assert.match(await page.textContent('.report-pane'), /System.*polled_slaves\.yaml.*Simulated time3 s/s);
  const names = await page.locator('#station option').allTextContents();
  assert.ok(names.length > 1, names.join());
  await page.selectOption('#station', names[1]);
  await page.waitForFunction((name) => document.querySelector('#station').value === name, names[1]);
  await page.click('#tab-line');
  await page.waitForSelector('.exchanges tbody tr');
  assert.ok(await page.locator('.exchanges tbody tr').count() > 2, 'what the master of the file has asked');
  await picture(page, 'system_report');
  await page.end();
});

test('a recording is a page with its conversation: table, latencies, filter', async () => {
  s7200(0, 'decode', 'tests/recordings/plant.log', '--report', file('plant.html'));
  const context = await chrome.newContext({ offline: true, viewport: kDesktop });
  const page = await context.newPage();
  const troubles = [];
  page.on('pageerror', (error) => troubles.push(error.message));
  await page.goto(`file://${file('plant.html')}`);
  await page.waitForSelector('.conversation tbody tr');
  const frames = JSON.parse(s7200(0, 'decode', 'tests/recordings/plant.log', '--json')).frames;
  const rows = page.locator('.conversation-rows tbody tr');
  assert.equal(await rows.count(), frames.length);
  assert.match(await rows.nth(1).textContent(), /answer01 03 02 12 34 b5 33.*16#1234.*ms/);
  await page.waitForSelector('.histogram');
  await picture(page, 'conversation');
  await page.fill('#frame-filter', 'exception');
  await page.waitForFunction((all) => document.querySelectorAll('.conversation-rows tbody tr').length < all, frames.length);
  assert.match(await rows.first().textContent(), /exception/);
  await page.fill('#frame-filter', '');
  await page.click('text=Only trouble');
  const troubled = frames.filter((frame) => frame.unanswered || !frame.right);
  await page.waitForFunction((count) => document.querySelectorAll('.conversation-rows tbody tr').length === count, troubled.length);
  for (const row of await rows.all()) assert.match(await row.getAttribute('class'), /trouble/);
  assert.match(await rows.first().textContent(), /station 2.*: no answer/);
  await page.setViewportSize(kPhone);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is wider than the phone');
  await picture(page, 'conversation_phone');
  assert.deepEqual(troubles, []);
  await context.close();
});

test('a long recording is shown part by part, and what it says is text', async () => {
  const lines = [];
  for (let i = 0; i < 1200; ++i) lines.push(`2026-11-22 07:${String(Math.floor(i / 10) % 60).padStart(2, '0')}:0${i % 10}.000 TX: 01 03 00 00 00 01 84 0A`);
  writeFileSync(file('<b>long.log'), `${lines.join('\n')}\n`);
  s7200(0, 'decode', file('<b>long.log'), '--report', file('long.html'));
  const context = await chrome.newContext({ offline: true, viewport: kDesktop });
  const page = await context.newPage();
  await page.goto(`file://${file('long.html')}`);
  await page.waitForSelector('.rows-shown:has-text("1 to 500 of 1200 frames")');
  assert.match(await page.textContent('.summary'), /<b>long\.log/);
  await page.click('[aria-label="Rows after"]');
  await page.waitForSelector('.rows-shown:has-text("501 to 1000 of 1200 frames")');
  await page.emulateMedia({ media: 'print' });
  await page.evaluate(() => dispatchEvent(new Event('beforeprint')));
  assert.equal(await page.locator('.conversation-rows tbody tr').count(), 100);
  assert.ok(await page.isVisible('.rows-shown:has-text("501 to 600 of 1200 frames")'), 'which of them are printed');
  await context.close();
});

test('a report can be read in the dark, on a phone and on paper', async () => {
  const dark = await open('test.html', { colorScheme: 'dark' });
  await picture(dark, 'report_dark');
  await dark.end();
  const phone = await open('test.html', { viewport: kPhone });
  await phone.waitForSelector('.totals');
  assert.ok(await phone.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is wider than the phone');
  await picture(phone, 'report_phone');
  await phone.emulateMedia({ media: 'print' });
  await picture(phone, 'report_printed');
  await phone.end();
});

test('what is printed is light, whole, and as wide as the paper', async () => {
  const page = await open('gateway.html', { colorScheme: 'dark' });
  await page.waitForSelector('.track-name:has-text("pump port 0 sent")');
  const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
  assert.equal(await theme(), 'dark');
  await page.emulateMedia({ media: 'print' });
  await page.evaluate(() => {
    document.body.style.width = '718px';  // A4 with margins of 10 mm
    dispatchEvent(new Event('beforeprint'));
  });
  assert.equal(await theme(), 'light');
  const { canvas, tracks, overlapping } = await page.evaluate(() => {
    const tops = [...document.querySelectorAll('.row')].map((row) => row.getBoundingClientRect().top);
    const box = (name) => document.querySelector(name).getBoundingClientRect();
    return { canvas: box('#timeline'), tracks: box('.track-names'), overlapping: tops.filter((top, i) => i > 0 && top < tops[i - 1] + 19).length };
  });
  assert.ok(canvas.right < 720 && Math.abs(canvas.height - tracks.height) < 2, `${canvas.right}, ${canvas.height}, ${tracks.height}`);
  assert.equal(overlapping, 0);
  const { short, cut, asked } = await page.evaluate(() => ({
    short: document.querySelector('.timeline').getBoundingClientRect().right - document.querySelector('#timeline').getBoundingClientRect().right,
    cut: [...document.querySelectorAll('.row .text')].filter((one) => one.scrollWidth > one.clientWidth + 1).length,
    asked: [...document.querySelectorAll('.why, .ask')].filter((one) => one.checkVisibility()).length,
  }));
  assert.ok(short < 8, `the timeline ends ${short} pixels before the edge`);
  assert.deepEqual([cut, asked], [0, 0], 'no comment is cut, nothing can be asked');
  await picture(page, 'report_on_paper');
  await page.evaluate(() => dispatchEvent(new Event('afterprint')));
  assert.equal(await theme(), 'dark');
  await page.end();
});

test('of a long list a part is printed, and how many rows are left out', async () => {
  const actions = Array.from({ length: 45 }, (_, i) => `set VW40=${i}; send 01 03 00 14 00 01 crc; continue 200ms`);
  s7200(0, 'debug', kSlave, '-x', `continue 100ms; ${actions.join('; ')}`, '--report', file('many.html'));
  const page = await open('many.html');
  const print = async (on) => {
    await page.emulateMedia({ media: on ? 'print' : 'screen' });
    await page.evaluate((name) => dispatchEvent(new Event(name)), on ? 'beforeprint' : 'afterprint');
  };
  for (const [tab, all, left_out] of [['report', 90, 'and 60 more'], ['line', 45, 'and 15 before these'], ['causes', 90, 'and 60 before these']]) {
    await page.click(`#tab-${tab}`);
    await page.waitForFunction((all) => document.querySelectorAll('.exchanges tbody tr').length === all, all);
    await print(true);
    assert.equal(await page.locator(`[data-of=${tab}] .exchanges tbody tr`).count(), 30);
    assert.ok(await page.isVisible('[data-of=report] .summary'), 'the summary is printed whatever is in front');
    assert.ok(await page.isVisible(`[data-of=${tab}] .hint:has-text("${left_out}")`), left_out);
    assert.equal(await page.isVisible('.side form'), false, 'what cannot be typed into is not printed');
    await print(false);
  }
  await print(true);
  assert.match(await page.textContent('.program > header'), /lines \d+ to \d+ of \d+/);
  await page.end();
});

test('what all failed scenarios have found is printed, and which inputs are on without colours', async () => {
  const failing = (name, value) => `- {name: ${name}, steps: [set: {I0.3: 1}, wait: 50ms, memory: {VW20: ${value}}]}\n`;
  writeFileSync(file('red.yaml'), `program: ${path.resolve(process.env.SOURCE, kSlave)}\nscenarios:\n${failing('first', 7)}${failing('second', 8)}- {name: third, steps: [wait: 1ms]}\n`);
  s7200(1, 'test', file('red.yaml'), '--report', file('red.html'));
  const page = await open('red.html');
  await page.waitForSelector('.run.open');
  await page.click('#tab-chart');
  await page.waitForSelector('[aria-label^="Input I0.3"][aria-checked=true]');
  await page.emulateMedia({ media: 'print' });
  await page.evaluate(() => dispatchEvent(new Event('beforeprint')));
  assert.deepEqual(await page.locator('.findings li').allInnerTexts().then((all) => all.map((one) => /VW20 is 0.*(7|8)|(7|8).*0/.test(one))), [true, true]);
  const levels = await page.$$eval('.switch', (all) => all.slice(0, 5).map((one) => getComputedStyle(one, '::after').content));
  assert.deepEqual(levels, ['"0"', '"0"', '"0"', '"1"', '"0"']);
  await picture(page, 'report_of_failures_on_paper');
  await page.end();
});

test('the commands of the page about it are fine', () => {
  const shown = readFileSync(path.join(process.env.SOURCE, 'docs/page.md'), 'utf8').match(/^ {4}s7200 .*--report .*$/gm);
  assert.ok(shown.length >= 2);
  for (const line of shown) {
    const words = line.trim().split(/\s+/).slice(1).map((word) => (word.endsWith('.html') ? file(`shown_${word}`) : word));
    s7200(0, ...words);
  }
});
