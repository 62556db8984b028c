// The messages of docs/page_protocol.md, as types. Nothing else of the page knows what is sent.

export const kProtocol = 1;

/** A command is a piece of a run: the first one, or a further one. */
export type PieceOfRun = 'begins' | 'goes on';

/** Where the session stands; times in ns of simulated time. */
export interface Past {
  now_ns: number;
  oldest_ns: number;
  newest_ns: number;
  in_the_past: boolean;
  station: string;
  scan: number;
  mode: 'RUN' | 'STOP' | 'off';
  op: number | null;
  line: number | null;
  routine: string | null;
  fatal: number;
}

export interface Reply<Json = unknown> {
  id: number | null;
  text: string;
  json: Json | null;
  moved: boolean;
  interrupted?: boolean;
  /** A stop came before it: nothing of it was done. */
  undone?: boolean;
  error?: string;
}

export interface Hello {
  event: 'hello';
  protocol: number;
  version: string;
  program: string;
  cpu: string;
  stations: string[];
  may: string[];
  live: boolean;
  now: Past;
  /** The command by which a run goes on. */
  running?: string;
  /** What a scenario has found where the session stands, in lines. */
  found?: string;
}

export type Notification =
  | Hello
  | { event: 'moved'; now: Past; by: string }
  | { event: 'changed'; by: string }
  | { event: 'running'; command: string }
  | { event: 'stopped' }
  | { event: 'printed'; text: string }
  | { event: 'ended'; why: string };

/** A system file as the engine takes it: its tree, and the files that it names. */
export interface CarriedSystem {
  name: string;
  tree: unknown;
  files: unknown[];
}

/** What an engine can open. */
export type Openable = { sources: (Source | { name: string; hex: string })[]; options: Record<string, unknown> } | { system: CarriedSystem };

/** A report: each program once, systems, and what ran. */
export interface Report {
  version: string;
  verb: string;
  programs: Source[][];
  systems?: CarriedSystem[];
  runs: ReportedRun[];
  /** Of `decode`, which runs nothing. */
  conversation?: DecodedConversation;
}

/** The object of `s7200 decode --json`: tools/JSON.md. */
export interface DecodedConversation {
  file: string;
  form: string | null;
  protocol: string;
  line: string | null;
  frames: DecodedFrame[];
  summary: { requests: number; answered: number; wrong: number; strays: number; shortest_latency_us: number | null; longest_latency_us: number | null };
}

export interface DecodedFrame {
  place: string;
  at_us: number | null;
  silence_us: number | null;
  kind: 'request' | 'answer' | 'echo' | 'stray' | 'unread';
  bytes: string;
  right: boolean;
  text: string;
  latency_us: number | null;
  /** It is known that no answer to it came. */
  unanswered: boolean;
}

export interface ReportedRun {
  /** Of a scenario; else empty. */
  file: string;
  name: string;
  outcome: string;
  reason?: string;
  findings: ReportedFinding[];
  /** What can be run again. */
  program?: number;
  options?: Record<string, unknown>;
  system?: number;
  recordings?: Recorded[];
}

export interface ReportedFinding {
  text: string;
  why?: string[];
  line?: number;
  recording?: number;
  at_ns?: number;
}

/** What came from outside, as the engine takes it; `end` has its moment in ns third. */
export interface Recorded {
  count: number;
  actions: Record<string, unknown>[];
  done: { action?: number[]; after_ns?: number[] };
  end: [number, number, number, number];
  picture?: Spans | null;
}

export interface Network {
  number: number | null;
  title: string;
  line: number;
  first: number;
  end: number;
}

export interface Routine {
  name: string;
  line: number;
  first: number;
  end: number;
  networks: Network[];
}

export interface ProgramSymbol {
  name: string;
  address: string;
  comment: string;
}

export interface Outline {
  program: string;
  /** The program first; the lines of each file follow those of the one before it. */
  files: { line: number; name: string }[];
  cpu: string;
  lines: number;
  ops: number;
  routines: Routine[];
  symbols: ProgramSymbol[];
  /** The inputs and outputs that it names bit by bit. */
  points: string[];
}

export interface Operand {
  text: string;
  address: string;
  symbol: string;
  pointer: boolean;
}

export interface Line {
  line: number;
  text: string;
  op: number | null;
  mnemonic?: string;
  operands?: Operand[];
  kind?: 'contact' | 'coil' | 'box' | 'stack' | 'structure';
}

export interface Execution {
  op: number;
  line: number;
  at_ns: number;
  powerFlow: boolean;
  top: boolean;
  values: (number | boolean | null)[];
  text: string;
}

export interface Status {
  lines: Execution[];
  since_ns: number;
}

export interface Value {
  name: string;
  address: string;
  symbol: string;
  type: 'bit' | 'byte' | 'word' | 'dword' | 'real';
  text: string;
  number: number;
  forced: boolean;
  error?: string;
}

