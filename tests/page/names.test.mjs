// What stands in files is text: names, comments and file names that look like markup, turn the direction of text, or are very long.
import assert from 'node:assert/strict';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { browser, end, kPhone, open, picture, rendered, view } from './support.mjs';

const kMarkup = `<img src=x onerror="window.hit=1">`;
const kTurned = '\u202Eneposs\u202C \u2067abc\u2069';
const kLong = 'x'.repeat(10000);
const kRows = 3000;
const kSource = process.env.SOURCE;

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

const kHostile = ['Q0.0; quit', '01 03; quit', '"; quit', `x"; quit`, `'; quit`, `'a\\'; quit`, `"a\\"; quit`, '#; quit', '#', '#all', '//', 'all'];

/** All commands of the page from now on that are not queries of its own. */
const sent_by = (page) => {
  const sent = [];
  page.on('websocket', (socket) => socket.on('framesent', ({ payload }) => sent.push(JSON.parse(payload).command)));
  return sent;
};

/** Whether a line is more than one command: quotations count as none of it. */
const is_more = (line) => /;|\/\/|["\n]/.test(line.replace(/(?<=^|\s)("[^"\\]*"|'[^']*')/g, 'x'));

/** Rows of a chart are typed where rows are added; the last one is there until it is removed. */
async function in_chart(page, text, does) {
  await page.fill('#add-address', text);
  await page.press('#add-address', 'Enter');
  await page.waitForFunction((wanted) => [...document.querySelectorAll('.chart .address')].at(-1)?.value === wanted, text);
  await does(page.locator('.chart tbody tr').last());
  await page.keyboard.press('Escape');
  await page.click('#tab-chart');
  await page.locator('.chart tbody tr').last().locator('[title=Remove]').click();
  await rendered(page);
}

test('whatever is typed or in a file is one word of a command: no other command comes of it', async () => {
  const file = path.join(folder, 'written.txt').replaceAll('\\', '/'), program = path.join(folder, 'plain.awl'), table = path.join(folder, 'hostile.txt');
  const names = [`x; save written.txt`, 'a; quit', 'Level low', 'Fault lamp', 'all', 'not', 'a//b', 'A:B', 'Name=5', "in's", `x"; quit`];
  writeFileSync(program, 'NETWORK 1\nLD     I0.0\n=      Q0.0\nNETWORK 2\nLDW>   VW100, 5\n=      Q0.1\n');
  writeFileSync(table, `${names[0]}\tI0.0\na; quit\tQ0.0\nLevel low\tVW100\nFault lamp\tQ0.1\n${names.slice(4).map((one, i) => `${one}\tM${1 + Math.floor(i / 8)}.${i % 8}\n`).join('')}`);
  const hostile = await view(program, table, '--files');
  let sent;
  const page = await open(chrome, hostile.address, { prepare: (one) => { sent = sent_by(one); } });
  await page.click('#do-scan');
  await page.click('#tab-chart');
  const with_menu = ['x; save written.txt', 'all', 'Q0.0; quit', `'a\\'; quit`];
  const known = [...names.filter((one) => !one.includes('"')), 'fault LAMP'];
  for (const text of [...known, ...kHostile]) {
    const is_known = known.includes(text) || text === 'all';
    await in_chart(page, text, async (row) => {
      if (is_known) await row.locator('.current:has-text("0")').waitFor().catch(async () => assert.fail(`${text}: ${await row.locator('.current').innerHTML()}`));
      for (const key of ['Enter', 'Shift+Enter']) {
        await row.locator('.new-value').fill('0; quit');
        await row.locator('.new-value').press(key);
        await page.waitForSelector(is_known ? `.notice.error:has-text("is not a value")` : '.notice.error');
      }
      await row.locator('.new-value').fill('');
      await row.locator('.tools button').first().click();
      for (let i = 0; i < (with_menu.includes(text) ? 8 : 0); ++i) {
        await page.click('#tab-chart');
        await row.locator('[title="Chart, who, why"]').click();
        await page.locator('[role=menuitem]').nth(i).click({ timeout: i < 7 ? 10000 : 300 }).catch(() => page.keyboard.press('Escape'));  // of words there are fewer
        await rendered(page);
      }
    });
  }
  await page.click('#tab-chart');
  assert.equal(await page.locator('.chart tbody tr').count(), 0);
  const rows = kHostile.map((one) => `VB200\tSigned\t\t${one}\n${one}\tSigned\t\t1\n`).join('');
  await page.evaluate((text) => {
    const clipboardData = new DataTransfer();
    clipboardData.setData('text', text);
    document.querySelector('#add-address').dispatchEvent(new ClipboardEvent('paste', { clipboardData, bubbles: true, cancelable: true }));
  }, rows);
  await page.waitForFunction((all) => document.querySelectorAll('.chart tbody tr').length === all, kHostile.length + 1);
  await page.click('text=Write all');
  await page.waitForSelector(`.notice.error:has-text("'Q0.0; quit' is not a value"):has-text("more were not written")`);
  for (const text of kHostile) {
    await page.click('#tab-line');
    await page.fill('#send-text', text);
    await page.click('#do-send');
    await page.fill('#condition', text);
    await page.press('#condition', 'Enter');
    await page.fill('#find', text);
    await page.press('#find', 'Enter');
    await page.fill('#moment', text);
    await page.press('#moment', 'Enter');
    await page.click('#tab-causes');
    for (const button of ['ask-why', 'ask-why-not', 'ask-effect', 'ask-who']) {
      await page.fill('.ask input', text);
      await page.click(`#${button}`);
      await rendered(page);
    }
  }
  for (const name of ['Fault lamp', 'a; quit', 'x; save written.txt'])
    for (const [button, question] of [['ask-why', 'Why is'], ['ask-why-not', 'What keeps'], ['ask-effect', 'What came of the last change of'], ['ask-who', 'Who wrote']]) {
      await page.fill('.ask input', name);
      await page.click(`#${button}`);
      await page.waitForSelector(`.trail li:first-child .question:has-text("${question} ${name}")`);
    }
  await picture(page, 'names_hostile');
  const scan = await page.textContent('.scan-here');
  await page.click('#do-scan');
  await page.waitForFunction((before) => document.querySelector('.scan-here').textContent !== before, scan);
  assert.deepEqual(sent.filter((line) => is_more(line) || !/^[a-z]/.test(line)), []);
  assert.equal(hostile.server.exitCode, null);
  assert.equal(existsSync(path.join(kSource, 'written.txt')) || existsSync(file), false);
  assert.deepEqual(page.troubles, []);
  await page.close();
  await end(hostile.server);
});
