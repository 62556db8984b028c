// The timeline and the line: tracks, zoom, cursors, searches, a request and its answer.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { browser, end, moment, open, picture, rendered, view } from './support.mjs';

/** Two timed interrupts come at once: one waits for the other. */
const kTwoInterrupts = `LD SM0.1
MOVB 10, SMB34
MOVB 10, SMB35
ATCH 0, 10
ATCH 1, 11
ENI
MEND
INT 0
LD SM0.0
INCW VW0
INCW VW2
INCW VW4
RETI
INT 1
LD SM0.0
INCW VW6
RETI
`;
let chrome, plc, page;
before(async () => {
  [chrome, plc] = await Promise.all([browser(), view('stl_programs/modbus_slave.stl')]);
  page = await open(chrome, plc.address);
  await page.selectOption('#pace', '0');
});
after(async () => {
  await chrome?.close();
  await end(plc.server);
});

async function go(text) {
  await page.fill('#moment', text);
  await page.press('#moment', 'Enter');
}
async function run_for(ms) {
  await page.evaluate(() => document.activeElement?.blur());
  const began = await moment(page);
  await page.selectOption('#pace', '1');
  await page.click('#do-run');
  await page.waitForFunction((goal) => parseFloat(document.querySelector('#moment').value) > goal, began + ms);
  await page.click('#do-run');
  await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
}
async function send(text) {
  await page.fill('#send-text', text);
  await page.press('#send-text', 'Enter');
}
/** Where the mark of the present is drawn, as a part of the timeline's width; nothing if it is out of view. */
const present_at = () => page.$eval('#timeline', (canvas) => {
  const colour = getComputedStyle(canvas).getPropertyValue('--now').trim(), dot = document.createElement('canvas').getContext('2d');
  dot.fillStyle = colour;
  dot.fillRect(0, 0, 1, 1);
  const wanted = dot.getImageData(0, 0, 1, 1).data.join(), row = canvas.getContext('2d').getImageData(0, 1, canvas.width, 1).data;
  const found = Array.from({ length: canvas.width }, (_, x) => x).filter((x) => row.slice(4 * x, 4 * x + 4).join() === wanted);
  return found.length > 6 ? found[Math.floor(found.length / 2)] / canvas.width : null;
});
const names = () => page.$$eval('.track-name', (all) => all.map((one) => one.textContent));

/** Columns of the canvas in the row of a track that are not of the pane's colour. */
const drawn_columns = (name) => page.evaluate((name) => {
  const canvas = document.querySelector('#timeline'), row = [...document.querySelectorAll('.track-name')].find((one) => one.textContent === name);
  if (!row) return 0;
  const y = row.getBoundingClientRect().bottom - canvas.getBoundingClientRect().top - 3;
  const pixels = canvas.getContext('2d').getImageData(0, Math.round(y * devicePixelRatio), canvas.width, 1).data;
  return Array.from({ length: canvas.width }, (_, x) => x).filter((x) => pixels[4 * x] < 0xd0).length / canvas.width;
}, name);

test('the timeline says when nothing has run yet, and is not blank while a run goes on', async () => {
  assert.match(await page.textContent('.nothing-yet'), /Nothing has run yet/);
  await page.selectOption('#pace', '1');
  await page.click('#do-run');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 600);
  for (let i = 0; i < 5; ++i) {
    const part = await drawn_columns('scans');
    assert.ok(part > 0.7, `${part} of the timeline has scans`);
    assert.ok(await present_at() > 0.7);
    await page.waitForTimeout(120);
  }
  await page.click('#do-run');
  await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
  assert.equal(await page.locator('.nothing-yet').count(), 0);
});

test('a request that is sent is answered: the table has both and the latency', async () => {
  await run_for(200);
  await page.click('#tab-line');
  await send('01 03 00 0a 00 02 crc');
  await run_for(150);
  await page.waitForFunction(() => document.querySelectorAll('.exchanges tbody tr').length === 1);
  const text = await page.textContent('.exchanges tbody');
  assert.match(text, /01 03 00 0a 00 02/);
  assert.match(text, /01 03 04/);
  assert.match(text, /ms/);
  await picture(page, 'line_answered');
});

