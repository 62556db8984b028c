// What runs the PLC and steps through it, and the lamps of the CPU.
import { h, type Part } from '../dom';
import { action, go_to_typed, title_with_key } from '../actions';
import { icon } from '../icons';
import { look_at } from '../session';
import { changed, state } from '../state';
import { moment_text } from '../words';

function button(id: string, ...content: (Part | string)[]): Part {
  const one = action(id);
  return h('button', { id: `do-${id}`, title: title_with_key(one), 'aria-label': one.title, onclick: one.does }, ...content);
}

/** `◀ Scan ▶`: the same step backwards and forwards. */
function step(back: string, name: string, forward: string): Part {
  return h('div', { class: 'step', role: 'group', 'aria-label': `Step by ${name.toLowerCase()}` },
    button(back, icon('back')), h('span', {}, name), button(forward, icon('forward')));
}

function lamp(name: string, on: boolean, kind: string): Part {
  return h('span', { class: `lamp ${kind}${on ? ' on' : ''}`, role: 'img', 'aria-label': `${name} lamp ${on ? 'on' : 'off'}` }, name);
}

/** The lamp of a mode is on the button that switches the CPU to it. */
function mode_button(mode: 'RUN' | 'STOP'): Part {
  const one = action(`mode-${mode.toLowerCase()}`), on = state.past?.mode === mode;
  return h('button', { id: `do-${one.id}`, 'aria-pressed': String(on), title: title_with_key(one), onclick: one.does }, lamp(mode, on, mode.toLowerCase()));
}

function lamps(): Part {
  return h('div', { class: 'group lamps', role: 'group', 'aria-label': 'CPU' },
    lamp('SF', state.past !== null && state.past.fatal !== 0, 'fault'),
    h('div', { class: 'mode', role: 'group', 'aria-label': 'Mode of the CPU' }, mode_button('RUN'), mode_button('STOP')));
}

const kPaces = [[0.001, '1/1000'], [0.01, '1/100'], [0.1, '1/10'], [1, '1 ×'], [10, '10 ×'], [100, '100 ×'], [0, 'fastest']] as const;

function pace(): Part | null {
  if (state.hello?.live) return h('span', { class: 'live', title: 'The run follows the clock' }, 'live');
  return h('select', {
    id: 'pace', 'aria-label': 'Speed of Run', title: 'Simulated time per second of yours',
    onchange: (event: Event) => { state.pace = Number((event.target as HTMLSelectElement).value); changed(); },
  }, kPaces.map(([value, name]) => h('option', { value: String(value), selected: state.pace === value }, name)));
}

function moment(): Part {
  const now = state.past?.now_ns ?? 0;
  const field = document.activeElement;
  const typed = field instanceof HTMLInputElement && field.id === 'moment' ? field.value : undefined;
  return h('form', { class: 'moment', onsubmit: (event: Event) => {
    event.preventDefault();
    const entered = (event.target as HTMLElement).querySelector('input')!;
    go_to_typed(entered.value);
    entered.blur();
  } },
  h('input', { id: 'moment', 'aria-label': 'Moment', title: title_with_key(action('moment')), autocomplete: 'off', spellcheck: 'false',
    value: typed ?? moment_text(now), onblur: () => changed() }));
}

function stations(): Part | null {
  const all = state.hello?.stations ?? [];
  if (all.length < 2) return null;
  return h('select', { id: 'station', 'aria-label': 'PLC', title: 'The PLC that is shown', onchange: (event: Event) => void look_at((event.target as HTMLSelectElement).value) },
    all.map((name) => h('option', { value: name, selected: state.past?.station === name }, name)));
}

export function toolbar(): Part {
  const past = state.past;
  const when = past?.in_the_past ? h('span', { class: 'tag past', title: 'More has run after this moment' }, 'past')
    : h('span', { class: 'tag now', title: 'The newest moment' }, 'now');
  return h('header', { class: 'toolbar', role: 'toolbar', 'aria-label': 'Run and step' },
    lamps(),
    h('div', { class: 'group' },
      stations(),
      h('button', { id: 'do-run', class: 'run', title: title_with_key(action('run')), onclick: action('run').does },
        icon(state.running ? 'pause' : 'run'), state.running ? 'Pause' : 'Run'),
      pace()),
    h('div', { class: 'group steps' },
      step('rstep', 'Instruction', 'step'), step('rnetwork', 'Network', 'network'),
      step('rscan', 'Scan', 'scan'), step('rinterrupt', 'Interrupt', 'interrupt')),
    h('div', { class: 'group when' },
      button('start', icon('start')), moment(), button('end', icon('end')),
      h('span', { class: 'scan-number', title: 'Scan' }, `scan ${past?.scan ?? 0}`), when),
    h('div', { class: 'group right' },
      button('why', 'Why?'), button('link', icon('link')), button('theme', icon('theme')), button('help', icon('help'))));
}
