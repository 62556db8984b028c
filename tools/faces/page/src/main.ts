// The page: connects to what runs the session, and renders what is known of it.
import { h, render, type Part } from './dom';
import { SocketEngine, WorkerEngine, type Engine, type Onlooker } from './engine';
import { follow_address, notified } from './session';
import { changed, on_change, state, use_engine } from './state';
import { apply_theme, begin_theme, on_key } from './actions';
import { toolbar } from './panes/toolbar';
import { status_bar } from './panes/status_bar';
import { is_opener_shown, program_pane } from './panes/program';
import { conversation_page } from './panes/conversation';
import { side_pane } from './panes/side';
import { room_of_tracks, timeline_pane } from './panes/timeline';
import { pane_tabs } from './panes/tabs';
import { load_chart } from './panes/chart';
import { dialogs } from './panes/dialogs';
import { menu } from './panes/menu';
import { start_timeline } from './timeline/view';
import { start_futures } from './futures';
import { accept_drops, open_from_address } from './playground';
import { open_report, opens_another_run } from './report';

const onlooker: Onlooker = {
  notified,
  connection: (connection) => {
    if ((state.connection === 'ended' || connection === 'connecting') && connection !== 'connected') return;
    state.connection = connection;
    if (connection === 'lost') state.running = state.others_run = false;
    changed();
  },
};

function page(): (Part | null)[] {
  if (state.report?.conversation) return [...conversation_page(state.report.conversation), dialogs()];
  return [
    toolbar(),
    h('main', { class: is_opener_shown() ? 'panes opening' : 'panes', 'data-pane': state.pane, style: { '--tracks': `${room_of_tracks()}px` } }, program_pane(), side_pane(), timeline_pane()),
    pane_tabs(), status_bar(), menu(), dialogs(),
  ];
}

const has_overlay = (): boolean => state.dialog !== null || state.menu !== null;

/** What is behind a dialog or a menu is out of reach. */
function reachable(part: Part | null): Part | null {
  if (part && !/shade/.test(String(part.attributes['class']))) part.attributes['inert'] = has_overlay();
  return part;
}

/** Where the focus was before there was a dialog or a menu; it is there again after it. */
let before: Element | null = null;
let had_overlay = false;

function give_focus_back(): void {
  if (before instanceof HTMLElement || before instanceof SVGElement) before.focus();
  if (before !== document.body && document.activeElement === document.body) document.querySelector<HTMLElement>(`#pane-${state.pane}`)?.focus();
  before = null;
}

function show(): void {
  const overlay = has_overlay();
  if (overlay && !had_overlay) before = document.activeElement;
  render(document.body, page().map(reachable));
  if (had_overlay && !overlay) give_focus_back();
  had_overlay = overlay;
}

/** What is drawn for paper is drawn at once: the browser takes it as it is. */
function print(on: boolean): void {
  state.printing = on;
  apply_theme();
  show();
}

/** The playground has its worker in the page itself; the page of `s7200 view` has a socket beside it. */
function engine(): Engine {
  const worker = document.querySelector('#worker');
  if (worker) return new WorkerEngine(URL.createObjectURL(new Blob([worker.textContent ?? ''], { type: 'text/javascript' })), onlooker);
  const address = new URL('socket', location.href);
  address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';
  address.hash = '';
  return new SocketEngine(address.href, onlooker);
}

function start(): void {
  begin_theme();
  load_chart();
  start_timeline();
  start_futures();
  on_change(show);
  addEventListener('beforeprint', () => print(true));
  addEventListener('afterprint', () => print(false));
  addEventListener('keydown', on_key);
  addEventListener('resize', changed);
  addEventListener('hashchange', () => {
    if (!opens_another_run()) void follow_address();
  });
  use_engine(engine());
  accept_drops();
  void open_report().then((opened) => { if (!opened) void open_from_address(); });
  changed();
}

start();
