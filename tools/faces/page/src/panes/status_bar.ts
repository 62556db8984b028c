// What connects the page, where the CPU stands, and what was said last.
import { h, type Part } from '../dom';
import { changed, state } from '../state';
import { icon } from '../icons';
import { toggle_dialog } from '../actions';
import { can_open } from '../playground';
import { in_formats } from '../formats';
import { with_times } from '../words';

const kConnections = {
  connecting: 'connecting …',
  connected: 'connected',
  lost: 'connection lost; trying again …',
  ended: 'the session has ended',
};

function place(): string {
  const past = state.past;
  if (!past) return '';
  if (past.mode === 'off') return 'the PLC has no power';
  const where = past.line === null ? '' : `${past.routine ?? ''}, line ${past.line}`;
  if (past.mode !== 'STOP') return where;
  return past.fatal ? `STOP, fatal error ${past.fatal}${where && ` in ${where}`}` : 'STOP';
}

export function status_bar(): Part {
  return h('footer', { class: 'status-bar' },
    h('span', { class: `connection ${state.connection}`, role: 'status', 'aria-live': 'polite' },
      kConnections[state.connection] + (state.connection === 'ended' && state.why_ended ? `: ${state.why_ended}` : '')),
    h('span', { class: 'scan-here' }, state.past ? `scan ${state.past.scan}` : ''),
    h('span', { class: 'place' }, place()),
    h('div', { class: 'printed' }, h('span', {}, in_formats(with_times(state.printed[state.printed.length - 1] ?? ''))), notice_bar()),
    h('button', { class: 'plain program-name', title: state.hello?.program ?? 'About this page', onclick: toggle_dialog('about') },
      state.hello ? `${state.hello.program.replace(/^.*[\\/]/, '')} · CPU ${state.outline?.cpu ?? state.hello.cpu}` : 's7200'));
}

/** What is wrong, or was done: over the status bar, where it moves no pane, until it is put away or something else is done. */
function notice_bar(): Part | null {
  if (state.connection === 'lost')
    return h('div', { class: 'notice error', role: 'alert', key: 'lost' },
      'The connection to s7200 is lost. What you see is the last that was known; the page connects again by itself.');
  if (state.connection === 'ended')
    return h('div', { class: 'notice error', role: 'alert', key: 'ended' },
      `The session has ended${state.why_ended ? `: ${state.why_ended}` : ''}. What you see is the last that was known${can_open() ? '' : '; when s7200 is started at this address again, the page connects to it'}.`);
  if (!state.notice) return null;
  return h('div', { class: `notice ${state.notice.kind}`, role: state.notice.kind === 'error' ? 'alert' : 'status', key: 'notice' },
    h('span', {}, with_times(state.notice.text)),
    h('button', { class: 'plain', 'aria-label': 'Put away', onclick: () => { state.notice = null; changed(); } }, icon('close')));
}
