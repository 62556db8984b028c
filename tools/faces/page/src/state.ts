// All that the page shows, as plain data. Who changes it says changed(), and the page is rendered with the next frame.
import type { Connection, Engine } from './engine';
import type { Cause, Done, Execution, Hello, LadderNetwork, Line, Outline, Past, Report, Source, Span, Spans, Value } from './protocol';
import type { Exchange } from './exchanges';
import type { Format } from './formats';
import { side_of, type PaneName, type SideName } from './pane_table';
import type { Measurement } from './timeline/measure';

export type Theme = 'system' | 'light' | 'dark';

/** A row of the status chart. */
export interface ChartRow {
  address: string;
  format: Format;
  new_value: string;
}

/** How a switch works: it stays where it is put, returns when it is let go, or gives pulses. */
export type SwitchKind = 'switch' | 'push' | 'pulses';
export interface PointRow {
  address: string;
  kind: SwitchKind;
  /** Of pulses: how many a second. */
  hertz: number;
}

/** A run stops when this address changes. */
export interface Watch {
  number: number;
  station: string;
  address: string;
}

/** A step of the trail that leads to a cause. */
export interface TrailStep {
  question: string;
  at_ns: number;
  text: string;
  cause: Cause | null;
}

/** A menu about an address, at a place of the window. */
export interface Menu {
  x: number;
  y: number;
  address: string;
  op: number | null;
}

export interface State {
  connection: Connection;
  why_ended: string;
  hello: Hello | null;
  past: Past | null;
  running: boolean;
  /** It is this page that runs it, piece by piece. */
  own_run: boolean;
  /** Another page does. */
  others_run: boolean;
  /** Simulated seconds a second; 0: as fast as it goes. */
  pace: number;
  /** What is said over the status bar; of a command that was refused with the kind of command. */
  notice: { text: string; kind: 'info' | 'error'; of: string } | null;
  dialog: 'help' | 'about' | 'measurement' | 'power-up' | null;
  menu: Menu | null;
  theme: Theme;
  /** The page is being drawn for paper. */
  printing: boolean;
  /** Which pane a narrow window shows. */
  pane: PaneName;
  /** Which of those that share the right side is in front. */
  side: SideName;

  outline: Outline | null;
  lines: Map<number, Line>;
  executions: Map<number, Execution>;
  /** Of which lines, and from which moment on, all last executions are known. */
  executions_known: { first: number; last: number; since_ns: number } | null;
  /** Networks as ladder, by the line of the network. */
  ladder: Map<number, LadderNetwork[]>;
  view: 'stl' | 'ladder';
  /** The session can draw networks. */
  has_ladder: boolean;
  selected_line: number | null;
  follow: boolean;
  breakpoints: Map<number, number>;
  /** Changes of memory at which a run stops, of all PLCs. */
  watches: Watch[];

  chart: ChartRow[];
  inputs: PointRow[];
  outputs: string[];
  /** Where this page has put switches: the program finds that when it next reads its inputs. */
  switched: Map<string, { level: number; at_ns: number; scan: number }>;
  values: Map<string, Value>;
  samples: Map<string, { at_ns: number; number: number }[]>;

  /** What the timeline shows is being computed. */
  computing: boolean;
  window: { from_ns: number; to_ns: number } | null;
  spans: Spans | null;
  cursors: { a_ns: number | null; b_ns: number | null };
  measurement: Measurement | null;
  watched: string[];
  /** Of two futures the one that was kept. */
  first_future: { at_ns: number; until_ns: number; spans: Spans } | null;
  /** When both futures part; null while they are the same. */
  futures_part_ns: number | null;
  /** Moments that the reader has marked, in their order. */
  marks: number[];
  selected_span: Span | null;

  trail: TrailStep[];
  printed: string[];
  exchanges: Spans | null;
  /** The middle of the part of the past whose exchanges are listed; null: the present. */
  exchanges_around_ns: number | null;
  /** There is more of the past before that part, and after it. */
  exchanges_before: boolean;
  exchanges_after: boolean;
  /** What was done from outside up to now. */
  done: Done | null;
  send_text: string;

  /** Of a report: what it carries, the run and the recording that are open, the moment to begin at, and a coarse picture of all of it. */
  report: Report | null;
  run: number | null;
  recording: number | null;
  first_moment: number | null;
  /** Requests of it that have no answer. */
  unanswered: Exchange[];
  picture: Spans | null;

  /** Of the playground: the files, the PLC type that was chosen, and what check said. */
  sources: Source[];
  cpu: string;
  opening: boolean;
  check_text: string;
  check_notes: string[];
}

export const state: State = {
  connection: 'connecting',
  why_ended: '',
  hello: null,
  past: null,
  running: false,
  own_run: false,
  others_run: false,
  pace: 1,
  notice: null,
  dialog: null,
  menu: null,
  theme: 'system',
  printing: false,
  pane: 'program',
  side: 'chart',
  outline: null,
  lines: new Map(),
  executions: new Map(),
  executions_known: null,
  ladder: new Map(),
  view: 'stl',
  has_ladder: false,
  selected_line: null,
  follow: true,
  breakpoints: new Map(),
  watches: [],
  chart: [],
  inputs: [],
  outputs: [],
  switched: new Map(),
  values: new Map(),
  samples: new Map(),
  computing: false,
  window: null,
  spans: null,
  cursors: { a_ns: null, b_ns: null },
  measurement: null,
  watched: [],
  first_future: null,
  futures_part_ns: null,
  marks: [],
  selected_span: null,
  trail: [],
  printed: [],
  exchanges: null,
  exchanges_around_ns: null,
  exchanges_before: false,
  exchanges_after: false,
  done: null,
  send_text: '',
  report: null,
  run: null,
  recording: null,
  first_moment: null,
  unanswered: [],
  picture: null,
  sources: [],
  cpu: '',
  opening: false,
  check_text: '',
  check_notes: [],
};

let engine: Engine | undefined;
export function use_engine(one: Engine): void {
  engine = one;
}
export function the_engine(): Engine {
  return engine!;
}

let render_page: () => void = () => {};
let asked = false;
export function on_change(render: () => void): void {
  render_page = render;
}
export function changed(): void {
  if (asked) return;
  asked = true;
  requestAnimationFrame(() => {
    asked = false;
    render_page();
  });
}

export function show_dialog(which: State['dialog']): void {
  state.dialog = which;
  changed();
}

/** Brings a pane to the front. */
export function show_pane(pane: PaneName): void {
  state.pane = pane;
  state.side = side_of(pane) ?? state.side;
  changed();
}

export const kRowsOnPaper = 30;

/** How many rows of a list are shown that shows so many on the screen: paper has fewer. What is left out is said below them. */
export function rows_shown(on_screen: number): number {
  return state.printing ? kRowsOnPaper : on_screen;
}

export function notice(text: string, kind: 'info' | 'error' = 'info', of = ''): void {
  state.notice = text === '' ? null : { text, kind, of };
  changed();
}
