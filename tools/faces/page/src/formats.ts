// Values in the formats of a status chart, by the names that Micro/WIN gives them.
import { word_of } from './commands';
import { state, type ChartRow } from './state';
import type { Value } from './protocol';

export const kFormats = [
  { format: 'signed', name: 'Signed' },
  { format: 'unsigned', name: 'Unsigned' },
  { format: 'hex', name: 'Hexadecimal' },
  { format: 'binary', name: 'Binary' },
  { format: 'ascii', name: 'ASCII' },
  { format: 'real', name: 'Floating point' },
] as const;

export type Format = (typeof kFormats)[number]['format'];

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

/** The format in which the chart shows an address, by the address or its symbol; signed if it is not there. */
function format_of(name: string): Format {
  const names = (row: ChartRow): string[] => [row.address.trim(), state.values.get(query_of(row.address, row.format))?.address ?? ''];
  return state.chart.find((row) => names(row).some((one) => one.toUpperCase() === name.toUpperCase()))?.format ?? 'signed';
}

const kTypeOfDigits: Record<number, Value['type']> = { 2: 'byte', 4: 'word', 8: 'dword' };

/** `VW100=16#1234 VD4=16#3FC00000 (1.5)`, each value as the chart would show it. */
export function in_formats(text: string): string {
  return text.replace(/(\S+)=16#([0-9A-F]+)\b(?: \(([^)]*)\))?/g, (all, name: string, digits: string, real: string | undefined) => {
    const type = kTypeOfDigits[digits.length], address = name.slice(name.lastIndexOf(':') + 1), format = format_of(address);
    if (!type) return all;
    if (real !== undefined && (format === 'signed' || format === 'real')) return `${name}=${real}`;
    return `${name}=${text_in({ name, address, symbol: '', type, text: all, number: parseInt(digits, 16), forced: false }, format)}`;
  });
}

/** The value of an operand, as the chart would show it; what the session says of its instruction has all bits of it. */
export function operand_text(address: string, value: number | boolean, said: string): string {
  const words = format_of(address) === 'signed' ? null : said.match(/\S+=16#[0-9A-F]+\b(?: \([^)]*\))?/g);
  const found = words?.find((one) => one.slice(0, one.indexOf('=')).split(':').pop() === address);
  return found ? in_formats(found).replace(/^.*?=/, '') : String(Number(value));
}

/** The address as a query takes it: a double word in floating point is asked for as one. */
export function query_of(address: string, format: Format): string {
  const word = word_of(address) ?? address.trim(), has_type = /:\w+$/.test(word);
  return format === 'real' && !has_type ? `${word}:real` : word;
}
