// Two futures, one above the other, and the reader's own marks.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { browser, end, moment, open, picture, view } from './support.mjs';

const kPump = ['tests/exports/pump.awl', 'tests/exports/pump_symbols.txt', 'tests/exports/pump_data.txt'];
let chrome, plc;
before(async () => { [chrome, plc] = await Promise.all([browser(), view(...kPump)]); });
after(async () => {
  await chrome?.close();
  await end(plc.server);
});

async function key(page, name) {
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press(name);
}

test('an input that is switched in one future only parts them', async () => {
  const page = await open(chrome, plc.address);
  await page.click('[aria-label^="Input I0.1"]');
  await page.fill('#moment', '100 ms');
  await page.press('#moment', 'Enter');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) >= 99.9);
  await page.click('.operand:has-text("Q0.0"), .operand:has-text("Pump")');
  await page.click('[role=menuitem]:has-text("Show on the timeline")');
  const began = await moment(page);
  await page.click('#timeline-compare');
  await page.waitForFunction(() => document.querySelector('#timeline-compare').textContent === 'End comparison');
  await page.waitForFunction((began) => Math.abs(parseFloat(document.querySelector('#moment').value) - began) < 1, began);
  await page.waitForSelector('.track-name.before');
  await page.waitForFunction(() => document.querySelector('.timeline .readout').textContent.includes('the same so far'));
  await page.click('[aria-label^="Input I0.0"]');
  await page.click('#timeline-second');
  await page.waitForFunction(() => /both futures part at 1\d\d\./.test(document.querySelector('.timeline .readout').textContent));
  await page.waitForSelector('[aria-label="Output Q0.0 on"]');
  await picture(page, 'futures');
  await page.fill('#find', 'Level_High');
  await page.press('#find', 'Enter');
  await page.click('.operand:has-text("Level_High")');
  await page.click('[role=menuitem]:has-text("Show on the timeline")');
  await page.waitForFunction(() => document.querySelectorAll('.track-name:has(button) + .track-name.before').length === 2);
  assert.equal(await page.textContent('.track-name:has-text("I0.0") + .track-name'), 'first future', 'what was in the chart then has its first future too');
  await page.mouse.move(5, 5);
  const parting = await page.textContent('.timeline .readout');
  const box = await page.locator('.track-name:has-text("I0.0") + .track-name').boundingBox(), canvas = await page.locator('#timeline').boundingBox();
  await page.mouse.move(canvas.x + canvas.width * 0.6, box.y + box.height / 2);
  await page.waitForFunction(() => /^first future · I0\.0/.test(document.querySelector('.timeline .readout').textContent));
  await page.mouse.move(5, 5);
  await page.evaluate(() => document.activeElement?.blur());
  for (let i = 0; i < 6; ++i) await page.keyboard.press('+');
  await page.waitForTimeout(300);
  assert.equal(await page.textContent('.timeline .readout'), parting, 'wherever one looks');
  await page.click('#timeline-compare');
  await page.waitForFunction(() => document.querySelector('.track-name.before') === null);
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('marks are set, found again and kept', async () => {
  const page = await open(chrome, plc.address);
  await page.click('#do-start');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) < 1);
  await key(page, 'n');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 0);
  const first = await moment(page);
  await key(page, 'm');
  await key(page, 's');
  await page.waitForFunction((first) => parseFloat(document.querySelector('#moment').value) > first, first);
  const second = await moment(page);
  await key(page, 'm');
  await key(page, '<');
  await page.waitForFunction((first) => Math.abs(parseFloat(document.querySelector('#moment').value) - first) < 0.001, first);
  await page.reload();
  await page.waitForSelector('.row');
  await key(page, '>');
  await page.waitForFunction((second) => Math.abs(parseFloat(document.querySelector('#moment').value) - second) < 0.001, second);
  await key(page, '>');
  await page.waitForSelector('.notice:has-text("No mark after this moment")');
  await page.close();
});
