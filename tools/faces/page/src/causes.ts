// Why and who: each answer is a step of a trail that one walks back to the cause.
import { changed, show_pane, state } from './state';
import { command, go_to } from './session';
import type { Exchange } from './exchanges';
import type { Cause } from './protocol';

async function ask(question: string, line: string): Promise<void> {
  const at_ns = state.past?.now_ns ?? 0;
  const reply = await command<Cause>(line);
  if (reply.error !== undefined) return;
  state.trail.push({ question, at_ns, text: reply.text.trimEnd(), cause: reply.json });
  show_pane('causes');
}

function named(address: string): string {
  const symbol = state.outline?.symbols.find((one) => one.address.toUpperCase() === address.toUpperCase());
  return symbol ? `${symbol.name} (${address})` : address;
}

export function ask_why(address = ''): Promise<void> {
  return ask(address ? `Why is ${named(address)} so?` : 'Why has it come here?', `why ${address}`.trim());
}

export function ask_who(address: string): Promise<void> {
  return ask(`Who wrote ${named(address)} last?`, `who ${address}`);
}

const kAfterRequest = 100e6;  // ns after a request, when the program has made up its mind about it

/** Why a request had no answer, as it is known a little after it and before the next one. */
export async function ask_why_unanswered(one: Exchange, next: Exchange | undefined): Promise<void> {
  const newest = state.past?.newest_ns ?? 0;
  await go_to(Math.min(one.end_ns + kAfterRequest, next?.at_ns ?? Infinity, newest));
  await ask(`Why has ${one.request} no answer?`, 'why');
}

export function forget_trail(): void {
  state.trail = [];
  changed();
}
