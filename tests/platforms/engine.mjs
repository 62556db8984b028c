// engine.mjs ENGINE.wasm: messages for the module from standard input, a line each; prints what comes back, a line each.
import { readFileSync } from 'node:fs';
import { WASI } from 'node:wasi';

const wasi = new WASI({ version: 'preview1' });
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), { wasi_snapshot_preview1: wasi.wasiImport });
wasi.initialize(instance);
const { memory, room, take, next, message } = instance.exports;

const texts = readFileSync(0).toString().split('\n');
for (const text of texts.slice(0, -1)) {
  const bytes = Buffer.from(text);
  const to = room(bytes.length);  // before memory is looked at: it may have grown
  new Uint8Array(memory.buffer).set(bytes, to);
  take(bytes.length);
  for (let size = next(); size >= 0; size = next()) process.stdout.write(Buffer.concat([Buffer.from(memory.buffer, message(), size), Buffer.from('\n')]));
}
