// Which pane a narrow window shows.
import { h, type Part } from '../dom';
import { kPanes } from '../pane_table';
import { show_pane, state } from '../state';

export function pane_tabs(): Part {
  return h('nav', { class: 'pane-tabs', 'aria-label': 'Panes' }, kPanes.filter(({ pane }) => pane !== 'report' || state.report).map(({ pane, tab }) =>
    h('button', { 'aria-current': state.pane === pane ? 'page' : undefined, onclick: () => show_pane(pane) }, tab)));
}
