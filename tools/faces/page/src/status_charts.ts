// Status charts of Micro/WIN as text: a row a line, with address, format, current and new value between tabs.
import { kFormats } from './formats';
import type { ChartRow } from './state';

/** `Pump:Q0.0` is the address with its symbol in front; a row without an address, and the heading, are none. */
export function chart_from(text: string): ChartRow[] {
  return text.split(/\r?\n/).map((line) => line.split('\t').map((cell) => cell.trim())).flatMap(([written = '', format = '', , new_value = '']) => {
    const address = written.replace(/^("[^"]*"|[^":]*):(?=[A-Z]{1,3}\d)/i, '');
    if (address === '' || /^address$/i.test(address)) return [];
    const known = kFormats.find(({ name }) => name.toLowerCase() === format.toLowerCase());
    return [{ address, format: known?.format ?? 'signed', new_value }];
  });
}

export function chart_text(rows: { row: ChartRow; current: string; bit: boolean }[]): string {
  const line = ({ row, current, bit }: { row: ChartRow; current: string; bit: boolean }): string =>
    [row.address, bit ? 'Bit' : kFormats.find(({ format }) => format === row.format)!.name, current, row.new_value].join('\t');
  return ['Address\tFormat\tCurrent Value\tNew Value', ...rows.map(line)].join('\n') + '\n';
}
