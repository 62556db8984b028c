// Several windows on one session, and what becomes of them when s7200 ends or is started again.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { browser, end, open, picture, view } from './support.mjs';

const kPump = ['tests/exports/pump.awl', 'tests/exports/pump_symbols.txt', 'tests/exports/pump_data.txt'];
let chrome, folder;
before(async () => {
  chrome = await browser();
  folder = mkdtempSync(path.join(tmpdir(), 's7200-'));
  writeFileSync(path.join(folder, 'token'), 'a-token-of-32-characters-as-it-is\n');
});
after(async () => {
  await chrome?.close();
  rmSync(folder, { recursive: true });
});

/** What both show of the session. */
const shown = (page) => page.evaluate(() => ({
  moment: document.querySelector('#moment').value, scan: document.querySelector('.scan-number').textContent,
  tag: document.querySelector('.tag').textContent, stops: document.querySelectorAll('.margin.stop').length,
  forced: document.querySelectorAll('.bulb.forced').length, on: document.querySelectorAll('.switch.on').length,
}));
/** Either may be the one that comes later. */
async function same(one, other) {
  let [wanted, there] = [await shown(one), await shown(other)];
  for (let i = 0; i < 100 && JSON.stringify(there) !== JSON.stringify(wanted); ++i) {
    await other.waitForTimeout(50);
    [wanted, there] = [await shown(one), await shown(other)];
  }
  assert.deepEqual(there, wanted);
}

test('two windows show the same, one that is loaded anew too, and one that is closed is not missed', async () => {
  const plc = await view(...kPump);
  const [one, other] = [await open(chrome, plc.address), await open(chrome, plc.address)];
  await one.fill('#add-address', 'Q0.0');
  await one.press('#add-address', 'Enter');
  await one.click('#do-scan');
  await one.click('[aria-label^="Input I0.2"]');
  await one.click('#do-scan');
  await one.click('#do-scan');
  await one.waitForSelector('[aria-label^="Input I0.2"][aria-checked=true]');
  await one.locator('.new-value').first().fill('1');
  await one.click('[aria-label="Force Q0.0"]');
  await one.waitForSelector('tr.forced');
  await other.click('.row.here .margin');
  await one.waitForSelector('.margin.stop');
  await one.click('#do-rscan');
  await one.waitForSelector('.tag.past');
  await same(one, other);
  await other.reload();
  await other.waitForSelector('.margin.stop');
  await same(one, other);
  await other.close();
  await one.click('#do-end');
  await one.waitForSelector('.tag.now');
  assert.deepEqual(one.troubles, []);
  await one.close();
  await end(plc.server);
});

test('s7200 ends at once when it is asked to, and each window says so', async () => {
  const plc = await view(...kPump);
  const [one, other] = [await open(chrome, plc.address), await open(chrome, plc.address)];
  await one.click('#do-run');
  await other.waitForFunction(() => document.querySelector('#do-run').textContent === 'Pause');
  await end(plc.server);
  for (const page of [one, other]) {
    await page.waitForSelector('.notice.error:has-text("The session has ended")');
    await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
  }
  await picture(one, 'windows_ended');
  await one.close();
  await other.close();
});

test('a window that is opened while a run follows the clock shows that it goes on', async () => {
  const live = await view('stl_programs/edge_counter.stl', '--realtime');
  const one = await open(chrome, live.address);
  await one.click('#do-run');
  const other = await open(chrome, live.address);
  for (const page of [one, other]) {
    await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Pause');
    const seen = await page.inputValue('#moment');
    await page.waitForFunction((seen) => document.querySelector('#moment').value !== seen, seen, { timeout: 1500 });
  }
  await one.click('#do-run');
  for (const page of [one, other]) await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
  await one.close();
  await other.close();
  await end(live.server);
});

const run_button = (page, text) => page.waitForFunction((text) => document.querySelector('#do-run').textContent === text, text);

test('a run is one for all windows: each sees that it goes on, none begins a second one, and Pause of any ends it', async () => {
  const plc = await view(...kPump);
  const [one, other] = [await open(chrome, plc.address), await open(chrome, plc.address)];
  await other.keyboard.press('e');
  await other.waitForSelector('.notice');
  await one.click('#do-run');
  const third = await open(chrome, plc.address);
  for (const page of [one, other, third]) await run_button(page, 'Pause');
  await other.waitForSelector('.notice', { state: 'detached' });
  const changes = await other.evaluate(() => new Promise((done) => {
    let flips = 0, last = '';
    const end = performance.now() + 500;
    const look = () => {
      const text = document.querySelector('#do-run').textContent;
      if (text !== last) ++flips;
      last = text;
      if (performance.now() < end) requestAnimationFrame(look);
      else done(flips);
    };
    look();
  }));
  assert.equal(changes, 1, 'it does not flicker');
  await other.click('#do-run');
  for (const page of [one, other, third]) await run_button(page, 'Run');
  await one.waitForTimeout(200);
  const stood = await shown(one);
  await one.waitForTimeout(300);
  assert.deepEqual(await shown(one), stood);
  await other.click('#do-run');
  await run_button(one, 'Pause');
  await one.click('#do-scan');
  for (const page of [one, other]) await run_button(page, 'Run');
  await third.click('#do-run');
  await run_button(one, 'Pause');
  await third.close();
  await run_button(one, 'Run');
  await one.close();
  await other.close();
  await end(plc.server);
});

test('a page connects to s7200 that is started at its address again, and begins anew', async () => {
  const words = [...kPump, '--token-file', path.join(folder, 'token')];
  let running = await view(...words);
  const port = new URL(running.address).port;
  const page = await open(chrome, running.address);
  await page.click('#do-scan');
  await page.click('[aria-label^="Input I0.2"]');
  await page.click('#do-scan');
  await page.fill('#moment', '2 s');
  await page.press('#moment', 'Enter');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 1999);
  for (const signal of ['SIGTERM', 'SIGKILL']) {
    running.server.kill(signal);
    await page.waitForSelector('.notice.error');
    await page.waitForSelector('.connection:not(.connected)');
    running = await view(...words, '--listen', port);
    await page.waitForSelector('.connection.connected');
    await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) === 0);
    await page.waitForSelector('.notice.info:has-text("another session")');
    await page.waitForSelector('[aria-label^="Input I0.2"][aria-checked=false]');
    await page.click('#do-scan');
    await page.waitForFunction(() => document.querySelector('.scan-number').textContent === 'scan 2');
  }
  assert.deepEqual(page.troubles.filter((one) => !/WebSocket connection/.test(one)), []);
  await page.close();
  await end(running.server);
});
