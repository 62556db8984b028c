// The right side: panes that share a place.
import { h, type Part } from '../dom';
import { show_pane, state } from '../state';
import { causes_pane } from './causes';
import { chart_pane } from './chart';
import { line_pane } from './line';
import { report_pane } from './report';

const kSides = [
  { id: 'report', name: 'Report', content: report_pane },
  { id: 'chart', name: 'Status chart', content: chart_pane },
  { id: 'line', name: 'Line', content: line_pane },
  { id: 'causes', name: 'Why', content: causes_pane },
] as const;

export function side_pane(): Part {
  const sides = kSides.filter((one) => one.id !== 'report' || state.report !== null);
  const shown = sides.find((one) => one.id === state.side)!;
  return h('section', { id: `pane-${shown.id}`, class: 'pane side', 'aria-label': shown.name, tabindex: '-1' },
    h('header', { role: 'tablist' }, sides.map((one) => h('button', {
      role: 'tab', id: `tab-${one.id}`, 'aria-selected': String(one.id === shown.id), onclick: () => show_pane(one.id),
    }, one.name))),
    h('div', { class: 'scrolls', key: shown.id }, shown.content()));
}
