// The page in one file as a browser has it: its worker replies what the native engine does.
import assert from 'node:assert';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { after, before, test } from 'node:test';

const { chromium } = createRequire(`${process.env.PACKAGES}/node_modules/`)('playwright-core');
const folder = process.env.FOLDER;
const lines = (name) => readFileSync(`${folder}/${name}`, 'utf8').split('\n').slice(0, -1);

let chrome, page;
const troubles = [];
before(async () => {
  chrome = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking'] });
  page = await chrome.newPage();
  page.on('pageerror', (error) => troubles.push(error.message));
  page.on('console', (message) => { if (message.type() === 'error') troubles.push(message.text()); });
  await page.goto(`file://${folder}/page.html`);
});
after(() => chrome.close());

/** What a new worker of the page replies, until it has ended. */
function replies(messages) {
  return page.evaluate((said) => new Promise((done, failed) => {
    const text = document.querySelector('#worker').textContent;
    const worker = new Worker(URL.createObjectURL(new Blob([text], { type: 'text/javascript' })));
    const all = [];
    worker.onerror = (event) => failed(new Error(event.message));
    worker.onmessage = ({ data }) => {
      all.push(data);
      if (JSON.parse(data).event === 'ended') done(all);
    };
    for (const message of said) worker.postMessage(message);
  }), messages);
}

test('the worker replies what the native engine does', { timeout: 240_000 }, async () => {
  const heard = await replies(lines('messages'));
  const expected = lines('replies');
  for (let i = 0; i < expected.length; ++i) assert.equal(heard[i], expected[i], `reply ${i}`);
  assert.equal(heard.length, expected.length);
});

test('nothing of the page comes from elsewhere', () => {
  const text = readFileSync(`${folder}/page.html`, 'utf8');
  assert.doesNotMatch(text, /(src|href)="(?!data:)/);
  assert.deepEqual(troubles, []);
});
