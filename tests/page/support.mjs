// A page as its user has it: `s7200 view` behind it, Chromium around it.
import { spawn } from 'node:child_process';
import { createRequire } from 'node:module';
import { mkdirSync } from 'node:fs';
import path from 'node:path';
import { after } from 'node:test';

const { chromium } = createRequire(`${process.env.PACKAGES}/node_modules/`)('playwright-core');
const kSource = process.env.SOURCE;
const kPictures = process.env.S7200_SCREENSHOTS;
const kFrame = Number(process.env.S7200_SLOW_FRAMES ?? 0);  // ms that each frame takes longer, as on a slow computer
const kPageFiles = process.env.S7200_PAGE_FILES;  // a folder with another page.js and page.css, for work on the page without a build

export const kDesktop = { width: 1366, height: 650 };  // what a browser leaves of 1366×768
export const kPhone = { width: 390, height: 780 };

const started = [];

/** What a test that failed has left running would keep the tests from ending. */
after(() => started.filter(is_alive).forEach((server) => server.kill('SIGKILL')));

function is_alive(server) {
  return server.exitCode === null && server.signalCode === null;
}

/** Starts `s7200 view WORDS` in the source folder; resolves to its process and address. */
export async function view(...words) {
  const server = spawn(process.env.S7200, ['view', ...words], { cwd: kSource, stdio: ['pipe', 'pipe', 'pipe'] });
  started.push(server);
  const address = await new Promise((done, failed) => {
    let said = '';
    const heard = (text) => {
      said += text;
      const found = /http:\/\/\S+/.exec(said);
      if (found) done(found[0]);
    };
    server.stdout.on('data', heard);
    server.stderr.on('data', heard);
    server.on('exit', (code) => failed(new Error(`s7200 view ended with ${code}: ${said}`)));
  });
  return { server, address };
}

const kLongestEnd = 10000;  // ms

/** It ends by itself when it is asked to, whoever looks at it. */
export async function end(server) {
  if (!is_alive(server)) return;
  const gone = new Promise((done) => server.on('exit', (code) => done(code === 0 ? '' : `s7200 view ended with ${code}`)));
  server.kill('SIGTERM');
  const late = new Promise((done) => setTimeout(() => done(`s7200 view has not ended ${kLongestEnd} ms after SIGTERM`), kLongestEnd).unref());
  const wrong = await Promise.race([gone, late]);
  if (wrong !== '') throw new Error(wrong);
}

export async function browser() {
  const chrome = await chromium.launch({
    executablePath: '/usr/bin/chromium',
    args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
  });
  return kFrame > 0 ? with_slow_frames(chrome) : chrome;
}

function with_slow_frames(chrome) {
  for (const make of ['newPage', 'newContext']) {
    const made = chrome[make].bind(chrome);
    chrome[make] = async (options) => {
      const one = await made(options);  // a page, or the context of some
      await one.addInitScript((ms) => {
        const next_frame = window.requestAnimationFrame.bind(window);
        window.requestAnimationFrame = (render) => window.setTimeout(() => next_frame(render), ms);
      }, kFrame);
      return one;
    };
  }
  return chrome;
}

/** An open page; what goes wrong in it fails the test that looks at `page.troubles`. */
export async function open(chrome, address, { viewport = kDesktop, colorScheme = 'light', prepare } = {}) {
  const page = await chrome.newPage({ viewport, colorScheme });
  page.troubles = [];
  page.on('pageerror', (error) => page.troubles.push(error.message));
  page.on('console', (message) => { if (message.type() === 'error') page.troubles.push(message.text()); });
  page.setDefaultTimeout(10000);
  if (kPageFiles) await page.route(/\/page\.(js|css)$/, (route) => route.fulfill({ path: path.join(kPageFiles, path.basename(route.request().url())) }));
  await prepare?.(page);
  await page.goto(address);
  await page.waitForSelector('.connection.connected');
  await page.waitForSelector('.row');
  return page;
}

export async function picture(page, name) {
  if (!kPictures) return;
  mkdirSync(kPictures, { recursive: true });
  await page.screenshot({ path: path.join(kPictures, `${name}.png`) });
}

/** The page shows what it knows by now: it renders before the frame after next is drawn. Who types into a field that is about to be rendered
    would lose what is typed, which no hand is quick enough for. */
export async function rendered(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

/** The moment that the toolbar shows, in ms. */
export async function moment(page) {
  const text = await page.inputValue('#moment');
  return parseFloat(text) * (text.endsWith(' s') ? 1000 : 1);
}
