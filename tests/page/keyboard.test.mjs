// The whole page with the keyboard alone.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { browser, end, open, picture, rendered, view } from './support.mjs';

const kPump = ['tests/exports/pump.awl', 'tests/exports/pump_symbols.txt', 'tests/exports/pump_data.txt'];
let chrome, plc, page;
before(async () => {
  [chrome, plc] = await Promise.all([browser(), view(...kPump)]);
  page = await open(chrome, plc.address);
});
after(async () => {
  await chrome?.close();
  await end(plc.server);
});

const press = async (...keys) => { for (const key of keys) await page.keyboard.press(key); };
const shows = (text, selector) => page.waitForFunction(([text, selector]) => document.querySelector(selector)?.textContent.includes(text), [text, selector]);

/** What has the focus: how a screen reader names it, and whether one sees that it has it. */
const focused = () => page.evaluate(() => {
  const node = document.activeElement;
  if (!node || node === document.body) return null;
  const style = getComputedStyle(node), box = node.getBoundingClientRect();
  const over = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
  return {
    name: (node.getAttribute('aria-label') || node.textContent.trim() || node.title || node.getAttribute('placeholder') || '').slice(0, 60),
    id: node.id, tag: node.tagName.toLowerCase(), role: node.getAttribute('role') ?? '',
    ringed: style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 1,
    seen: box.width > 0 && box.height > 0 && (node.contains(over) || over?.contains(node)) === true,
  };
});

const controls = () => page.$$eval('button, input, select, textarea, summary, a[href], [role=button]', (all) =>
  all.filter((one) => one.offsetParent !== null && !one.disabled && one.tabIndex >= 0).length);

/** Waits until no more controls come: the engine's answers are there some time after the pane that shows them. */
async function all_controls() {
  for (let before = -1, now = await controls(); ; before = now, now = await controls()) {
    if (now === before) return now;
    await page.waitForTimeout(500);
  }
}

/** Goes on with Tab from the first control of the page until it is left. */
async function all_stops(most = 200) {
  await page.evaluate(() => document.querySelector('button').focus());
  const stops = [await focused()];
  while (stops.length < most) {
    await press('Tab');
    const one = await focused();
    if (one === null) return stops;
    stops.push(one);
  }
  throw new Error(`the focus never leaves the page: ${stops.slice(-5).map((one) => one.name).join(', ')}`);
}

test('Tab reaches each control once, named and with a ring, and leaves the page again', async () => {
  for (const pane of ['2', '3', '4']) {
    await press(pane);
    const expected = await all_controls();
    const stops = await all_stops();
    assert.deepEqual(stops.filter((one) => one.name === ''), []);
    assert.deepEqual(stops.filter((one) => !one.ringed), []);
    assert.deepEqual(stops.filter((one) => !one.seen), []);
    assert.ok(stops.length >= expected, `${stops.length} of ${expected} in pane ${pane}`);
  }
});

test('lines are chosen, found, run through and stopped at; an address has its menu', async () => {
  await press('s', 's');
  await shows('scan 3', '.scan-number');
  await press('/');
  await page.keyboard.type('LD');
  await press('Enter');
  await page.waitForSelector('.row.selected');
  const chosen = await page.getAttribute('.row.selected', 'id');
  await press('Escape', '1', 'ArrowDown');
  await page.waitForSelector(`#${chosen}[aria-selected=false]`);
  await press('ArrowUp');
  await page.waitForSelector(`.listing[aria-activedescendant=${chosen}] #${chosen}[aria-selected=true]`);
    await press('b');
  await page.waitForSelector(`#${chosen} .margin.stop`);
  await press('F5');
  await page.waitForSelector(`#${chosen}.here`);
  await shows('Run', '#do-run');
  await press('b');
  await page.waitForSelector(`#${chosen} .margin.stop`, { state: 'detached' });
  await press('n', 'n');
  await page.waitForSelector(`#${chosen}:not(.here)`);
  await press('Enter');
  await page.waitForSelector(`#${chosen}.here`);
  await press('Tab');
  const address = await focused();
  assert.deepEqual([address.role, address.ringed], ['button', true]);
  await press(' ');
  await page.waitForSelector('.menu');
  assert.equal((await focused()).role, 'menuitem');
  await press('Tab', 'Tab', 'Escape');
  await page.waitForSelector('.menu', { state: 'detached' });
  assert.equal((await focused()).name, address.name);
  await press('Enter');
  await page.waitForSelector('.menu');
  await press('Enter');
  await page.waitForFunction(() => document.querySelectorAll('.chart tbody tr').length === 1);
  assert.equal(await page.textContent('#do-run'), 'Run');
});

