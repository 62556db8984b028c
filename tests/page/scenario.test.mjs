// `s7200 view` of a file of scenarios: the first that fails is opened where it failed.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { browser, end, moment, open, picture, view } from './support.mjs';

const kProgram = 'LD SM0.0\nMOVW 7, VW0\nMEND\n';
const kScenarios = `program: red.stl
scenarios:
- {name: fine, steps: [wait: 1ms, memory: {VW0: 7}]}
- name: it is red
  steps:
  - wait: 50ms
  - memory: {VW0: 5}
  - wait: 1s
`;
let chrome, folder, plc;
before(async () => {
  folder = mkdtempSync(path.join(tmpdir(), 's7200-'));
  writeFileSync(path.join(folder, 'red.stl'), kProgram);
  writeFileSync(path.join(folder, 'red.yaml'), kScenarios);
  [chrome, plc] = await Promise.all([browser(), view(path.join(folder, 'red.yaml'))]);
});
after(async () => {
  await chrome?.close();
  await end(plc.server);
  rmSync(folder, { recursive: true });
});

test('a failed scenario is opened where it failed, and why says what wrote the value', async () => {
  const page = await open(chrome, plc.address);
  assert.match(await page.textContent('.program-name'), /it is red/);
  await page.waitForSelector('#pane-causes');
  assert.match(await page.innerText('.trail .question'), /^'it is red' fails in .*red\.yaml:7/);
  assert.match(await page.innerText('.trail pre'), /^VW0 is 7, expected 5; last written at [\d.]+ ms by MOVW 7, VW0 in line 2$/);
  await page.locator('.trail pre .link').last().waitFor();
  await picture(page, 'scenario');
  const at = await moment(page);
  assert.ok(at > 45 && at < 80, `${at} ms`);
  await page.click('#do-why');
  await page.waitForSelector('.trail pre:has-text("VW0")');
  assert.deepEqual(page.troubles, []);
  await page.close();
});
