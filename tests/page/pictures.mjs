// The pictures of docs/page.md, from real runs; tests/page/pictures starts it.
import { spawnSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { browser, end, open, view } from './support.mjs';

const kPump = ['tests/exports/pump.awl', 'tests/exports/pump_symbols.txt', 'tests/exports/pump_data.txt'];
const kViewport = { width: 1366, height: 650 };
const docs = (name) => path.join(process.env.SOURCE, 'docs', name);

async function drawn(words, draw) {
  const [chrome, plc] = await Promise.all([browser(), view(...words)]);
  try {
    const page = await open(chrome, plc.address, { viewport: kViewport });
    await draw(page);
  } finally {
    await chrome.close();
    await end(plc.server);
  }
}

async function go_to(page, text) {
  await page.fill('#moment', text);
  await page.press('#moment', 'Enter');
  await page.evaluate(() => document.activeElement?.blur());
  await page.waitForTimeout(400);
}

async function run_for(page, ms) {
  const goal = parseFloat(await page.inputValue('#moment')) + ms;
  await page.click('#do-run');
  await page.waitForFunction((goal) => parseFloat(document.querySelector('#moment').value) > goal, goal);
  await page.click('#do-run');
  await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
}

/** Shows that part of the timeline: the whole past first, then what is between two moments. */
async function zoom(page, times) {
  for (let i = 0; i < times; ++i) await page.keyboard.press('+');
  await page.waitForTimeout(500);
}

test('a request and its answer', () => drawn(['stl_programs/modbus_slave.stl'], async (page) => {
  await run_for(page, 100);
  await page.click('#tab-line');
  await page.fill('#send-text', '01 03 00 0a 00 02 crc');
  await page.press('#send-text', 'Enter');
  await run_for(page, 150);
  await page.waitForSelector('.exchanges tbody tr');
  await page.locator('.exchanges tbody .link').first().click();
  await page.waitForTimeout(400);
  await page.evaluate(() => document.activeElement?.blur());
  await zoom(page, 1);
  for (let i = 0; i < 2; ++i) await page.keyboard.press('ArrowRight');
  for (const key of ['i', 'i', 'i', '.', '.', '.', '.', '.', '.']) {
    await page.keyboard.press(key);
    await page.waitForTimeout(150);
  }
  await page.waitForTimeout(500);
  await page.screenshot({ path: docs('page_program.png') });
  await page.setViewportSize({ width: 1100, height: 640 });
  for (let i = 0; i < 2; ++i) await page.keyboard.press('ArrowLeft');
  await zoom(page, 3);
  await page.locator('.timeline').screenshot({ path: docs('page_timeline.png') });
}));

test('networks as ladder', () => drawn(kPump, async (page) => {
  for (const name of ['I0.1', 'I0.0']) await page.click(`[aria-label^="Input ${name}"]`);
  await run_for(page, 300);
  await page.click('text=LAD');
  await page.waitForSelector('.ladder .closed');
  await page.click('text=Follow');
  await page.selectOption('.navigator', { label: 'Network 2  Pump' });
  await page.waitForTimeout(500);
  await page.locator('.program').screenshot({ path: docs('page_ladder.png') });
}));

test('a forced output, a new value and a trend', () => drawn(kPump, async (page) => {
  for (const address of ['Pump', 'Run_Time', 'Longest_Run', 'T37']) {
    await page.fill('#add-address', address);
    await page.press('#add-address', 'Enter');
  }
  await page.click('[aria-label^="Input I0.1"]');
  await run_for(page, 100);
  await page.click('[aria-label^="Input I0.0"]');
  await run_for(page, 500);
  await page.fill('[aria-label="New value of Longest_Run"]', '600');
  await page.click('[aria-label="Force Pump"]');
  await page.waitForSelector('tr.forced');
  await page.locator('.side').screenshot({ path: docs('page_chart.png') });
}));

const kScenarios = `program: ${path.join(process.env.SOURCE, 'stl_programs/modbus_slave.stl')}
scenarios:
- name: a register that was written is read
  steps:
  - {write: holding 10, value: 5, expect: accepted}
  - {read: holding 10, expect: [5]}
- name: a request with a parity error gets no answer
  steps:
  - send: 01 03p 00 0a 00 01 a4 08
    expect: silence
- name: a register keeps what was written
  steps:
  - {write: holding 10, value: 5, expect: accepted}
  - set: {VW20: 6}
  - {read: holding 10, expect: [5]}
`;

test('a report of scenarios', async () => {
  const report = path.join(process.env.REPORTS, 'report.html'), scenarios = path.join(process.env.REPORTS, 'registers.yaml');
  writeFileSync(scenarios, kScenarios);
  spawnSync(process.env.S7200, ['test', 'registers.yaml', '--report', report], { cwd: process.env.REPORTS, stdio: 'inherit' });
  const chrome = await browser();
  const page = await chrome.newPage({ viewport: kViewport });
  await page.goto(`file://${report}`);
  await page.waitForSelector('.findings .link');
  await page.waitForTimeout(1500);
  await page.screenshot({ path: docs('page_report.png') });
  await chrome.close();
});
