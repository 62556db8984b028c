// Which pane a narrow window shows.
import { h, type Part } from '../dom';
import { show_pane, state, type PaneName } from '../state';

const kTabs: { pane: PaneName; name: string }[] = [
  { pane: 'report', name: 'Report' },
  { pane: 'program', name: 'Program' },
  { pane: 'chart', name: 'Chart' },
  { pane: 'line', name: 'Line' },
  { pane: 'causes', name: 'Why' },
  { pane: 'timeline', name: 'Timeline' },
];

export function pane_tabs(): Part {
  return h('nav', { class: 'pane-tabs', 'aria-label': 'Panes' }, kTabs.filter(({ pane }) => pane !== 'report' || state.report).map(({ pane, name }) =>
    h('button', { 'aria-current': state.pane === pane ? 'page' : undefined, onclick: () => show_pane(pane) }, name)));
}
