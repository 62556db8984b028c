// The status chart: values in formats, new values, force, switches and lamps.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { browser, end, open, picture, rendered, view } from './support.mjs';

const kPump = ['tests/exports/pump.awl', 'tests/exports/pump_symbols.txt', 'tests/exports/pump_data.txt'];
let chrome, plc, page;
before(async () => {
  [chrome, plc] = await Promise.all([browser(), view(...kPump)]);
  page = await open(chrome, plc.address);
  await page.click('#do-scan');
  await page.click('#do-scan');
});
after(async () => {
  await chrome?.close();
  await end(plc.server);
});

const current = (n) => page.locator('.chart tbody tr').nth(n).locator('.current');
async function add(address) {
  await page.fill('#add-address', address);
  await page.press('#add-address', 'Enter');
}
async function shows(n, text) {
  await page.waitForFunction(([n, text]) => document.querySelectorAll('.chart tbody tr')[n]?.querySelector('.current')?.textContent.trim() === text, [n, text]);
}

test('addresses and symbols have their values, in the format that is chosen', async () => {
  await add('Longest_Run');
  await shows(0, '300');
  const formats = { hex: '16#012C', binary: '2#0000_0001_0010_1100', unsigned: '300', ascii: "'.,'" };
  for (const [format, text] of Object.entries(formats)) {
    await page.locator('.chart .format select').first().selectOption(format);
    await shows(0, text);
  }
  await page.locator('.chart .format select').first().selectOption('signed');
  await add('Pump');
  await shows(1, '2#0');
  await add('VD210');
  await page.locator('.chart .format select').nth(1).selectOption('real');
  await shows(2, '3.14');
  await add('NoSuchThing');
  await page.waitForFunction(() => document.querySelectorAll('.chart .wrong').length === 1);
});

test('there is room for symbols: in the chart, and at the inputs and outputs that have one', async () => {
  const cut = await page.$$eval('.chart .address', (fields) => fields.filter((one) => one.scrollWidth > one.clientWidth).map((one) => one.value));
  assert.deepEqual(cut, []);
  assert.equal(await page.locator('.chart .address').first().getAttribute('title'), 'Longest_Run (VW100)');
  assert.deepEqual(await page.locator('.point-symbol').allTextContents(), ['Level_High', 'Level low', 'Acknowledge', 'Pump', 'Fault lamp']);
  const overlapping = await page.$$eval('.points', (all) => all.flatMap((one) => [...one.children].filter((part) => part.getBoundingClientRect().right > one.getBoundingClientRect().right + 1 || part.scrollWidth > part.clientWidth + 1)).length);
  assert.equal(overlapping, 0);
  assert.deepEqual(await page.locator('.unnamed .point-name').allTextContents(), ['I0.2', 'I0.3', 'I0.4', 'I0.5', 'I0.6', 'Q0.2', 'Q0.3', 'Q0.4', 'Q0.5', 'Q0.6', 'Q0.7'], 'the rest of the first byte');
});

test('a new value is written with Enter', async () => {
  await page.locator('.new-value').first().fill('-5');
  await page.locator('.new-value').first().press('Enter');
  await shows(0, '-5');
});

test('what is wrong with a value is said of the value', async () => {
  for (const [typed, told] of [['abc', "'abc' is not a value; write for example 5, -5, 16#FF"], ['70000', '70000 does not fit Longest_Run: a word is -32768 to 65535']]) {
    await page.locator('.new-value').first().fill(typed);
    await page.locator('.new-value').first().press('Enter');
    await page.waitForSelector(`.notice.error:has-text("${told}")`);
  }
  await add('M0.0');
  await shows(4, '2#0');
  await page.locator('.new-value').nth(4).fill('1');
  await page.locator('.new-value').nth(4).press('Shift+Enter');
  await page.waitForSelector('.notice.error span:text-matches("^M0.0 cannot be forced")');
  await page.click('[aria-label="Remove M0.0"]');
  await page.locator('.new-value').first().fill('');
});

test('Write all writes every new value', async () => {
  await page.locator('.new-value').first().fill('16#0010');
  await page.locator('.new-value').nth(2).fill('2.5');
  await page.click('text=Write all');
  await shows(0, '16');
  await shows(2, '2.5');
});

