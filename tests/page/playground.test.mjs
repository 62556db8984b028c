// The playground: one file, with the engine as WebAssembly in a worker; programs are dropped on it.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { browser, kDesktop, kPhone, moment, picture } from './support.mjs';

const kFile = `file://${process.env.PLAYGROUND}`;
const exported = (name) => ({ name, text: readFileSync(path.join(process.env.SOURCE, 'tests/exports', name), 'utf8') });
let chrome;
before(async () => { chrome = await browser(); });
after(() => chrome?.close());

async function open(address = kFile) {
  const page = await chrome.newPage({ viewport: kDesktop });
  page.setDefaultTimeout(20000);
  page.troubles = [];
  page.on('pageerror', (error) => page.troubles.push(error.message));
  page.on('console', (message) => { if (message.type() === 'error') page.troubles.push(message.text()); });
  await page.goto(address);
  await page.waitForSelector('.connection.connected');
  return page;
}

function drop(page, ...files) {
  return page.evaluate((files) => {
    const dataTransfer = new DataTransfer();
    for (const { name, text, bytes } of files) dataTransfer.items.add(new File([bytes ? new Uint8Array(bytes) : text], name));
    dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true }));
  }, files);
}

const scans = (page) => page.waitForFunction(() => parseInt(document.querySelector('.scan-number').textContent.slice(5)) > 3);

