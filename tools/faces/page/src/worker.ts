// The session in the browser: s7200 as WebAssembly, with the same messages as over the WebSocket (docs/page_protocol.md).

/** The module in a page that is one file: deflated (gzip), in base85, and its bytes. A page with files beside it has `engine.wasm`. */
declare const kEngine: string | undefined, kEngineSize: number;

/** The digits of base85 (RFC 1924), with a comma for <, which could begin an element. */
const kDigits = '0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%&()*+-;,=>?@^_`{|}~';

interface Engine {
  memory: WebAssembly.Memory;
  _initialize(): void;
  room(size: number): number;
  take(size: number): void;
  next(): number;
  message(): number;
}

function from_base85(text: string, size: number): Uint8Array<ArrayBuffer> {
  const value = new Uint8Array(128), bytes = new DataView(new ArrayBuffer(text.length / 5 * 4));
  for (let i = 0; i < kDigits.length; ++i) value[kDigits.charCodeAt(i)] = i;
  for (let from = 0, to = 0; from < text.length; from += 5, to += 4) {
    let number = 0;
    for (let i = from; i < from + 5; ++i) number = number * 85 + value[text.charCodeAt(i)]!;
    bytes.setUint32(to, number);
  }
  return new Uint8Array(bytes.buffer, 0, size);
}

async function module_bytes(): Promise<ArrayBuffer> {
  if (typeof kEngine === 'undefined') return (await fetch(new URL('engine.wasm', self.location.href))).arrayBuffer();
  const deflated = from_base85(kEngine, kEngineSize);
  return new Response(new Blob([deflated]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
}

const kFine = 0, kNotThere = 8; // errno of WASI

/** What a module of WASI asks its system for: there are no files here, and no clock. What it prints goes to the console. */
function system(memory: () => WebAssembly.Memory): WebAssembly.ModuleImports {
  const view = (): DataView => new DataView(memory().buffer);
  const calls: Record<string, (...given: number[]) => number> = {
    fd_write: (_descriptor = 0, pieces = 0, count = 0, written = 0) => {
      let size = 0;
      for (let piece = pieces; piece < pieces + 8 * count; piece += 8) {
        const length = view().getUint32(piece + 4, true);
        console.error(new TextDecoder().decode(new Uint8Array(memory().buffer, view().getUint32(piece, true), length)));
        size += length;
      }
      view().setUint32(written, size, true);
      return kFine;
    },
    environ_sizes_get: (count = 0, size = 0) => {
      view().setUint32(count, 0, true);
      view().setUint32(size, 0, true);
      return kFine;
    },
    environ_get: () => kFine,
    proc_exit: (code = 0) => {
      throw new Error(`the engine has ended with ${code}`);
    },
  };
  return new Proxy<WebAssembly.ModuleImports>({}, { get: (_none, name) => calls[String(name)] ?? (() => kNotThere) });
}

async function load(): Promise<Engine> {
  let engine: Engine | undefined;
  const memory = (): WebAssembly.Memory => engine!.memory;
  const { instance } = await WebAssembly.instantiate(await module_bytes(), { wasi_snapshot_preview1: system(memory) });
  engine = instance.exports as unknown as Engine;
  engine._initialize();
  return engine;
}

/** Carries out a message, and reads what came of it: JSON, as over the WebSocket. */
function take(engine: Engine, message: string): string[] {
  const bytes = new TextEncoder().encode(message);
  const room = engine.room(bytes.length); // before memory is looked at: it may have grown
  new Uint8Array(engine.memory.buffer).set(bytes, room);
  engine.take(bytes.length);
  const all: string[] = [];
  for (let size = engine.next(); size >= 0; size = engine.next())
    all.push(new TextDecoder().decode(new Uint8Array(engine.memory.buffer, engine.message(), size)));
  return all;
}

/** An error of the worker, which the page hears of: it does not hear of one in a promise. */
function fail(error: unknown): void {
  setTimeout(() => { throw error; });
}

const engine = load();
self.onmessage = ({ data }: MessageEvent<string>) => {
  engine.then((one) => take(one, data).forEach((message) => self.postMessage(message))).catch(fail);
};
engine.catch(fail);
