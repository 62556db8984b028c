// What stands in files is text: names, comments and file names that look like markup, turn the direction of text, or are very long.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { browser, end, kPhone, open, picture, view } from './support.mjs';

const kMarkup = `<img src=x onerror="window.hit=1">`;
const kTurned = '\u202Eneposs\u202C \u2067abc\u2069';
const kLong = 'x'.repeat(10000);
const kRows = 3000;

let chrome, folder, plc;
before(async () => {
  chrome = await browser();
  folder = mkdtempSync(path.join(tmpdir(), `s7200 <b>'"&amp; \u202E`));
  const program = path.join(folder, `<script>window.hit=1<\u2215script> '"&\u202Elts.awl`);
  const networks = Array.from({ length: 1000 }, (_, i) => `NETWORK ${i + 3} // ${i} ${kMarkup}\nLD     V${i % 100}.1\n=      V${i % 100}.2\n`).join('');
  writeFileSync(program, `// ${kMarkup}\nNETWORK 1 // ${kMarkup} ${kTurned}\n// ${kLong}\nLD     "Start"   // ${kMarkup} ${kLong}\n=      "Valve"  // ${kTurned}\n` +
    `NETWORK 2 // ${kLong}\nLD     SM0.0\nMOVW   1, VW20\n${networks}`);
  const rows = Array.from({ length: kRows }, (_, i) => `Name_${i}\tVB${100 + i % 2000}\t${i % 3 === 0 ? kMarkup : kTurned}\n`);
  writeFileSync(path.join(folder, 'symbols.txt'), `Start\tI0.0\t${kMarkup}\nValve\tQ0.0\t${kTurned} ${kLong}\n${rows.join('')}`);
  plc = await view(program, path.join(folder, 'symbols.txt'));
});
after(async () => {
  await chrome?.close();
  await end(plc.server);
  rmSync(folder, { recursive: true });
});

/** Texts in the page that lie over each other or reach out of their pane. */
const overlaps = (page) => page.evaluate(() => {
  const wrong = [];
  const boxes = (selector) => [...document.querySelectorAll(selector)].filter((one) => one.offsetParent !== null).map((one) => ({ one, box: one.getBoundingClientRect() })).filter(({ box }) => box.width > 0);
  for (const group of ['.row', '.toolbar button', '.status-bar > *', '.point', '.pane > header > *', '.pane-tabs button', '.track-name', '.chart tbody tr']) {
    const all = boxes(group);
    all.forEach(({ one, box }, i) => {
      const next = all[i + 1];
      if (next && next.one.parentElement === one.parentElement && box.right > next.box.left + 1 && box.left < next.box.right - 1 && box.bottom > next.box.top + 1 && box.top < next.box.bottom - 1)
        wrong.push(`${group} ${i}: ${one.textContent.slice(0, 30)} and ${next.one.textContent.slice(0, 30)}`);
    });
  }
  if (document.documentElement.scrollWidth > innerWidth) wrong.push('the page is wider than the window');
  return wrong;
});

const kSizes = [{ width: 1280, height: 800 }, { width: 1920, height: 1080 }, kPhone];

test('names and comments are text, nothing runs, and nothing lies over anything else', async () => {
  for (const colorScheme of ['light', 'dark'])
    for (const viewport of kSizes) {
      const page = await open(chrome, plc.address, { viewport, colorScheme });
      await page.click('#do-scan');
      assert.deepEqual(await overlaps(page), []);
      await picture(page, `names_${viewport.width}_${colorScheme}`);
      await page.keyboard.press('v');
      await page.waitForSelector('.ladder .address');
      assert.deepEqual(await overlaps(page), []);
      await picture(page, `names_ladder_${viewport.width}_${colorScheme}`);
      for (const pane of ['2', '3', '4', '5']) {
        await page.keyboard.press(pane);
        await page.waitForTimeout(100);
        assert.deepEqual(await overlaps(page), []);
        if (viewport === kPhone) await picture(page, `names_${pane}_phone_${colorScheme}`);
      }
      await page.click('.program-name');
      await page.waitForSelector('.dialog');
      assert.equal(await page.evaluate(() => document.querySelector('.dialog').scrollWidth > document.querySelector('.dialog').clientWidth), false);
      await picture(page, `names_about_${viewport.width}_${colorScheme}`);
      assert.deepEqual([await page.evaluate(() => window.hit), await page.$$eval('img', (all) => all.length)], [undefined, 0]);
      assert.deepEqual(page.troubles, []);
      await page.close();
    }
});

test('what turns the direction of text is shown, and does not turn it', async () => {
  const page = await open(chrome, plc.address);
  await page.fill('#find', '"Valve"');
  await page.press('#find', 'Enter');
  await page.waitForSelector('.row.selected .operand');
  assert.equal(await page.evaluate(() => /[\u202a-\u202e\u2066-\u2069]/.test(document.body.textContent)), false);
  assert.match(await page.textContent('.row.selected'), /\ufffdneposs\ufffd/);
  await page.close();
});

test('a program with thousands of symbols and a thousand networks is drawn as fast as any', async () => {
  const page = await open(chrome, plc.address);
  await page.click('#do-scan');
  const ms = await page.evaluate(() => new Promise((done) => {
    const gaps = [];
    let last = performance.now();
    const step = () => {
      const now = performance.now();
      gaps.push(now - last);
      last = now;
      document.querySelector('.listing').scrollTop += 40;
      if (gaps.length < 60) requestAnimationFrame(step);
      else done(gaps.sort((a, b) => a - b)[30]);
    };
    requestAnimationFrame(step);
  }));
  console.log(`a frame while it scrolls: ${ms.toFixed(1)} ms`);
  await page.fill('#add-address', 'Name_2999');
  await page.press('#add-address', 'Enter');
  await page.waitForFunction(() => document.querySelector('.chart .current')?.textContent === '0');
  assert.deepEqual(page.troubles, []);
  await page.close();
});
