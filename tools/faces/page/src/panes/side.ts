// The right side: panes that share a place.
import { h, type Part } from '../dom';
import { show_pane, state, type PaneName } from '../state';
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

/** Arrow keys go from tab to tab, which is one stop of the tab key. */
function on_key<Id extends PaneName>(event: KeyboardEvent, ids: Id[], shown: Id): void {
  const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  if (step === undefined) return;
  event.preventDefault();
  event.stopPropagation();
  const next = ids[(ids.indexOf(shown) + step + ids.length) % ids.length]!;
  show_pane(next);
  document.querySelector<HTMLElement>(`#tab-${next}`)?.focus();
}

export function side_pane(): Part {
  const sides = kSides.filter((one) => one.id !== 'report' || state.report !== null);
  const shown = sides.find((one) => one.id === state.side)!;
  return h('section', { id: `pane-${shown.id}`, class: 'pane side', 'aria-label': shown.name, tabindex: '-1' },
    h('header', { role: 'tablist', onkeydown: (event: KeyboardEvent) => on_key(event, sides.map((one) => one.id), shown.id) }, sides.map((one) => h('button', {
      role: 'tab', id: `tab-${one.id}`, 'aria-selected': String(one.id === shown.id), tabindex: one.id === shown.id ? '0' : '-1', onclick: () => show_pane(one.id),
    }, one.name))),
    h('div', { class: 'scrolls', key: shown.id }, shown.content()));
}
