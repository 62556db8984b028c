// Files as Micro/WIN and editors write them, as text; and a small program within an address.
import type { Source } from './protocol';

/** UTF-16 and UTF-8 by their marks, UTF-8 if it is valid. What else it may be, a code page or no text at all, the session finds out. */
export function source_of(name: string, bytes: Uint8Array): Source {
  if (bytes[0] === 0xff && bytes[1] === 0xfe) return { name, text: new TextDecoder('utf-16le').decode(bytes) };
  if (bytes[0] === 0xfe && bytes[1] === 0xff) return { name, text: new TextDecoder('utf-16be').decode(bytes) };
  try {
    return { name, text: new TextDecoder('utf-8', { fatal: true }).decode(bytes) };
  } catch {
    return { name, text: new TextDecoder('windows-1252').decode(bytes), hex: Array.from(bytes, (byte) => byte.toString(16).padStart(2, '0')).join('') };
  }
}

export async function sources_of(files: Iterable<File>): Promise<Source[]> {
  const all = await Promise.all([...files].map(async (file) => source_of(file.name, new Uint8Array(await file.arrayBuffer()))));
  return all.sort((a, b) => rank(a) - rank(b));
}

/** By its name, or by the lines in it: published ones are text files, or pages. */
export function is_program(source: Source): boolean {
  return /\.(awl|stl)$/i.test(source.name) || /^\s*(?:<[^>]*>\s*)*(?:NETWORK\s+\d|NETWORK\s*(?:\/\/.*)?$|ORGANIZATION_BLOCK\b|LDN?\s+[A-Z"#])/im.test(source.text);
}

/** The program first, then what belongs to it. */
function rank(source: Source): number {
  return /\.(awl|stl)$/i.test(source.name) ? 0 : is_program(source) ? 1 : 2;
}

async function through(stream: CompressionStream | DecompressionStream, bytes: Uint8Array): Promise<Uint8Array> {
  const passed = new Blob([bytes as BlobPart]).stream().pipeThrough(stream as ReadableWritablePair<Uint8Array, Uint8Array>);
  return new Uint8Array(await new Response(passed as ReadableStream).arrayBuffer());
}

const kLongestAddress = 8000;  // characters that every browser and mail passes on

/** `p=…`: the sources in an address; undefined if they are too long for one. */
export async function address_of(sources: Source[]): Promise<string | undefined> {
  const packed = await through(new CompressionStream('deflate-raw'), new TextEncoder().encode(JSON.stringify(sources)));
  if (packed.length > kLongestAddress) return undefined;
  const text = btoa(String.fromCharCode(...packed)).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
  return text.length <= kLongestAddress ? `p=${text}` : undefined;
}

/** The sources of such an address; nothing if it has none, or is damaged. */
export async function sources_in(hash: string): Promise<Source[]> {
  const found = /[#&]p=([\w-]+)/.exec(hash);
  if (!found) return [];
  try {
    const packed = Uint8Array.from(atob(found[1]!.replace(/-/g, '+').replace(/_/g, '/')), (one) => one.charCodeAt(0));
    const all: unknown = JSON.parse(new TextDecoder().decode(await through(new DecompressionStream('deflate-raw'), packed)));
    return Array.isArray(all) ? all.filter((one): one is Source => typeof one?.name === 'string' && typeof one?.text === 'string') : [];
  } catch {
    return [];
  }
}