test('a switch is an input: the pump runs while the lamp says so', async () => {
  await page.click('[aria-label^="Input I0.1"]');
  await page.click('[aria-label^="Input I0.0"]');
  await page.click('#do-scan');
  await page.click('#do-scan');
  await page.waitForSelector('[aria-label="Input I0.0 Level_High"][aria-checked=true]');
  await page.waitForSelector('[aria-label="Output Q0.0 on"]');
  await picture(page, 'chart_running');
});

test('after a click on an input Space is Run and Pause, and leaves the input alone', async () => {
  const on = () => page.getAttribute('[aria-label^="Input I0.5"]', 'aria-checked');
  await page.click('[aria-label^="Input I0.5"]');
  await page.waitForSelector('[aria-label^="Input I0.5"][aria-checked=true]');
  await page.keyboard.press(' ');
  await page.waitForSelector('#do-run:has-text("Pause")');
  await page.keyboard.press(' ');
  await page.waitForSelector('#do-run:has-text("Run")');
  assert.equal(await on(), 'true');
  await page.click('[aria-label^="Input I0.5"]');
  await page.waitForSelector('[aria-label^="Input I0.5"][aria-checked=false]');
});

test('a push button is on as long as it is pressed', async () => {
  await page.click('[aria-label^="Input I0.7"]', { button: 'right' });
  await page.hover('.switch.push[aria-label^="Input I0.7"]');
  await page.mouse.down();
  await page.waitForSelector('[aria-label^="Input I0.7"][aria-checked=true]');
  await page.mouse.up();
  await page.waitForSelector('[aria-label^="Input I0.7"][aria-checked=false]');
});

test('the inputs and outputs of the program are there, and what keeps a valve off is switched', async () => {
  const folder = mkdtempSync(path.join(tmpdir(), 's7200-'));
  writeFileSync(path.join(folder, 'valve.stl'), 'LD I0.0\nAN M5.0\nA I1.2\n= Q1.0\nMEND\n');
  const plant = await view(path.join(folder, 'valve.stl'));
  const other = await open(chrome, plant.address);
  await other.click('#do-scan');
  await other.click('.point-name:has-text("Q1.0")');
  await other.click('text=What keeps it so?');
  await other.waitForSelector('.obstacle [title="Switch the input I1.2"]');
  assert.match(await other.textContent('.obstacles'), /Q1\.0 is 0 since power-up, must be 1/);
  for (const address of ['I0.0', 'I1.2']) {
    await other.click(`.obstacle [title="Switch the input ${address}"]`);
    await other.waitForSelector(`.obstacle [title="Switch the input ${address}"]`, { state: 'detached' });
  }
  await other.click('#tab-chart');
  await other.waitForSelector('[aria-label="Input I1.2"][aria-checked=true]');
  for (let i = 0; i < 2; ++i) await other.click('#do-scan');
  await other.waitForSelector('[aria-label="Output Q1.0 on"]');
  assert.deepEqual(other.troubles, []);
  await other.close();
  await end(plant.server);
  rmSync(folder, { recursive: true });
});

test('a switch works while it runs as fast as it goes, and to go elsewhere ends the run', async () => {
  const folder = mkdtempSync(path.join(tmpdir(), 's7200-'));
  writeFileSync(path.join(folder, 'lamp.stl'), 'LD I0.0\n= Q0.0\nMEND\n');
  const lamp = await view(path.join(folder, 'lamp.stl')), other = await open(chrome, lamp.address);
  await other.selectOption('#pace', '0');
  await other.click('#do-run');
  for (const level of ['on', 'off', 'on']) {
    await other.click('[aria-label="Input I0.0"]');
    await other.waitForSelector(`[aria-label="Output Q0.0 ${level}"]`);
    assert.equal(await other.textContent('#do-run'), 'Pause');
  }
  await other.click('#do-start');
  await other.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run' && parseFloat(document.querySelector('#moment').value) === 0);
  await rendered(other);
  assert.equal(await other.textContent('.tag'), 'past');
  assert.deepEqual(other.troubles, []);
  await other.close();
  await end(lamp.server);
  rmSync(folder, { recursive: true });
});