test('a request of Modbus in words, and one with a wrong CRC, which has no answer', async () => {
  await send('read 40011:2');
  await run_for(150);
  await send('01 03 00 0a 00 02 00 00');
  await run_for(1600);
  await page.waitForFunction(() => document.querySelectorAll('.exchanges tbody tr').length === 3);
  await page.waitForSelector('.exchanges tr.trouble');
  assert.match(await page.textContent('.exchanges tr.trouble'), /no answer/);
});

test('a request without an answer says what kept the program from one', async () => {
  await page.click('.exchanges .why');
  await page.waitForSelector('.trail li');
  const said = await page.textContent('.trail');
  assert.match(said, /Why has 01 03 00 0a 00 02 00 00 no answer\?/);
  assert.match(said, /JMP 255 in line 141/);
  await picture(page, 'line_why');
});

test('characters, frames and interrupts are tracks of the timeline', async () => {
  await page.click('#timeline-all');
  await page.waitForSelector('.track-name:has-text("port 0 sent")');
  const all = await names();
  for (const name of ['port 0 received', 'port 0 sent', 'port 0 frames', 'INT 123', 'scans']) assert.ok(all.includes(name), `${name} in ${all}`);
});

test('all tracks of an exchange are in view on a laptop', async () => {
  await page.setViewportSize({ width: 1366, height: 650 });
  await page.waitForFunction(() => document.querySelectorAll('.track-name').length >= 11);
  const hidden = await page.$eval('.tracks', (tracks) => [...tracks.querySelectorAll('.track-name')].filter((one) => one.getBoundingClientRect().bottom > tracks.getBoundingClientRect().bottom).length);
  assert.equal(hidden, 0);
  assert.ok(await page.$eval('.program', (program) => program.clientHeight > 240), 'and there is room for the program');
});

test('the search goes to the request without an answer', async () => {
  await page.keyboard.press('Escape');
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('Home');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) === 0);
  await page.keyboard.press('u');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 300);
  await page.click('#tab-causes');
  await page.keyboard.press('Escape');
  assert.ok(await moment(page) > 300);
});

test('the longest answer of the whole past is gone to', async () => {
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('Shift+L');
  await page.waitForSelector('.notice:has-text("The longest of 2 answers: after 15.")');
  const said = await page.textContent('.trail li');
  assert.match(said, /^What did the answer to 01 03 00 0a 00 02 .* wait for\?/);
  assert.match(said, /began 15\.\d+ ms after the end of the request/);
  assert.match(said, /INT 12\d/, 'the interrupt that let it through');
});

test('what led here is a list of what was done, and its moments lead there', async () => {
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('End');
  await page.click('#tab-causes');
  await page.waitForFunction(() => document.querySelectorAll('.led-here tbody tr').length === 3);
  const all = await page.$$eval('.led-here .frame', (cells) => cells.map((one) => one.textContent));
  assert.equal(all[0], 'send 01 03 00 0a 00 02 00 00', 'the newest first');
  await picture(page, 'led_here');
  await page.locator('.led-here .link').last().click();
  await page.waitForFunction(() => document.querySelectorAll('.led-here tbody tr').length < 3);
});

test('the wheel zooms at the pointer, a click goes to the moment there', async () => {
  await page.click('#timeline-all');
  await page.waitForTimeout(300);
  const readout = async () => page.textContent('.readout');
  const before_zoom = await readout();
  const box = await page.locator('#timeline').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + 8);
  await page.mouse.wheel(0, -600);
  await page.waitForFunction((text) => document.querySelector('.readout').textContent !== text, before_zoom);
  const was = await moment(page);
  await page.mouse.click(box.x + box.width / 2, box.y + box.height - 4);
  await page.waitForFunction((text) => parseFloat(document.querySelector('#moment').value) !== text, was);
  await picture(page, 'timeline_zoomed');
});