test('a program with its symbol table and data block is dropped, and runs', async () => {
  const page = await open();
  await drop(page, ...['pump_symbols.txt', 'pump.awl', 'pump_data.txt'].map(exported));
  await page.waitForSelector('.row:has-text("Level_High")');
  await page.fill('#add-address', 'Longest_Run');
  await page.press('#add-address', 'Enter');
  await page.waitForFunction(() => document.querySelector('.chart .current')?.textContent === '300');
  await page.click('[aria-label^="Input I0.1"]');
  await page.click('[aria-label^="Input I0.0"]');
  await page.click('#do-run');
  await page.waitForSelector('[aria-label="Output Q0.0 on"]');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 200);
  await page.click('#do-run');
  await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
  await page.keyboard.press('Shift+S');
  await page.waitForSelector('.tag.past');
  await picture(page, 'playground_running');
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('the mistakes of a program are shown as check shows them, and lead to their lines', async () => {
  const page = await open();
  await drop(page, { name: 'wrong.awl', text: 'LD     I0.0\nMOVB   VW100, VB2\n=      Q0.0\nMEND\n' });
  await page.waitForSelector('.diagnostics .error');
  const said = await page.textContent('.diagnostics');
  assert.match(said, /wrong\.awl:2:\d+: error: /);
  assert.match(said, /\^/, 'the source line with a caret');
  assert.match(said, /hint: /);
  await picture(page, 'playground_mistakes');
  await page.click('.diagnostics .error');
  const chosen = await page.$eval('.opener textarea', (field) => field.value.slice(field.selectionStart, field.selectionEnd));
  assert.equal(chosen, 'MOVB   VW100, VB2');
  await page.fill('.opener textarea', 'LD     I0.0\nMOVB   VB100, VB2\n=      Q0.0\nMEND\n');
  await page.click('#check-and-run');
  await page.waitForSelector('.row:has-text("VB100")');
  await page.click('#do-scan');
  await page.waitForSelector('.row.op .flow:text-matches("[01]")');
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('mistakes are beside the program, in whole sentences, how many there are first', async () => {
  const page = await open();
  await drop(page, { name: 'many.awl', text: 'ATCH   7, 99 // and a remark that goes on for longer than anybody would like to read\n'.repeat(12) + 'MEND\n' });
  await page.waitForSelector('.diagnostics .error');
  assert.match(await page.textContent('.diagnostics .total'), /^many\.awl: \d+ errors .*\d+ warnings/);
  const sizes = await page.evaluate(() => {
    const box = (name) => document.querySelector(name).getBoundingClientRect();
    return { cut: [...document.querySelectorAll('.diagnostics .error')].filter((one) => one.scrollWidth > one.clientWidth).length,
      beside: box('.diagnostics').left >= box('.opener textarea').right, height: box('.diagnostics').height / innerHeight };
  });
  assert.equal(sizes.cut, 0);
  assert.ok(sizes.beside && sizes.height > 0.5, JSON.stringify(sizes));
  await picture(page, 'playground_many_mistakes');
  await page.setViewportSize(kPhone);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is wider than the phone');
  await page.close();
});

test('how a program was read, and for which CPU, is noted as check notes it', async () => {
  const page = await open();
  await drop(page, { name: 'post.awl', text: '<p>NETWORK 1<br>LD &nbsp;I0.0<br>= Q9.0<br>MEND</p>' });
  await page.waitForSelector('.notice:has-text("post.awl: read as plain text: no-break and other Unicode blanks, HTML; the first in line 1")');
  await drop(page, { name: 'post.awl', text: '<p>NETWORK 1<br>LD &nbsp;I0.0<br>MOVB VW100, VB2<br>MEND</p>' });
  await page.waitForSelector('.diagnostics .note:has-text("read as plain text")');
  await drop(page, { name: 'newer.awl', text: 'NETWORK 1\nLD SM0.0\n/I 2, VW0\nMEND\n' });
  await page.waitForSelector('.notice:has-text("as on a CPU 224")');
  await page.close();
});

test('what was missing is not said of a program with mistakes', async () => {
  const page = await open();
  await page.click('#check-and-run');
  await page.waitForSelector('.notice:has-text("There is no program yet")');
  await page.fill('.opener textarea', 'LD I0.0\nMOVB VW100, VB2\nMEND\n');
  await page.click('#check-and-run');
  await page.waitForSelector('.diagnostics .error');
  assert.equal(await page.locator('.notice').count(), 0);
  await page.close();
});

test('where a program has no interrupt routine, it says so and runs nothing', async () => {
  const page = await open();
  await page.click('text=Example');
  await page.click('#check-and-run');
  await page.waitForSelector('.row');
  await page.waitForSelector('.connection.connected');
  await page.evaluate(() => document.activeElement?.blur());
  const before = await page.inputValue('#moment');
  await page.keyboard.press('i');
  await page.waitForSelector('.notice:has-text("The program has no interrupt routine")');
  assert.equal(await page.inputValue('#moment'), before);
  await page.close();
});

test('a program is typed, run as fast as it goes, and paused', async () => {
  const page = await open();
  await page.click('text=Example');
  await page.click('#check-and-run');
  await page.waitForSelector('.row');
  await page.selectOption('#pace', '0');
  await page.click('#do-run');
  await page.waitForFunction(() => document.querySelector('#moment').value.endsWith(' s') || parseFloat(document.querySelector('#moment').value) > 5000);
  await page.click('#do-run');
  await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
  await page.click('#open-program');
  await page.waitForSelector('.opener textarea');
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('a file in another code page is read as the command reads it, a document is refused', async () => {
  const page = await open();
  const pump = [0xcd, 0xe0, 0xf1, 0xee, 0xf1], stop = [0xd1, 0xf2, 0xee, 0xef];  // Насос, Стоп in Windows-1251
  const text = (words) => [...Buffer.from(words)];
  await drop(page, { name: 'russian.awl', bytes: [...text('NETWORK 1 // '), ...pump, ...text(' '), ...stop, ...text('\nLD     I0.0\n=      Q0.0\nMEND\n')] });
  await page.waitForSelector('.row:has-text("Насос Стоп")');
  await page.click('#open-program');
  assert.match(await page.inputValue('.opener textarea'), /Насос Стоп/, 'where it is edited too');
  await page.click('#check-and-run');
  await page.waitForSelector('.row:has-text("Насос Стоп")');
  await drop(page, { name: 'manual.doc', bytes: [0xd0, 0xcf, 0x11, 0xe0, 0xa1, 0xb1, 0x1a, 0xe1, 0, 0] });
  await page.waitForSelector('.notice.error:has-text("cannot read manual.doc: ")');
  await page.waitForSelector('.row:has-text("Насос Стоп")');
  await page.click('#open-program');
  await page.waitForSelector('.file');
  assert.deepEqual(await page.locator('.file').allTextContents(), ['russian.awl'], 'it is not kept');
  await page.close();
});

test('a system that is dropped is refused, and nothing else is lost', async () => {
  const page = await open();
  await drop(page, { name: 'lamp.stl', text: 'LD     I0.0\n=      Q0.0\nMEND\n' });
  await page.waitForSelector('.row');
  await drop(page, { name: 'plant.yaml', text: 'plcs: {pump: {program: lamp.stl}}\n' });
  await page.waitForSelector('.notice.error:has-text("s7200 view plant.yaml shows it")');
  assert.equal(await page.locator('.row').count() > 0, true);
  assert.deepEqual(page.troubles, []);
  await page.close();
});

/** A program whose first instruction is in that line. */
const program_from = (line, text) => `${'// a word about it\n'.repeat(line - 1)}${text}`;

test('another program replaces the one before with its tables, and says so; what ran before has ended', async () => {
  const page = await open();
  await drop(page, ...['pump_symbols.txt', 'pump.awl', 'pump_data.txt'].map(exported));
  await page.waitForSelector('.row:has-text("Drain pump")');
  await page.click('#do-run');
  await scans(page);
  await drop(page, { name: 'valve.txt', text: program_from(200, 'NETWORK 1\nLD     I1.3\nMOVB   VW100, VB2\n=      Q1.1\nMEND\n') });
  await page.waitForSelector('.diagnostics .error');
  assert.deepEqual(await page.locator('.file').allTextContents(), ['valve.txt']);
  await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
  const stopped = await page.textContent('.scan-number');
  await page.waitForTimeout(500);
  assert.equal(await page.textContent('.scan-number'), stopped, 'the pump does not run behind the mistakes');
  await page.fill('.opener textarea', program_from(200, 'NETWORK 1\nLD     I1.3\n=      Q1.1\nMEND\n'));
  await page.click('#check-and-run');
  await page.waitForSelector('.row.here:has-text("LD     I1.3")');
  await page.waitForSelector('[aria-label="Input I1.3"]');
  assert.deepEqual(await page.locator('.point:not(.unnamed) .point-name').allTextContents(), ['I1.3', 'Q1.1'], 'nothing of the pump');
  await drop(page, exported('pump.awl'), exported('pump_symbols.txt'));
  await page.waitForSelector('.notice:has-text("pump.awl replaces valve.txt; Edit leads back")');
  await drop(page, exported('pump_data.txt'));
  await page.waitForSelector('.navigator option:has-text("pump_data.txt")', { state: 'attached' });
  await page.waitForSelector('.row');
  await page.click('#open-program');
  await page.waitForSelector('.file');
  assert.deepEqual(await page.locator('.file').allTextContents(), ['pump.awl', 'pump_symbols.txt', 'pump_data.txt'], 'a table comes to its program');
  await page.click('#take-back');
  await page.waitForSelector('.row.here:has-text("LD     I1.3")');
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('the licences of what the engine is linked with are in About', async () => {
  const page = await open();
  await page.click('.program-name');
  const text = await page.textContent('[role=dialog]');
  for (const name of ['fmt', 'Niels Lohmann', 'Boost', 'LLVM', 'wasi-libc']) assert.ok(text.includes(name), name);
  await page.close();
});

test('an address carries a small program and a moment', async () => {
  const page = await open();
  await page.click('text=Example');
  await page.click('#check-and-run');
  await page.waitForSelector('.row');
  for (let i = 0; i < 5; ++i) await page.click('#do-scan');
  await page.waitForFunction(() => document.querySelector('.scan-number').textContent === 'scan 6');  // all of them
  const there = await moment(page);
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press('l');
  await page.waitForFunction(() => location.hash.includes('&p='));
  const other = await open(page.url());
  await other.waitForSelector('.row:has-text("the pump runs")');
  await other.waitForFunction((there) => Math.abs(parseFloat(document.querySelector('#moment').value) - there) < 1, there);
  await other.close();
  await page.close();
});