test('a network of the ladder is chosen, and an address of it', async () => {
  await press('v', '1');
  await page.waitForSelector('.ladder .address');
  await press('ArrowDown', 'ArrowUp');
  await page.waitForSelector('.ladder-network.chosen .address[tabindex="0"]');
  await press('Tab');
  const address = await focused();
  assert.deepEqual([address.tag, address.role, address.ringed, address.seen], ['text', 'button', true, true]);
  await picture(page, 'keyboard_ladder');
  await press(' ');
  await page.waitForSelector('.menu');
  const [menu, at] = await page.evaluate(() => ['.menu', '.ladder-network.chosen .address[tabindex="0"]'].map((one) => document.querySelector(one).getBoundingClientRect().left));
  assert.ok(Math.abs(menu - at) < 40, `${menu} beside ${at}`);
  await press('Escape');
  await page.waitForSelector('.menu', { state: 'detached' });
  assert.equal((await focused()).name, address.name);
  await press('v');
});

test('a dialog keeps the focus and the keys, and gives the focus back', async () => {
  const moment = await page.inputValue('#moment');
  await press('2');
  await page.waitForFunction(() => document.activeElement?.id === 'pane-chart');
  await press('?');
  await page.waitForSelector('.dialog');
  for (let i = 0; i < 4; ++i) {
    await press('Tab');
    const inside = await page.evaluate(() => document.activeElement === document.body || document.querySelector('.dialog').contains(document.activeElement));
    assert.ok(inside, JSON.stringify(await focused()));
  }
  await press('s', 'Escape');
  await page.waitForSelector('.dialog', { state: 'detached' });
  assert.equal(await page.inputValue('#moment'), moment);
  assert.equal((await focused())?.id, 'pane-chart');
});

test('the tabs are one stop, and arrows go from one to the other', async () => {
  await page.focus('#tab-chart');
  await press('ArrowRight');
  await page.waitForSelector('.line-pane');
  assert.equal((await focused()).id, 'tab-line');
  await press('ArrowLeft');
  await page.waitForSelector('.chart-pane');
  assert.equal((await focused()).id, 'tab-chart');
});

test('a new value is written and forced, and the menu of a row is beside it', async () => {
  await page.focus('#add-address');
  await page.keyboard.type('VW300');
  await press('Enter');
  await page.focus('[aria-label="New value of VW300"]');
  await page.keyboard.type('7');
  await press('Shift+Enter');
  await page.waitForSelector('tr.forced');
  await page.focus('[aria-label="Menu of VW300"]');
  await press('Enter');
  await page.waitForSelector('.menu');
  const [menu, button] = await page.evaluate(() => ['.menu', '[aria-label="Menu of VW300"]'].map((one) => document.querySelector(one).getBoundingClientRect().top));
  assert.ok(Math.abs(menu - button) < 300 && menu > 20, `${menu} beside ${button}`);
  await press('Escape');
  await page.waitForSelector('.menu', { state: 'detached' });  // only then the focus is back at the button
  await page.focus('[aria-label^="Input I0.6"]');
  await press('Shift+F10');
  await page.waitForSelector('[aria-label^="Input I0.6"].push');
  await press('Shift+F10');
  await page.waitForSelector('[aria-label^="Input I0.6"].pulses');
});

test('what keeps an output off is a tree that opens with Space', async () => {
  await press('4');
  await rendered(page);
  await press('Tab', 'Tab', 'Tab');
  for (let i = 0; i < 4 && (await focused()).tag !== 'input'; ++i) await press('Tab');
  await page.keyboard.type('Q0.0');
  await rendered(page);
  await press('Tab', 'Tab');
  assert.equal((await focused()).name, 'What keeps it so?');
  await press('Enter');
  await page.waitForSelector('.obstacle summary');
  const moment = await page.inputValue('#moment');
  await page.focus('.obstacle summary');
  const was = await page.getAttribute('details.obstacle', 'open');
  await press(' ');
  await page.waitForFunction((was) => document.querySelector('details.obstacle').getAttribute('open') !== was, was);
  assert.deepEqual([await page.textContent('#do-run'), await page.inputValue('#moment')], ['Run', moment]);
});

test('the timeline is zoomed, moved, marked and measured', async () => {
  await press('5');
  assert.equal((await focused()).id, 'timeline');
  const scan = Number((await page.textContent('.scan-number')).slice(5));
  await press('+', 'ArrowRight', '[', 's');
  await shows(`scan ${scan + 1}`, '.scan-number');
  await press(']', 'm');
  await shows('B − A', '.readout');
  await press('Shift+M');
  await page.waitForSelector('.measured');
  await press('Escape');
  await page.waitForSelector('.measured', { state: 'detached' });
  assert.equal((await focused()).id, 'timeline');
  await picture(page, 'keyboard_timeline');
  assert.deepEqual(page.troubles, []);
});
