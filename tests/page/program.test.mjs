// Program status: the listing, power flow and values, breakpoints, the menu of an address.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { browser, end, moment, open, picture, rendered, view } from './support.mjs';

const kPump = ['tests/exports/pump.awl', 'tests/exports/pump_symbols.txt', 'tests/exports/pump_data.txt'];
const kFolder = mkdtempSync(path.join(os.tmpdir(), 'page-'));
let chrome;
const servers = [];
async function start(...words) {
  const plc = await view(...words);
  servers.push(plc.server);
  return plc.address;
}
before(async () => { chrome = await browser(); });
after(async () => {
  await chrome?.close();
  await Promise.all(servers.map(end));
  rmSync(kFolder, { recursive: true });
});

const row = (page, text) => page.locator('.row', { hasText: text }).first();

test('networks and comments are there, and power flow with values once it has run', async () => {
  const page = await open(chrome, await start(...kPump));
  await page.click('#do-scan');
  await page.click('#do-scan');
  await row(page, 'Level_High').waitFor();
  await page.waitForSelector('.row.op .flow:text-matches("[01]")');
  assert.match(await row(page, 'Network 2').textContent(), /Pump/);
  assert.match(await row(page, 'LD     Level_High').locator('.values').textContent(), /Level_High=0/);
  await page.click('[aria-label^="Input I0.0"]');
  await page.click('#do-scan');
  await page.click('#do-scan');
  await page.waitForFunction(() => [...document.querySelectorAll('.row')].some((one) => /LD\s+Level_High/.test(one.textContent) && /Level_High=1/.test(one.textContent)));
  assert.ok(await row(page, 'LD     Level_High').locator('.operand.on').count() > 0);
  await picture(page, 'program_flow');
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('the status bar says values as listing, ladder and chart do', async () => {
  const program = path.join(kFolder, 'moves.awl');
  writeFileSync(program, 'NETWORK 1\nLD     SM0.0\nMOVW   4660, VW100\nMEND\n');
  const page = await open(chrome, await start(program));
  await page.fill('#add-address', 'VW100');
  await page.press('#add-address', 'Enter');
  const shown = (text) => Promise.all([page.waitForFunction((text) => document.querySelector('.printed').textContent.includes(`VW100=${text}`), text),
    page.waitForSelector(`.row .value:has-text("VW100=${text}")`)]);
  await page.click('#do-step');
  await page.click('#do-step');
  await shown('4660');
  await page.selectOption('[aria-label="Format of VW100"]', 'hex');
  await shown('16#1234');
  await page.click('text=LAD');
  await page.waitForSelector('.ladder-values:has-text("VW100=16#1234")');
  await page.close();
});

test('a CALL with parameters shows the values of its inputs', async () => {
  const program = path.join(kFolder, 'parameters.awl');
  writeFileSync(program, `ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD     SM0.0\nMOVW   4660, VW0\nCALL   SBR0, VW0, I0.0, VW10\nEND_ORGANIZATION_BLOCK
SUBROUTINE_BLOCK SBR_0:SBR0\nVAR_INPUT\na:INT;\nb:BOOL;\nEND_VAR\nVAR_OUTPUT\nc:INT;\nEND_VAR\nBEGIN\nNetwork 1\nLD     #b\nMOVW   #a, #c\nEND_SUBROUTINE_BLOCK\n`);
  const page = await open(chrome, await start(program));
  await page.click('#do-scan');
  await page.click('#do-scan');
  await row(page, 'CALL').locator('.value:has-text("VW0=4660")').waitFor();
  await row(page, 'CALL').locator('.value:has-text("I0.0=0")').waitFor();
  await picture(page, 'program_call');
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('further files have their names in the listing, their own line numbers, and are jumped to', async () => {
  const page = await open(chrome, await start(...kPump));
  await page.selectOption('.navigator', { label: kPump[1] });
  const first = page.locator('.row.file-begin', { hasText: 'Symbol' });
  await first.waitFor();
  assert.match(await first.locator('.file-name').textContent(), /pump_symbols\.txt$/);
  assert.equal(await first.locator('.number').textContent(), '1');
  assert.equal(await row(page, 'Always_On\tSM0.0').locator('.number').textContent(), '2');
  assert.equal(await page.locator('.row', { hasText: 'END_INTERRUPT_BLOCK' }).locator('.number').textContent(), '63');
  await picture(page, 'program_files');
  await page.close();
});

test('a click in the margin sets a breakpoint, and the run stops there', async () => {
  const page = await open(chrome, await start(...kPump));
  const wanted = row(page, 'INCD');
  await page.fill('#find', 'INCD');
  await page.press('#find', 'Enter');
  await wanted.waitFor();
  await wanted.locator('.margin').click();
  await wanted.locator('.margin.stop').waitFor();
  await page.selectOption('#pace', '0');
  await page.click('#do-run');
  await page.waitForSelector('.row.here:has-text("INCD")', { timeout: 10000 });
  assert.equal(await page.textContent('#do-run'), 'Run');
  assert.match(await page.textContent('.notice'), /^breakpoint 1, hit for the first time/);
  assert.ok(Math.abs(await moment(page) - 50) < 2, 'the timed interrupt comes each 50 ms');
  await wanted.locator('.margin').click();
  await page.waitForFunction(() => !document.querySelector('.margin.stop'));
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('what keeps an output off is a tree of contacts, and an input in it can be switched there', async () => {
  const page = await open(chrome, await start(...kPump));
  await page.click('#do-run');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 100);
  await page.click('#do-run');
  await page.fill('#find', 'Pump');
  await page.press('#find', 'Enter');
  await page.waitForSelector('.row.selected .operand', { timeout: 5000 });
  await page.click('.point-name:has-text("Q0.0")');
  await page.click('[role=menuitem]:has-text("What keeps it so?")');
  await page.waitForSelector('.obstacles');
  const said = await page.textContent('.trail li');
  assert.match(said, /^What keeps Pump \(Q0\.0\) off\?/);
  assert.match(said, /contacts? ha(s|ve) to change/);
  await picture(page, 'program_obstacles');
  const switches = page.locator('.obstacle .why');
  for (let left = await switches.count(); left > 0; --left) {  // one that is switched says so in place of its button
    await switches.first().click();
    await page.waitForFunction((count) => document.querySelectorAll('.obstacle .why').length < count, left);
  }
  await page.click('#do-scan');
  await page.click('#do-scan');
  await page.click('#tab-chart');
  await page.waitForSelector('[aria-label="Output Q0.0 on"]');
  await page.click('#tab-causes');
  await page.fill('.ask input', 'I0.0');
  await page.click('#ask-effect');
  await page.waitForFunction(() => /^What came of the last change of /.test(document.querySelector('.trail li')?.textContent ?? ''));
  assert.match(await page.textContent('.trail li'), /became 1, at [^]*unlike the same run in which it stays 0:[^]*Pump \(Q0\.0\) is 1, not 0/);
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('a fatal error is said, the SF lamp is on, and one can go back to before it', async () => {
  const program = path.join(kFolder, 'loop.awl');
  writeFileSync(program, 'NETWORK 1\nLBL    1\nLD     I0.1\nJMP    1\nMEND\n');
  const page = await open(chrome, await start(program));
  await page.click('#do-scan');
  await page.click('[aria-label^="Input I0.1"]');
  await page.click('#do-run');
  await page.waitForSelector('.notice.error');
  assert.match(await page.textContent('.notice.error'), /fatal error/);
  await page.waitForSelector('.lamp.fault.on');
  await page.keyboard.press('Shift+S');
  await page.waitForSelector('.lamp.fault:not(.on)');
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('a click on an address opens its menu, which leads to chart, who and why', async () => {
  const page = await open(chrome, await start(...kPump));
  await page.click('#do-scan');
  await page.click('#do-scan');
  await row(page, '=      Pump').locator('.operand').click();
  await page.click('[role=menuitem]:has-text("Add to status chart")');
  await page.waitForSelector('.chart tbody tr');
  await row(page, '=      Pump').locator('.operand').click();
  await page.click('[role=menuitem]:has-text("Who wrote it last")');
  await page.waitForSelector('.trail li');
  assert.match(await page.textContent('.trail'), /Q0\.0/);
  assert.deepEqual(page.troubles, []);
  await page.close();
});

/** How many pixels of the timeline's canvas have the colour of the present, left of it. */
const marked = (page) => page.evaluate(() => {
  const canvas = document.querySelector('#timeline'), { data, width } = canvas.getContext('2d').getImageData(0, 24, canvas.width * 0.9, canvas.height - 24);
  const probe = document.createElement('canvas').getContext('2d');
  probe.fillStyle = getComputedStyle(canvas).getPropertyValue('--now').trim();
  probe.fillRect(0, 0, 1, 1);
  const [red, green, blue] = probe.getImageData(0, 0, 1, 1).data;
  let count = 0;
  for (let i = 0; i < data.length; i += 4) if (data[i] === red && data[i + 1] === green && data[i + 2] === blue) ++count;
  return width > 0 ? count : -1;
});

test('a click on a line shows its executions: the last one in words, its network on the timeline, the ways to others', async () => {
  const program = path.join(kFolder, 'lines.awl');
  writeFileSync(program, 'NETWORK 1\nLD     SM0.1\nMOVW   1, VW100\nNETWORK 2\nLD     I0.0\nCALL   SBR0\nMEND\nSBR    0\nNETWORK 3\nLD     SM0.0\nS      V10.0, 1\nRET\n');
  const page = await open(chrome, await start(program));
  for (let i = 0; i < 4; ++i) await page.click('#do-scan');
  await page.waitForSelector('.scan-number:has-text("scan 5")');
  assert.equal(await marked(page), 0);
  await row(page, 'MOVW').locator('.text').click({ position: { x: 400, y: 8 } });

  await page.waitForSelector('.line-here span:text-matches("line 3: executed last at [0-9.]+ ms")');
  await rendered(page);
  assert.ok(await marked(page) > 20);
  await picture(page, 'program_line');
  const now = await moment(page);
  await page.click('#timeline-line-before');
  await page.waitForFunction((before) => parseFloat(document.querySelector('#moment').value) < before, now);
  await page.waitForSelector('.row.here:has-text("MOVW")');
  const last = await moment(page);
  await page.click('#timeline-line-before');
  await page.waitForFunction((before) => parseFloat(document.querySelector('#moment').value) < before, last);
  await page.click('#timeline-line-after');
  await page.waitForFunction((wanted) => parseFloat(document.querySelector('#moment').value) === wanted, last);
  await row(page, 'V10.0').locator('.text').click({ position: { x: 400, y: 8 } });
  await page.waitForSelector('.line-here:has-text("line 11: never executed up to this moment")');
  for (const [way, told] of [['before', 'Line 11 was not executed before this moment'], ['after', 'Line 11 is not executed in the next 10 s']]) {
    await page.click(`#timeline-line-${way}`);
    await page.waitForSelector(`.notice:has-text("${told}")`);
    assert.equal(await moment(page), last);
  }
  await row(page, 'V10.0').locator('.text').dblclick({ position: { x: 400, y: 8 } });
  await page.waitForSelector('.notice:has-text("Line 11: never executed up to this moment")');
  await page.click('[aria-label="Select no line"]');
  await page.waitForSelector('.line-here', { state: 'detached' });
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('what keeps a word so is no question of bits, which is said', async () => {
  const page = await open(chrome, await start(...kPump));
  await page.click('#tab-causes');
  await page.fill('.ask input', 'Longest_Run');
  await page.click('#ask-why-not');
  await page.waitForSelector('.notice.error span:text-matches("^Longest_Run .*is not a bit")');
  await page.fill('.ask input', 'Level low');
  await page.click('#ask-why-not');
  await page.waitForSelector('.trail .question:has-text("What keeps Level low")');
  assert.equal(await page.locator('.trail li').count(), 1);
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('where an address is used is a list of lines, which lead there', async () => {
  const page = await open(chrome, await start(...kPump));
  await row(page, '=      Pump').locator('.operand').click();
  await page.click('[role=menuitem]:has-text("Where is it used?")');
  await page.waitForSelector('.trail .question:has-text("Where is Pump (Q0.0) used?")');
  assert.match(await page.textContent('.trail li:first-child pre'), /line 14: O +Pump.*line 17: = +Pump/s);
  await picture(page, 'program_cross_reference');
  await page.click('.trail button:text-is("line 14")');
  await page.waitForSelector('.row.selected:has-text("O      Pump")');
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('that a run stops when an address changes is seen, once, and taken back, after the page was loaded anew too', async () => {
  const page = await open(chrome, await start(...kPump));
  const choose = async (text, from = row(page, '=      Pump').locator('.operand')) => {
    await from.click();
    await page.click(`[role=menuitem]:text-is("${text}")`);
  };
  await choose('Stop when it changes');
  await page.waitForSelector('.notice:has-text("A run stops when Q0.0 changes")');
  await page.waitForSelector('.watches .watch:has-text("Q0.0")');
  await picture(page, 'program_watch');
  await page.reload();
  await page.waitForSelector('.watches .watch:has-text("Q0.0")');
  await row(page, '=      Pump').waitFor();
  await choose('No longer stop when it changes');
  await page.waitForSelector('.watches', { state: 'detached' });
  await page.fill('#add-address', 'Pump');
  await page.press('#add-address', 'Enter');
  await choose('Stop when it changes', page.locator('[aria-label="Menu of Pump"]'));
  await page.waitForSelector('.watches .watch:has-text("Q0.0")');
  await page.click('[aria-label^="Input I0.1"]');
  await page.click('[aria-label^="Input I0.0"]');
  await page.keyboard.press('F5');
  await page.waitForSelector('.notice:has-text("Q0.0")');
  assert.ok(await moment(page) < 1000);
  await page.click('[aria-label="No longer stop when Q0.0 changes"]');
  await page.waitForSelector('.watches', { state: 'detached' });
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('the keyboard reaches lines, breakpoints and the menus of addresses', async () => {
  const page = await open(chrome, await start(...kPump));
  await page.keyboard.press('1');
  await page.focus('.listing');
  await row(page, 'LD     First_Scan').click();
  await page.focus('.listing');
  await page.keyboard.press('ArrowDown');
  await page.waitForSelector('.row.selected:has-text("CALL")');
  await page.keyboard.press('b');
  await page.waitForSelector('.row.selected .margin.stop');
  for (let i = 0; i < 3; ++i) await page.keyboard.press('ArrowDown');
  await page.waitForSelector('.row.selected:has-text("Level_High")');
  await page.focus('.row.selected .operand');
  await page.keyboard.press('Enter');
  await page.waitForSelector('[role=menu]');
  await page.keyboard.press('ArrowDown');
  assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Show on the timeline');
  await page.keyboard.press('Escape');
  await page.waitForSelector('[role=menu]', { state: 'detached' });
  assert.ok(await page.evaluate(() => document.activeElement.classList.contains('operand')));
  await page.close();
});

test('the ladder has the power flow of the moment, and its addresses have their menus', async () => {
  const page = await open(chrome, await start(...kPump));
  for (const name of ['I0.1', 'I0.0']) await page.click(`[aria-label^="Input ${name}"]`);
  for (let i = 0; i < 3; ++i) await page.click('#do-scan');
  await page.click('text=LAD');
  const pump = page.locator('.ladder-network', { hasText: 'network 2: Pump' });
  await pump.locator('svg').waitFor();
  await page.waitForFunction(() => {
    const network = [...document.querySelectorAll('.ladder-network')].find((one) => one.textContent.includes('network 2: Pump'));
    return network.querySelectorAll('g.on').length === 5 && network.querySelectorAll('.closed').length === 4;
  });
  await picture(page, 'program_ladder');
  await page.keyboard.press('Home');
  await page.waitForFunction(() => document.querySelectorAll('.ladder .closed').length === 0);
  await pump.locator('text.address:has-text("Q0.0")').last().click();
  await page.waitForSelector('[role=menu][aria-label="Q0.0"]');
  await page.keyboard.press('Escape');
  await page.selectOption('.navigator', { label: 'INT 0' });
  await page.locator('.ladder-network', { hasText: 'INT 0, network 1' }).locator('svg').waitFor();
  await page.evaluate(() => document.activeElement.blur());
  assert.equal(await page.getAttribute('.toggle:text-is("Follow")', 'aria-pressed'), 'true');
  await page.keyboard.press('.');
  await page.waitForFunction(() => {
    const here = document.querySelector('.ladder-network.here')?.getBoundingClientRect(), seen = document.querySelector('.ladders').getBoundingClientRect();
    return here && here.top >= seen.top - 1 && here.top < seen.bottom;
  });
  await page.keyboard.press('v');
  await page.waitForSelector('.row');
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('a network that is chosen stands at the top of the ladder, however high those above it are', async () => {
  const page = await open(chrome, await start('stl_programs/gateway_pc1200_modbus.stl'));
  await page.click('text=LAD');
  const lines = await page.$$eval('.navigator optgroup option', (all) => all.map((one) => one.value));
  for (const line of [lines.at(-20), lines[6], lines[3]]) {
    await page.selectOption('.navigator', line);
    await page.waitForFunction((line) => {
      const network = document.querySelector(`#network-${line}`);
      return network && Math.abs(network.getBoundingClientRect().top - document.querySelector('.ladders').getBoundingClientRect().top) < 3;
    }, line);
    await page.waitForTimeout(300);
    assert.ok(await page.evaluate((line) => document.querySelector(`#network-${line}`).getBoundingClientRect().top < 300, line), 'and stays there');
  }
  await page.close();
});

test('texts of a program and its symbols are text, never markup', async () => {
  const program = path.join(kFolder, 'hostile.awl');
  const symbols = path.join(kFolder, 'symbols.txt');
  writeFileSync(program, 'NETWORK 1 // <img src=x onerror=window.hacked=1>\nLD     "<b>bold</b>"\n=      Q0.0\nMEND\n');
  writeFileSync(symbols, 'Symbol\tAddress\tComment\n<b>bold</b>\tI0.0\t<script>window.hacked=1</script>\n');
  const page = await open(chrome, await start(program, symbols));
  await row(page, 'onerror').waitFor();
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.equal(await page.locator('.listing img, .listing b').count(), 0);
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('a program of 4000 instructions scrolls, and only what is seen is made', async () => {
  const program = path.join(kFolder, 'long.awl');
  writeFileSync(program, Array.from({ length: 1000 }, (_, i) => `NETWORK ${i + 1} // number ${i + 1}\nLD     I0.0\nA      M${i % 30}.0\nON     SM0.0\n=      M${i % 30}.1\n`).join('') + 'MEND\n');
  const page = await open(chrome, await start(program, '--cpu', '226'));
  const made = await page.locator('.row').count();
  assert.ok(made < 80, `${made} rows`);
  const frames = await page.evaluate(() => new Promise((done) => {
    const list = document.querySelector('.listing');
    const gaps = [];
    let last = performance.now(), i = 0;
    const step = () => {
      const now = performance.now();
      gaps.push(now - last);
      last = now;
      list.scrollTop += 400;
      if (++i < 60) requestAnimationFrame(step);
      else done(gaps.sort((a, b) => a - b)[30]);
    };
    requestAnimationFrame(step);
  }));
  console.log(`scrolling: ${frames.toFixed(1)} ms a frame (median)`);
  await page.evaluate(() => { document.querySelector('.listing').scrollTop = 1e6; });
  await row(page, 'MEND').waitFor();
  assert.deepEqual(page.troubles, []);
  await page.close();
});