test('dragging in the ruler measures between two cursors', async () => {
  const box = await page.locator('#timeline').boundingBox();
  await page.mouse.move(box.x + 200, box.y + 8);
  await page.mouse.down();
  await page.mouse.move(box.x + 500, box.y + 8, { steps: 4 });
  await page.mouse.up();
  await rendered(page);
  await page.waitForFunction(() => /^B − A = [\d.]+ (ms|s|µs)/.test(document.querySelector('.readout').textContent));
  await picture(page, 'timeline_measured');
});

test('what is between the cursors is measured: count, shortest, average, longest, histogram', async () => {
  await page.click('#timeline-all');
  await page.click('[aria-label="Remove cursors"]');
  await page.keyboard.press('Shift+M');
  await page.waitForSelector('.measured tbody tr');
  const cells = async (name) => page.locator(`.measured tr:has(th:text-is("${name}")) td`).allTextContents();
  const frames = await cells('port 0 frames'), characters = await cells('port 0 received'), scans = await cells('scans');
  assert.equal(frames[0], '5', 'three requests and two answers');
  assert.deepEqual(characters.slice(0, 4), ['24', '1.146 ms', '1.146 ms', '1.146 ms'], '11 bits');
  const [shortest, average, longest] = scans.slice(1, 4).map((text) => parseFloat(text) * (text.endsWith('µs') ? 1 : 1000));
  assert.ok(shortest < average && average < longest, scans.join());
  assert.ok(await page.locator('.measured .histogram').count() > 3);
  await picture(page, 'timeline_measurement');
  await page.locator('.measured tr:has(th:text-is("scans")) .link').nth(1).click();
  await page.waitForSelector('.measured', { state: 'detached' });
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) === 0);
});

test('the longest scan since power-up is gone to', async () => {
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('End');
  await page.keyboard.press('Shift+C');
  await page.waitForSelector('.notice:has-text("The longest scan since power-up lasted 5")', { timeout: 60000 });
  assert.equal(await moment(page), 0, 'the first one makes a table');
});

test('a search is given up when one goes elsewhere', async () => {
  await page.keyboard.press('End');
  await page.keyboard.press('Shift+L');
  await page.keyboard.press('Home');
  await page.waitForTimeout(1000);
  assert.equal(await moment(page), 0);
});

test('an address that is watched is a wave', async () => {
  await page.click('#tab-causes');
  await page.evaluate(() => document.activeElement?.blur());
  await page.click('#tab-chart');
  await page.click('.point-name:has-text("Q0.0")');
  await page.click('[role=menuitem]:has-text("Show on the timeline")');
  await page.waitForSelector('.track-name:has-text("Q0.0")');
  await page.click('[aria-label="Remove Q0.0"]');
  await page.waitForSelector('.track-name:has-text("Q0.0")', { state: 'detached' });
});

test('a condition is searched for through the past, and by running on', async () => {
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('Home');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) === 0);
  await page.keyboard.press('x');
  await page.keyboard.type('SM4.5 = 0');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 200);
  await page.waitForSelector('.tag.past');
  await page.fill('#condition', 'VB0 = 77');
  await page.press('#condition', 'Enter');
  await page.waitForSelector('.notice:has-text("VB0 = 77 does not come to hold within")');
  await page.fill('#condition', 'VW0 >');
  await page.press('#condition', 'Enter');
  await page.waitForSelector('.notice.error');
  for (const none of ['abc', 'VW0']) {
    await page.fill('#condition', none);
    await page.press('#condition', 'Enter');
    await page.waitForSelector(`.notice.error:has-text("'${none}' is not a condition; write for example VW20 > 5")`);
  }
  assert.equal(await page.locator('.margin.stop').count(), 0);
});

test('a damaged character is found from far away', async () => {
  await page.keyboard.press('Escape');
  await page.keyboard.press('End');
  await page.waitForSelector('.tag.now');
  await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
  await page.click('#tab-line');
  await send('01 03p 00 0a 00 01 crc');
  await run_for(150);
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('Home');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) === 0);
  await page.keyboard.press('0');
  await page.keyboard.press('e');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 1000);
  await picture(page, 'timeline_damaged');
  assert.deepEqual(page.troubles, []);
});