export interface Span {
  /** Of the page itself: another future does not have it. */
  differs?: boolean;
  /** And up to when it is known to: the other future ends there. */
  differs_until_ns?: number;
  at_ns: number;
  end_ns: number;
  text: string;
  error?: string;
  value?: number;
  least?: number;
  most?: number;
  occurred_ns?: number;
  why?: string;
  op?: number;
  count?: number;
  busy_ns?: number;
  errors?: number;
}

export type TrackKind =
  | 'characters' | 'frames' | 'interrupts' | 'queues' | 'scans' | 'networks' | 'routines' | 'events' | 'errors' | 'value';

export interface SerialFormat {
  baud: number;
  data_bits: number;
  parity: 'none' | 'even' | 'odd';
  stop_bits: number;
}

export interface SpanTrack {
  /** Of the page itself: it is of the first of two futures. */
  before?: boolean;
  /** And what it was there is not known. */
  unknown?: boolean;
  kind: TrackKind;
  name: string;
  station?: string;
  exact: boolean;
  /** Of characters: the format that they have. */
  format?: SerialFormat;
  spans: Span[];
}

/** Numbers from one change to the next. */
export const is_of_numbers = (track: SpanTrack): boolean => track.kind === 'value' || track.kind === 'queues';

export interface Spans {
  from_ns: number;
  to_ns: number;
  interrupted?: boolean;
  left_out?: string[];
  tracks: SpanTrack[];
  answers?: Answers;
  longest_scans?: LongestScan[];
}

export interface LongestScan {
  at_ns: number;
  end_ns: number;
  text: string;
  station?: string;
}

/** What a PLC has sent after what it received: how often, and when it took longest. */
export interface Answers {
  count: number;
  longest: { at_ns: number; end_ns: number; answer_ns: number; answer_end_ns: number; text: string; station?: string }[];
}

/** A node of `why not`: what has a name has a value and is to have another one; else its text says all. */
export interface Obstacle {
  kind: string;
  name?: string;
  value?: string;
  wanted?: string;
  text?: string;
  place?: string;
  op?: number;
  since_ns?: number;
  since_before_ns?: number;
  because?: Obstacle[];
}

/** `actions`: what was done from outside. */
export interface Done {
  count: number;
  actions: { at_ns: number; text: string; station?: string }[];
}

/** `port`: its number, and what its control byte says in words. */
export interface PortSettings {
  port: number;
  mode: string;
}

/** `who`, `why`: in words, and the instruction if it was one. */
export interface Cause {
  text?: string;
  routine?: string;
  op?: number;
  name?: string;
  value?: number | boolean;
  causes?: unknown[];
  /** Of `why not`: false, and then what is in the way. */
  holds?: boolean;
  whyNot?: Obstacle;
}

/** Breakpoints and watches. */
export interface Stops {
  stops: { number: number; kind: 'break' | 'watch'; text: string; hits: number; line?: number; op?: number; station?: string }[];
}

/** Why a run came to its end. */
export interface Stopped {
  stopped: 'goal' | 'stop point' | 'answer' | 'limit' | 'request' | 'CPU' | 'oldest';
}

/** A mistake or warning as `check` says it. */
export interface Diagnostic {
  severity: 'error' | 'warning';
  file?: string;
  section?: string;
  line: number;
  column: number;
  length: number;
  message: string;
  hint: string;
  name: string;
}

export interface Source {
  name: string;
  text: string;
  /** The bytes of a file that is not UTF-8; its text is a guess until the session has read them. */
  hex?: string;
}

export interface Opened {
  /** What is worth knowing of how it was read. */
  notes?: string[];
  cpu?: string;
  diagnostics: Diagnostic[];
  text: string;
  opened: boolean;
  /** Those that were sent in hex, as texts. */
  sources?: (Source & { encoding: string })[];
}

/** A network as ladder: places are columns of characters and rows of lines; the power rail is column 0 and point 0. */
export interface LadderNetwork {
  routine: string;
  network: number;
  title: string;
  line: number;
  first_op: number;
  ops: number;
  comments: string[];
  /** What is known of its addresses: symbols and their comments. */
  notes: { text: string; symbol: string; comment: string }[];
  head: string | null;
  why_not: string | null;
  elements?: LadderElement[];
  grid?: LadderGrid;
  /** Whether each point has power. */
  power?: boolean[];
}

export interface GridText {
  text: string;
  column: number;
  row: number;
}

export interface LadderElement {
  kind: 'contact' | 'coil' | 'box';
  symbol: string;
  op: number | null;
  line: number;
  column: number;
  row: number;
  width: number;
  height: number;
  from: number;
  to: number | null;
  operands: GridText[];
  pins: { name: string; operand: string; row: number; name_column: number; operand_column: number; right: boolean; power: boolean }[];
  value?: string;
}

export interface LadderGrid {
  columns: number;
  rows: number;
  first_rung: number;
  points: number;
  wires: { column: number; row: number; to_column: number; to_row: number; point: number }[];
  connectors: (GridText & { begins: boolean; point: number })[];
}
