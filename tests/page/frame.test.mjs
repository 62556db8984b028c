// The frame: toolbar, keys, help, lamps, and what is said when the connection is lost.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { browser, end, kPhone, moment, open, picture, rendered, view } from './support.mjs';

const kPump = ['tests/exports/pump.awl', 'tests/exports/pump_symbols.txt', 'tests/exports/pump_data.txt'];
let chrome, plc;
before(async () => { [chrome, plc] = await Promise.all([browser(), view(...kPump)]); });
after(async () => { await chrome?.close(); await end(plc.server); });

test('the page shows the program, the mode of the CPU and the moment', async () => {
  const page = await open(chrome, plc.address);
  assert.match(await page.textContent('.status-bar'), /pump\.awl · CPU 2/);
  assert.equal(await page.getAttribute('.lamp.run', 'aria-label'), 'RUN lamp on');
  assert.equal(await moment(page), 0);
  await picture(page, 'frame_light');
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('steps go forwards and backwards, by buttons and by keys', async () => {
  const page = await open(chrome, plc.address);
  await page.keyboard.press('Home');
  await page.click('#do-scan');
  await page.click('#do-scan');
  await page.waitForFunction(() => document.querySelector('.scan-number').textContent === 'scan 3');
  const later = await moment(page);
  assert.ok(later > 0);
  await page.keyboard.press('Shift+S');
  await page.waitForFunction(() => document.querySelector('.scan-number').textContent === 'scan 2');
  assert.ok(await moment(page) < later);
  assert.equal(await page.textContent('.tag'), 'past');
  await page.keyboard.press('End');
  await page.waitForSelector('.tag.now');
  await page.keyboard.press('.');
  await page.waitForFunction((before) => parseFloat(document.querySelector('#moment').value) > before, later);
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('Run follows the clock at the pace that is chosen, and Space pauses it', async () => {
  const page = await open(chrome, plc.address);
  await page.keyboard.press('End');
  await page.waitForSelector('.tag.now');
  await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
  const began = await moment(page);
  await page.selectOption('#pace', '10');
  await page.keyboard.press('Escape');
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press('Space');
  await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Pause');
  await page.waitForFunction((before) => parseFloat(document.querySelector('#moment').value) > before + 500, began);
  await page.keyboard.press('Space');
  await page.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
  const paused = await moment(page);
  await page.waitForTimeout(200);
  assert.equal(await moment(page), paused);
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('a moment that is typed is gone to, and what is not a time is said', async () => {
  const page = await open(chrome, plc.address);
  await page.keyboard.press('g');
  await page.keyboard.type('5 ms');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => Math.abs(parseFloat(document.querySelector('#moment').value) - 5) < 0.2);
  await page.keyboard.press('g');
  await page.keyboard.type('soon');
  await page.keyboard.press('Enter');
  await page.waitForSelector('.notice.error');
  assert.match(await page.textContent('.notice.error'), /'soon' is not a time/);
  await page.close();
});

test('what an instruction did is said in the status bar until the next step', async () => {
  const page = await open(chrome, plc.address);
  await page.keyboard.press('.');
  await page.waitForFunction(() => document.querySelector('.status-bar .printed').textContent !== '');
  await page.keyboard.press('Home');
  await page.waitForFunction(() => document.querySelector('.status-bar .printed').textContent === '');
  await page.close();
});

test('a moment within an instruction is said to be one: the CPU stands at the next', async () => {
  const page = await open(chrome, plc.address);
  await page.keyboard.press('g');
  await page.keyboard.type('5.0001 ms');
  await page.keyboard.press('Enter');
  await page.waitForSelector('.notice.info');
  const late = (await moment(page) - 5.0001) * 1000;
  const [, said] = /^No instruction begins at 5\.000100 ms: this is the next one, ([\d.]+) µs later$/.exec(await page.textContent('.notice span'));
  assert.ok(Math.abs(parseFloat(said) - late) < 0.01, `${said}, ${late}`);
  await page.fill('#moment', await page.inputValue('#moment'));
  await page.press('#moment', 'Enter');
  await page.waitForSelector('.notice', { state: 'detached' });
  await page.close();
});

test('a notice moves nothing, and lies over no pane', async () => {
  const page = await open(chrome, plc.address, { viewport: { width: 1366, height: 650 } });
  const boxes = () => page.$$eval('.pane', (all) => all.map((one) => JSON.stringify(one.getBoundingClientRect())));
  const before = await boxes();
  await page.fill('#moment', 'soon');
  await page.press('#moment', 'Enter');
  await page.waitForSelector('.notice.error');
  assert.deepEqual(await boxes(), before);
  const [top, bottom] = await page.evaluate(() => [document.querySelector('.notice').getBoundingClientRect().top,
    Math.max(...[...document.querySelectorAll('.pane')].map((one) => one.getBoundingClientRect().bottom))]);
  assert.ok(top >= bottom, `${top}, ${bottom}`);
  await picture(page, 'frame_notice');
  await page.click('[aria-label="Put away"]');
  await page.waitForSelector('.notice', { state: 'detached' });
  await page.close();
});

test('the toolbar is one row at 1366 pixels, with a scan of 8 digits and a moment to the nanosecond', async () => {
  for (const colorScheme of ['light', 'dark']) {
    const page = await open(chrome, plc.address, { colorScheme, viewport: { width: 1366, height: 768 } });
    const sizes = await page.evaluate(() => {
      document.querySelector('.scan-number').textContent = 'scan 88888888';
      document.querySelector('#moment').value = '99999.999999 ms';
      const [moment, bar] = ['#moment', '.toolbar'].map((name) => document.querySelector(name));
      return { height: bar.offsetHeight, cut: moment.scrollWidth - moment.clientWidth, wide: bar.scrollWidth - bar.clientWidth };
    });
    assert.ok(sizes.height < 45, `${sizes.height} pixels`);
    assert.deepEqual([sizes.cut, sizes.wide], [0, 0]);
    await picture(page, `frame_1366_${colorScheme}`);
    await page.close();
  }
});

test('an address with a moment opens at that moment', async () => {
  const page = await open(chrome, `${plc.address}#t=7ms`);
  await page.waitForFunction(() => Math.abs(parseFloat(document.querySelector('#moment').value) - 7) < 1);
  await page.keyboard.press('l');
  await page.waitForSelector('.notice.info:has-text("Link to this moment")');
  assert.match(page.url(), /#t=\d+\.\d+ms$/);
  await page.close();
});

test('an address with a moment that is still to come, or with none, says so', async () => {
  const page = await open(chrome, `${plc.address}#t=99999s`);
  await page.waitForSelector('.notice:has-text("The address leads to 27:46:39.000000, which is still to come")');
  const before = await moment(page);
  await page.evaluate(() => { location.hash = '#t=garbage'; });
  await page.waitForSelector(`.notice.error:has-text("'garbage' in the address is no moment")`);
  assert.equal(await moment(page), before);
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('the help lists each key once, and Escape closes it', async () => {
  const page = await open(chrome, plc.address);
  await page.keyboard.press('?');
  await page.waitForSelector('[role=dialog]');
  const keys = await page.$$eval('.dialog kbd', (all) => all.map((one) => one.textContent));
  assert.equal(new Set(keys).size, keys.length);
  const hidden = await page.$eval('.dialog', (dialog) => dialog.scrollHeight - dialog.clientHeight);
  assert.equal(hidden, 0, 'all keys are seen at once');
  await picture(page, 'frame_help');
  await page.keyboard.press('Escape');
  await page.waitForSelector('[role=dialog]', { state: 'detached' });
  await page.close();
});

test('controls have names for screen readers', async () => {
  const page = await open(chrome, plc.address);
  const nameless = await page.$$eval('button, input, select', (all) => all
    .filter((one) => !one.hidden && !(one.getAttribute('aria-label') || one.textContent.trim() || one.title))
    .map((one) => one.outerHTML));
  assert.deepEqual(nameless, []);
  await page.close();
});

test('the mode switch stops the CPU and starts it', async () => {
  const page = await open(chrome, plc.address);
  await page.click('#do-mode-stop');
  await page.waitForSelector('.lamp.stop.on');
  await page.click('#do-mode-run');
  await page.waitForSelector('.lamp.run.on');
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('to power up again is asked first', async () => {
  const page = await open(chrome, plc.address);
  await rendered(page);
  const first = await moment(page);
  await page.click('#do-scan');
  await page.waitForFunction((was) => parseFloat(document.querySelector('#moment').value) !== was, first);
  const before = await moment(page);
  await page.keyboard.press('Shift+U');
  await page.waitForSelector('[role=dialog] #power-up:focus');
  await picture(page, 'frame_power_up');
  await page.keyboard.press('Shift+U');
  await page.keyboard.press('Escape');
  await page.waitForSelector('[role=dialog]', { state: 'detached' });
  assert.equal(await moment(page), before);
  await page.keyboard.press('Shift+U');
  await page.waitForSelector('[role=dialog] #power-up:focus');
  await page.keyboard.press('Enter');
  await page.waitForSelector('[role=dialog]', { state: 'detached' });
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) === 0);
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test('dark, and a phone shows one pane at a time', async () => {
  const dark = await open(chrome, plc.address, { colorScheme: 'dark' });
  await picture(dark, 'frame_dark');
  await dark.close();
  const phone = await open(chrome, plc.address, { viewport: kPhone });
  assert.equal(await phone.isVisible('.timeline'), false);
  await phone.click('.pane-tabs >> text=Timeline');
  await phone.waitForSelector('.timeline', { state: 'visible' });
  assert.equal(await phone.isVisible('.program'), false);
  assert.match(await phone.innerText('.status-bar'), /scan \d+/);
  const wider = await phone.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  assert.equal(wider, false);
  assert.ok(await phone.isVisible('#do-link'));
  await phone.click('.pane-tabs >> text=Program');
  await phone.click('#do-scan');
  await phone.waitForSelector('.row .value', { state: 'visible' });
  const { listing, last } = await phone.evaluate(() => ({ listing: document.querySelector('.listing').clientWidth, last: Math.max(...[...document.querySelectorAll('.row .value')].map((one) => one.getBoundingClientRect().right)) }));
  assert.ok(last > listing - 30 && last <= kPhone.width, `values end at ${last} of ${listing} pixels`);
  await phone.click('#do-why');
  await phone.waitForSelector('#pane-causes .trail', { state: 'visible' });
  await picture(phone, 'frame_phone');
  await phone.close();
});

test('several windows show the same session', async () => {
  const [one, other] = [await open(chrome, plc.address), await open(chrome, plc.address)];
  await one.keyboard.press('End');
  await one.click('#do-scan');
  await one.click('[aria-label^="Input I0.5"]');
  await one.click('#do-scan');
  await one.click('#do-scan');
  await other.waitForSelector('[aria-label^="Input I0.5"][aria-checked=true]');
  await rendered(one);
  await other.waitForFunction((text) => document.querySelector('#moment').value === text, await one.inputValue('#moment'));
  await one.close();
  await other.close();
});

test('a run that follows the clock takes switches meanwhile, and is paused from any window', async () => {
  const live = await view(...kPump, '--realtime');
  const [page, other] = [await open(chrome, live.address), await open(chrome, live.address)];
  assert.equal(await page.textContent('.live'), 'live');
  await page.click('#do-run');
  await page.waitForFunction(() => parseFloat(document.querySelector('#moment').value) > 100);
  await page.click('[aria-label^="Input I0.1"]');
  await page.click('[aria-label^="Input I0.0"]');
  await page.waitForSelector('[aria-label="Output Q0.0 on"]');
  await other.waitForSelector('[aria-label="Output Q0.0 on"]');
  await other.waitForFunction(() => document.querySelector('#do-run').textContent === 'Pause');
  await other.click('#do-run');
  for (const one of [page, other]) await one.waitForFunction(() => document.querySelector('#do-run').textContent === 'Run');
  assert.deepEqual(page.troubles.concat(other.troubles), []);
  await page.close();
  await other.close();
  await end(live.server);
});

test('the tracks of many PLCs are printed within the timeline', async () => {
  const plant = await view('stl_programs/systems/polled_slaves.yaml');
  const page = await open(chrome, plant.address);
  await page.click('#do-scan');
  await page.waitForFunction(() => document.querySelectorAll('.track-name').length > 20);
  await page.emulateMedia({ media: 'print' });
  await picture(page, 'frame_printed');
  const below = await page.evaluate(() => {
    const end = document.querySelector('.timeline').getBoundingClientRect().bottom;
    return [...document.querySelectorAll('.track-name')].filter((one) => {
      const box = one.getBoundingClientRect();
      return box.top > end && document.elementFromPoint(box.left + 20, box.top + 4)?.closest('.track-name') === one;
    }).length;
  });
  assert.equal(below, 0);
  await page.close();
  await end(plant.server);
});

/** How many lines a program has. */
const of_lines = (program) => readFileSync(path.join(process.env.SOURCE, 'stl_programs', program), 'utf8').trimEnd().split('\n').length;

test('another PLC of a system is shown with its program, its ladder, its blocks and its points', async () => {
  const plant = await view('stl_programs/systems/gateway.yaml');
  const page = await open(chrome, plant.address);
  const lines = (count) => page.waitForSelector(`.listing[aria-rowcount="${count}"] .row.here .operand`);
  const blocks = () => page.locator('.navigator option').allTextContents();
  await lines(of_lines('systems/line_gateway.stl'));
  await page.waitForSelector('.program-name:has-text("CPU 226")');
  await page.click('.row.here .margin');
  await page.waitForSelector('.margin.stop');
  const of_gateway = await blocks();
  await page.selectOption('#station', 'pump');
  await lines(of_lines('modbus_slave.stl'));
  await page.waitForSelector('.program-name:has-text("CPU 214")');
  await page.waitForFunction(() => document.querySelectorAll('.margin.stop').length === 0);
  assert.notDeepEqual(await blocks(), of_gateway);
  await page.click('.choice button:has-text("LAD")');
  await page.waitForSelector('.ladder-network svg');
  const of_pump = await page.locator('.ladder-network').allTextContents();
  await page.selectOption('#station', 'gateway');
  await page.waitForFunction((before) => document.querySelector('.ladder-network svg') && document.querySelector('.ladder-network').textContent !== before, of_pump[0]);
  await page.click('.choice button:has-text("STL")');
  await lines(of_lines('systems/line_gateway.stl'));
  await page.waitForSelector('.margin.stop');
  assert.deepEqual(await blocks(), of_gateway);
  assert.deepEqual(page.troubles, []);
  await page.close();
  await end(plant.server);
});

test('a query that a stop has dropped is asked again', async () => {
  let dropped = 0;
  const prepare = (page) => page.routeWebSocket(/socket/, (one) => {
    const server = one.connectToServer();
    one.onMessage((text) => {
      const { id, command } = JSON.parse(text);
      if (!/^(values|status) /.test(command ?? '') || dropped >= 6) return server.send(text);
      ++dropped;
      one.send(JSON.stringify({ id, text: '', json: null, moved: false, interrupted: true }));
    });
  });
  const page = await open(chrome, plc.address, { prepare });
  await page.fill('#add-address', 'SM0.0');
  await page.press('#add-address', 'Enter');
  await page.waitForFunction(() => document.querySelector('.chart .current')?.textContent === '2#1');
  assert.equal(dropped, 6);
  await page.close();
});

test('a lost connection is said, and so is its return', async () => {
  let allowed = true, socket;
  const prepare = (page) => page.routeWebSocket(/socket/, (one) => {
    if (!allowed) return one.close();
    socket = one;
    one.connectToServer();
  });
  const page = await open(chrome, plc.address, { prepare });
  allowed = false;
  await socket.close();
  await page.waitForSelector('.notice.error');
  assert.match(await page.textContent('.notice.error'), /connection to s7200 is lost/);
  await picture(page, 'frame_lost');
  allowed = true;
  await page.waitForSelector('.connection.connected');
  await page.waitForSelector('.notice.error', { state: 'detached' });
  await page.close();
});