test('the line says how the port is set up at the moment that is looked at', async () => {
  await page.click('#tab-line');
  await page.waitForFunction(() => document.querySelector('.port').textContent === 'Port 0: Freeport, 9600 baud, 8 data bits, even parity, 1 stop bit (SMB30 = 16#49 now); what is sent here has the same format');
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('Home');
  await page.waitForFunction(() => /^Port 0: PPI slave \(SMB30 = 16#00 now\)/.test(document.querySelector('.port').textContent));
});

test('what is refused is said in few words, until the next is not; what is sent waits for Run', async () => {
  await page.keyboard.press('Escape');
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('End');
  await page.waitForSelector('.tag.now');
  await page.click('#tab-line');
  await run_for(1500);
  await send('zz');
  await page.waitForSelector('.notice.error');
  assert.equal(await page.textContent('.notice.error span'), "column 1: 'z' is not a hex digit");
  await send('read 40011:1');
  await page.waitForSelector('.exchanges tr.waits:has-text("read 40011:1")');
  assert.match(await page.textContent('.exchanges tr.waits'), /waits for Run/);
  assert.equal(await page.locator('.notice').count(), 0);
  await send('read 40011:2');
  await page.waitForSelector('.notice.error:has-text("The last frame is still under way or waiting for its answer: Run on first")');
  await run_for(150);
  await page.waitForSelector('.exchanges tr.waits', { state: 'detached' });
});

test('a condition is searched for beyond the answers on the way', async () => {
  await send('write 40011=77');
  await run_for(150);
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('Home');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) === 0);
  await page.fill('#condition', 'VW20 = 77');
  await page.press('#condition', 'Enter');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 1500);
  assert.equal(await page.textContent('.tag'), 'past');
  assert.equal(await page.locator('.notice').count(), 0);
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('End');
  await page.waitForSelector('.tag.now');
});

test('who goes elsewhere while a condition is searched for stays there', async () => {
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('Home');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) === 0);
  await page.fill('#condition', 'VW20 = 4242');
  await page.press('#condition', 'Enter');
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('End');
  await page.waitForSelector('.tag.now');
  await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
  await page.waitForTimeout(300);
  assert.equal(await page.locator('.tag.now').count(), 1);
  assert.equal(await page.locator('.notice').count(), 0);
});

test('an interrupt is gone to; where there is none the page says so and stays', async () => {
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('Shift+I');
  await page.waitForSelector('.tag.past');
  await rendered(page);
  assert.ok(await moment(page) > 100);
  await page.keyboard.press('Home');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) === 0);
  await page.keyboard.press('s');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 0);
  const before = await page.inputValue('#moment');
  await page.keyboard.press('Shift+I');
  await page.waitForSelector('.notice:has-text("No interrupt before this moment")');
  assert.equal(await page.inputValue('#moment'), before);
  await page.keyboard.press('Escape');
  await page.waitForSelector('.notice', { state: 'detached' });
});

test('the present is in view, with room, at the end of the past and wherever a search leads', async () => {
  const is_seen = async (what) => {
    let at = null;
    for (let i = 0; i < 50 && !(at > 0.01 && at < 0.99); ++i) {
      await page.waitForTimeout(100);
      at = await present_at();
    }
    assert.ok(at !== null && at > 0.01 && at < 0.99, `${what}: ${at}`);
  };
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('End');
  await page.waitForSelector('.tag.now');
  await page.keyboard.press('0');
  await is_seen('the whole past, at its end');
  for (let i = 0; i < 9; ++i) await page.keyboard.press('+');
  for (let i = 0; i < 30; ++i) await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('Shift+L');
  await page.waitForSelector('.notice:has-text("longest of")');
  await is_seen('the longest answer');
  await page.keyboard.press('End');
  await is_seen('the newest moment');
  for (let i = 0; i < 30; ++i) await page.keyboard.press('ArrowLeft');
  await page.click('#tab-line');
  await page.click('.exchanges tr.trouble .why');
  await page.waitForSelector('.trail li:has-text("no answer?")');
  await is_seen('what kept a request from an answer');
});

