// The right side: panes that share a place.
import { h, kept, type Part } from '../dom';
import { kPanes, type PaneName, type SideName } from '../pane_table';
import { show_pane, state } from '../state';
import { causes_pane } from './causes';
import { chart_pane } from './chart';
import { line_pane } from './line';
import { report_pane } from './report';
import type { Outline } from '../protocol';

const kContents: Record<SideName, () => Part> = { report: report_pane, chart: chart_pane, line: line_pane, causes: causes_pane };
const kSides = kPanes.filter((one) => one.aside);

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

const kOffered = 500;

/** What may be typed where an address is asked for. */
const symbols = kept((outline: Outline | null): Part =>
  h('datalist', { id: 'symbols' }, (outline?.symbols ?? []).slice(0, kOffered).map((one) => h('option', { value: one.name }, `${one.address}  ${one.comment}`))));

function content(pane: SideName): Part {
  return h('div', { class: 'scrolls', key: pane, 'data-of': pane }, kContents[pane]());
}

/** A report is printed whatever is in front. */
function on_paper(shown: SideName): Part[] {
  return [...(state.report && shown !== 'report' ? [content('report'), h('h2', {}, kSides.find((one) => one.pane === shown)!.name)] : []), content(shown)];
}

export function side_pane(): Part {
  const sides = kSides.filter((one) => one.pane !== 'report' || state.report !== null);
  const shown = sides.find((one) => one.pane === state.side)!;
  return h('section', { id: `pane-${shown.pane}`, class: 'pane side', 'aria-label': shown.name, tabindex: '-1' },
    h('header', { role: 'tablist', onkeydown: (event: KeyboardEvent) => on_key(event, sides.map((one) => one.pane), shown.pane) }, sides.map((one) => h('button', {
      role: 'tab', id: `tab-${one.pane}`, 'aria-selected': String(one.pane === shown.pane), tabindex: one.pane === shown.pane ? '0' : '-1', onclick: () => show_pane(one.pane),
    }, one.name))),
    state.printing ? on_paper(shown.pane) : content(shown.pane), symbols(state.outline));
}
