// Values in the formats of a status chart, by the names that Micro/WIN gives them.
import type { Value } from './protocol';
import type { Format } from './state';

export const kFormats: { format: Format; name: string }[] = [
  { format: 'signed', name: 'Signed' },
  { format: 'unsigned', name: 'Unsigned' },
  { format: 'hex', name: 'Hexadecimal' },
  { format: 'binary', name: 'Binary' },
  { format: 'ascii', name: 'ASCII' },
  { format: 'real', name: 'Floating point' },
];

const kBits = { bit: 1, byte: 8, word: 16, dword: 32, real: 32 };

/** The value's bits as a number from 0. */
function bits_of(value: Value): number {
  if (value.type === 'real') {
    const view = new DataView(new ArrayBuffer(4));
    view.setFloat32(0, value.number);
    return view.getUint32(0);
  }
  const size = 2 ** kBits[value.type];
  return ((Number(value.number) % size) + size) % size;
}

function characters(bits: number, bytes: number): string {
  let text = '';
  for (let i = bytes - 1; i >= 0; --i) {
    const code = Math.floor(bits / 256 ** i) % 256;
    text += code >= 0x20 && code < 0x7f ? String.fromCharCode(code) : '.';
  }
  return `'${text}'`;
}

export function text_in(value: Value, format: Format): string {
  if (value.error !== undefined) return '';
  if (value.type === 'bit') return `2#${bits_of(value)}`;
  const width = kBits[value.type];
  const bits = bits_of(value);
  switch (format) {
    case 'hex': return '16#' + bits.toString(16).toUpperCase().padStart(width / 4, '0');
    case 'binary': return '2#' + bits.toString(2).padStart(width, '0').replace(/(.{4})(?=.)/g, '$1_');
    case 'ascii': return characters(bits, width / 8);
    case 'unsigned': return String(bits);
    case 'signed':
      if (value.type === 'real') return value.text;
      return String(width > 8 && bits >= 2 ** (width - 1) ? bits - 2 ** width : bits);
    case 'real': return value.text;
  }
}

/** The address as a query takes it: a double word in floating point is asked for as one. */
export function query_of(address: string, format: Format): string {
  const word = address.trim();
  return format === 'real' && !word.includes(':') && !word.startsWith('"') ? `${word}:real` : word;
}

/** What a query can hold: one word, or a symbol in quotation marks. */
export function is_one_word(address: string): boolean {
  return /^("[^"]+"|[^\s";/][^\s";]*)$/.test(address.trim());
}