test('a pulse train counts in simulated time, whatever the pace', async () => {
  const counter = await view('stl_programs/edge_counter.stl');
  const other = await open(chrome, counter.address);
  const input = other.locator('[aria-label^="Input I0.0"]');
  await input.click({ button: 'right' });
  await input.click({ button: 'right' });
  await other.waitForFunction(() => document.activeElement?.classList.contains('hertz'));
  await other.keyboard.type('25');
  await other.keyboard.press('Enter');
  assert.equal(await other.inputValue('[aria-label="Pulses a second at I0.0"]'), '25 Hz');
  await rendered(other);
  await other.fill('[aria-label="Pulses a second at I0.0"]', '2000');
  await other.keyboard.press('Enter');
  await other.waitForSelector('.notice.error:has-text("from 0.01 to 1000")');
  await rendered(other);
  await other.fill('[aria-label="Pulses a second at I0.0"]', '100');
  await other.press('[aria-label="Pulses a second at I0.0"]', 'Enter');
  await other.waitForSelector('.notice', { state: 'detached' });
  await input.click();
  await other.waitForSelector('[aria-label^="Input I0.0"][aria-checked=true]');
  await picture(other, 'chart_pulses');
  await other.fill('#add-address', 'VW0');
  await other.press('#add-address', 'Enter');
  await other.selectOption('#pace', '0.1');
  await other.click('#do-run');
  await other.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 150);
  await other.click('#do-run');
  await other.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
  const ms = parseFloat(await other.inputValue('#moment'));
  const [least, most] = [ms - 2, ms].map((end) => Math.floor(end / 10));  // an edge is counted two scans later, that is within 2 ms
  await other.waitForFunction(([least, most]) => {
    const counted = Number(document.querySelector('.chart .current').textContent);
    return counted >= least && counted <= most;
  }, [least, most]);
  await input.click();
  await other.waitForSelector('[aria-label^="Input I0.0"][aria-checked=false]');
  assert.deepEqual(other.troubles, []);
  await other.close();
  await end(counter.server);
});

test('an analog input is turned with a slider', async () => {
  await add('AIW4');
  const slider = page.locator('[aria-label="Analog input AIW4"]');
  await slider.fill('16000');
  await shows(4, '16000');
  await page.click('[aria-label="Force AIW4"]');
  await page.waitForSelector('[aria-label="Analog input AIW4"]:disabled');
  assert.match(await slider.getAttribute('title'), /^AIW4 is forced/);
  await page.click('[aria-label="Force AIW4"]');
  await page.waitForSelector('[aria-label="Analog input AIW4"]:enabled');
  await page.click('[aria-label="Remove AIW4"]');
});

test('the rows of a pasted status chart are added', async () => {
  await page.evaluate(() => {
    const clipboardData = new DataTransfer();
    clipboardData.setData('text', 'Address\tFormat\nVB200\tASCII\nVW100\tHexadecimal\n');
    document.querySelector('#add-address').dispatchEvent(new ClipboardEvent('paste', { clipboardData, bubbles: true, cancelable: true }));
  });
  await shows(4, "'P'");
  await shows(5, '16#0010');
  for (const address of ['VB200', 'VW100']) await page.click(`[aria-label="Remove ${address}"]`);
});

test('what is forced has its mark and colour until it is released', async () => {
  await page.locator('.new-value').nth(1).fill('0');
  await page.click('[aria-label="Force Pump"]');
  await page.waitForSelector('tr.forced');
  await page.click('#do-scan');
  await page.waitForSelector('[aria-label="Output Q0.0 off, forced"]');
  await picture(page, 'chart_forced');
  await page.click('text=Unforce all');
  await page.waitForSelector('tr.forced', { state: 'detached' });
});

test('the chart is there again after the page was loaded anew', async () => {
  await page.reload();
  await page.waitForSelector('.connection.connected');
  await shows(0, '16');
  assert.equal(await page.locator('.chart tbody tr').count(), 4);
  assert.deepEqual(page.troubles, []);
});