const kLoops = 'LD SM0.0\nINCW VW10\nLBL 1\nLDW>= VW10, 50\nJMP 1\nMEND\n';

test('the watchdog that ends the past is found, and the longest scan however short it is', async () => {
  const folder = mkdtempSync(path.join(tmpdir(), 's7200-'));
  writeFileSync(path.join(folder, 'loops.stl'), kLoops);
  const loops = await view(path.join(folder, 'loops.stl')), page = await open(chrome, loops.address);
  const said = (words) => page.waitForFunction((words) => new RegExp(words).test(document.querySelector('.notice span')?.textContent), words.source);
  await page.keyboard.press('s');
  await page.keyboard.press('s');
  await page.waitForFunction(() => document.querySelector('.scan-number').textContent === 'scan 3');
  await page.keyboard.press('Shift+C');
  await said(/^The longest scan since power-up lasted [\d.]+ µs: scan 1\./);
  await page.keyboard.press('End');
  await page.waitForSelector('.tag.now');
  await page.fill('#moment', '2s');
  await page.press('#moment', 'Enter');
  await page.waitForSelector('.lamp.fault.on');
  await page.keyboard.press('Home');
  await page.waitForSelector('.tag.past');
  await page.keyboard.press('e');
  await page.waitForSelector('.notice:has-text("watchdog")');
  await page.waitForSelector('.lamp.fault.on');
  assert.match(await page.innerText('.status-bar .place'), /^STOP, fatal error 3 in main, line \d$/);
  await page.keyboard.press('Shift+C');
  await said(/lasted 3[\d.]+ ms: scan 50\./);
  assert.deepEqual(page.troubles, []);
  await page.close();
  await end(loops.server);
  rmSync(folder, { recursive: true });
});

test('the whole reason why an interrupt has waited stands beside the pointer', async () => {
  const folder = mkdtempSync(path.join(tmpdir(), 's7200-'));
  writeFileSync(path.join(folder, 'two.stl'), kTwoInterrupts);
  const both = await view(path.join(folder, 'two.stl')), page = await open(chrome, both.address, { viewport: { width: 1000, height: 650 } });
  await page.fill('#moment', '101ms');
  await page.press('#moment', 'Enter');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 100);
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('Shift+I');
  await page.waitForSelector('.status-bar .place:has-text("INT 1")');
  await page.waitForSelector('.track-name:has-text("INT 1")');
  for (let i = 0; i < 8; ++i) await page.keyboard.press('+');
  await page.waitForFunction(() => document.querySelector('.readout').textContent.endsWith('µs in view'));
  const { left, width } = await page.$eval('#timeline', (canvas) => canvas.getBoundingClientRect().toJSON());
  const y = await page.$eval('.track-name:has-text("INT 1")', (name) => name.getBoundingClientRect().top + 7);
  for (let i = 0; i < 40 && await page.locator('.tip').isHidden(); ++i) {
    await page.mouse.move(left + width * (0.99 - i / 100), y);
    await page.waitForTimeout(100);
  }
  assert.match(await page.innerText('.tip'), /^INT 1\nINT 1: event 11 \(timed interrupt 1, SMB35\)\nat [\d.]+ ms\n[\d.]+ µs\nwaited [\d.]+ µs\n.*INT 0/);
  const tip = await page.locator('.tip').boundingBox();
  assert.ok(tip.x >= 0 && tip.x + tip.width <= 1000 && tip.y >= 0 && tip.y + tip.height <= 650, JSON.stringify(tip));
  await picture(page, 'timeline_tip');
  await page.mouse.move(left + width / 2, 20);
  await page.waitForSelector('.tip', { state: 'hidden' });
  assert.deepEqual(page.troubles, []);
  await page.close();
  await end(both.server);
  rmSync(folder, { recursive: true });
});
