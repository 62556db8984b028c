// Commands of the session: line_of makes them, and nothing else does. What is typed, pasted, or read from a file is one word of a
// command, or words of this one command, or the command is refused: ';' would begin another one, '//' a comment.
import { state } from './state';
import type { Outline } from './protocol';

declare const made: unique symbol;
type Line = string & { readonly [made]: true };

/** What cannot be a command, and why. */
export class Refused {
  constructor(readonly kind: string, readonly why: string) {}
}

export type Command = Line | Refused;

const kControl = /[\x00-\x08\x0a-\x1f\x7f]/;
const kPlain = /^[^\s\x00-\x1f\x7f;"'/][^\s\x00-\x1f\x7f;"]*$/;
/** In such a quotation nothing ends it before its end; a type may follow. `"#…"` would be a variable of a block. */
const kQuoted = /^"[^"\\#\x00-\x1f\x7f][^"\\\x00-\x1f\x7f]*"(?::\w+)*$/;

let of_outline: Outline | null = null;
let by_name = new Map<string, { name: string; address: string }>();

/** A symbol of the program by its name, as the session finds it: in any case. */
export function symbol_named(name: string): { name: string; address: string } | undefined {
  if (of_outline !== state.outline) {
    of_outline = state.outline;
    by_name = new Map((of_outline?.symbols ?? []).map((one) => [one.name.toUpperCase(), one]));
  }
  return by_name.get(name.toUpperCase());
}

const kLikeAddress = /^[A-Z]{1,3}\d+(?:\.\d)?$/i;

/** An address or a symbol as a command takes it, or nothing if it can be neither. A symbol stands in quotation marks: its name may have
    blanks, or be a word of commands, such as 'all'. */
export function word_of(text: string): string | undefined {
  const word = text.trim(), symbol = symbol_named(word), quoted = `"${symbol?.name}"`;
  if (symbol && !kLikeAddress.test(word)) return kQuoted.test(quoted) ? quoted : symbol.address;
  return kQuoted.test(word) || (kPlain.test(word) && word !== '#' && !word.includes('//')) ? word : undefined;
}

/** Where the quotation that begins at a place ends, as quotation_length of the session finds it; -1 if it does not. */
function end_of_quotation(text: string, begin: number): number {
  for (let i = begin + 1; i < text.length; ++i) {
    if (text[i] === text[begin]) return i + 1;
    if (text[i] === '\\') ++i;
  }
  return -1;
}

/** Whether the session takes all of it for words of one command, as commands_in splits a line. */
function is_of_one_command(text: string): boolean {
  if (kControl.test(text)) return false;
  for (let i = 0; i < text.length;) {
    if (text[i] === ';') return false;
    const begins = i === 0 || text[i - 1] === ' ' || text[i - 1] === '\t';
    if (begins && /^(?:\/\/|#(?:[ \t]|$))/.test(text.slice(i))) return false;
    i = begins && (text[i] === '"' || text[i] === "'") ? end_of_quotation(text, i) : i + 1;
    if (i < 0) return false;
  }
  return true;
}

/** Words of a command, such as a condition or a frame. */
class Words {
  constructor(readonly text: string, readonly what: string) {}
}
/** Several words of this command; `what` says what they should have been. */
export function words(text: string, what: string): Words {
  return new Words(text.trim(), what);
}

class Value {
  constructor(readonly text: string) {}
}
/** What stands behind `=`. */
export function value(text: string): Value {
  return new Value(text.trim());
}

export const kAddresses = 'an address or a symbol; write for example Q0.1, VW100 or T37';
export const kValues = 'a value; write for example 5, -5, 16#FF, 2#1010, or 1.5 of a floating point number';

type Piece = string | number | string[] | Words | Value;

/** Numbers may have blanks between their digits: `2#1010 0011`. */
function value_text(typed: string): { text: string } | { why: string } {
  const text = typed.includes("'") ? typed : typed.replace(/\s/g, '');
  return /^[^\s;\x00-\x1f\x7f]+$/.test(text) ? { text } : { why: `'${typed}' is not ${kValues}` };
}

/** The text of a piece, or why it has none. */
function text_of(piece: Piece): { text: string } | { why: string } {
  if (typeof piece === 'number') return { text: String(piece) };
  if (piece instanceof Words) return is_of_one_command(piece.text) ? piece : { why: `'${piece.text}' is not ${piece.what}` };
  if (piece instanceof Value) return value_text(piece.text);
  const all = typeof piece === 'string' ? [piece] : piece, wrong = all.find((one) => word_of(one) === undefined);
  return wrong === undefined ? { text: all.map(word_of).join(' ') } : { why: `'${wrong}' is not ${kAddresses}` };
}

/** line_of`set ${address}=${value(text)}`: what is between the braces is a word, or as many words as it says. */
export function line_of(own: TemplateStringsArray, ...pieces: Piece[]): Command {
  let line = own[0]!;
  for (const [i, piece] of pieces.entries()) {
    const part = text_of(piece);
    if ('why' in part) return new Refused(own[0]!.split(' ', 1)[0]!, part.why);
    line += part.text + own[i + 1]!;
  }
  return line as Line;
}
