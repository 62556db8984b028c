// Figures of the page, the median of several rounds each; tests/page/bench starts it.
import { spawnSync } from 'node:child_process';
import { statSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { browser, end, kDesktop, open, view } from './support.mjs';

const kRounds = 9;
const median = (all) => [...all].sort((a, b) => a - b)[Math.floor(all.length / 2)];
const say = (name, value, unit) => console.log(`${name.padEnd(58)} ${value.toFixed(unit === 'kB' ? 0 : 1)} ${unit}`);

async function bytes_of(address) {
  const sizes = await Promise.all(['', 'page.js', 'page.css', 'icon.svg'].map(async (name) => (await (await fetch(address + name)).arrayBuffer()).byteLength));
  return sizes.reduce((sum, size) => sum + size, 0);
}

async function milliseconds(action) {
  const began = performance.now();
  await action();
  return performance.now() - began;
}

async function go_to(page, ms) {
  const before = await page.textContent('.scan-number');
  await page.fill('#moment', `${ms} ms`);
  await page.press('#moment', 'Enter');
  await page.waitForFunction((before) => document.querySelector('.scan-number').textContent !== before, before, { polling: 5 });
}

/** Zooms from the whole past to a bit and back, a step a frame: the times between frames. */
const frames_while_zooming = (page) => page.evaluate(() => new Promise((done) => {
  const canvas = document.querySelector('#timeline');
  const box = canvas.getBoundingClientRect();
  const gaps = [];
  let last = performance.now(), i = 0;
  const step = () => {
    const now = performance.now();
    gaps.push(now - last);
    last = now;
    canvas.dispatchEvent(new WheelEvent('wheel', { deltaY: i % 100 < 50 ? -120 : 120, clientX: box.left + box.width / 2, clientY: box.top + 40, bubbles: true, cancelable: true }));
    if (++i < 200) requestAnimationFrame(step);
    else done(gaps.slice(1));
  };
  requestAnimationFrame(step);
}));

test('figures', async () => {
  const [chrome, plc] = await Promise.all([browser(), view('stl_programs/modbus_slave.stl')]);
  say('size of the page', await bytes_of(plc.address) / 1000, 'kB');
  const opened = [];
  for (let i = 0; i < kRounds; ++i) opened.push(await milliseconds(async () => (await open(chrome, plc.address)).close()));
  say('opens within', median(opened), 'ms');
  const page = await open(chrome, plc.address);
  page.setDefaultTimeout(120000);
  const hour = await milliseconds(() => go_to(page, 3600e3));
  say('an hour of simulated time, run for the first time', hour, 'ms');
  const seeks = [];
  for (let i = 0; i < kRounds; ++i) seeks.push(await milliseconds(() => go_to(page, 100e3 + 389e3 * ((i * 5) % kRounds))));
  say('goes to a moment of that hour within', median(seeks), 'ms');
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press('0');
  await page.waitForTimeout(500);
  const gaps = await frames_while_zooming(page);
  say('a frame of the timeline while it zooms', median(gaps), 'ms');
  say('the slowest frame but 5 in 100', [...gaps].sort((a, b) => a - b)[Math.floor(gaps.length * 0.95)], 'ms');
  await chrome.close();
  await end(plc.server);
});

/** A report of a day in which a master asks each second: 86 400 exchanges. */
test('figures of a report', { skip: process.env.REPORTS ? false : 'there is no engine' }, async () => {
  const file = path.join(process.env.REPORTS, 'day.html');
  const written = await milliseconds(() => spawnSync(process.env.S7200, ['master', 'stl_programs/modbus_slave.stl', 'read', '40011:2', '--every', '1s', '--count', '86400', '--report', file],
    { cwd: process.env.SOURCE, stdio: 'ignore' }));
  say('a day polled each second, with its report', written, 'ms');
  say('size of the report', statSync(file).size / 1000, 'kB');
  say('of that the page with its engine', statSync(path.join(process.env.REPORTS, 'share/s7200/page.html')).size / 1000, 'kB');
  const chrome = await browser();
  const opened = [], far = [], seeks = [];
  for (let i = 0; i < 5; ++i) {
    const page = await chrome.newPage({ viewport: kDesktop });
    page.setDefaultTimeout(120000);
    opened.push(await milliseconds(async () => {
      await page.goto(`file://${file}`);
      await page.waitForSelector('.row');
    }));
    far.push(await milliseconds(() => go_to(page, 86000e3)));
    for (let k = 0; k < kRounds; ++k) seeks.push(await milliseconds(() => go_to(page, 1000e3 + 9389e3 * ((k * 5) % kRounds))));
    await page.close();
  }
  say('opens within', median(opened), 'ms');
  say('goes to the end of the day, computed for the first time', median(far), 'ms');
  say('goes to a moment of that day within', median(seeks), 'ms');
  await chrome.close();
});
