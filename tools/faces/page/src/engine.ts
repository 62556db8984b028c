// What runs the session: s7200 at the other end of a WebSocket, or the same in a worker of the browser. Both take the same messages.
import type { Notification, Openable, Opened, PieceOfRun, Recorded, Reply } from './protocol';

export type Connection = 'connecting' | 'connected' | 'lost' | 'ended';

export interface Onlooker {
  notified(notification: Notification): void;
  connection(state: Connection): void;
}

export interface Engine {
  /** A line as at the prompt of `s7200 debug`. */
  command<Json>(line: string, run?: PieceOfRun): Promise<Reply<Json>>;
  /** Ends the command that is under way, if it can be stopped; and a run that goes on piece by piece, of whichever window. */
  stop(run?: boolean): void;
  /** Whether a run hears of a stop before it is over. */
  readonly can_be_stopped: boolean;
  /** Another program or system; only of the engine in the browser. */
  open?(what: Openable, recording?: Recorded): Promise<Reply<Opened>>;
}

/** Replies find the question they belong to by its number. */
export class Conversation {
  private next = 1;
  private readonly waiting = new Map<number, (reply: Reply<any>) => void>();

  constructor(private readonly onlooker: Onlooker, private readonly send: (text: string) => void) {}

  ask<Json>(message: object): Promise<Reply<Json>> {
    const id = this.next++;
    return new Promise((done) => {
      this.waiting.set(id, done);
      this.tell({ id, ...message });
    });
  }

  tell(message: object): void {
    this.send(JSON.stringify(message));
  }

  /** Returns the message. */
  received(text: string): any {
    const message = JSON.parse(text);
    if (message.event !== undefined) {
      this.onlooker.notified(message as Notification);
      return message;
    }
    const done = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    done?.(message as Reply<any>);
    return message;
  }

  /** No reply will come any more. */
  abandon(why: string): void {
    const all = [...this.waiting];
    this.waiting.clear();
    for (const [id, done] of all) done({ id, text: '', json: null, moved: false, error: why });
  }
}

const kFirstPause = 250, kLongestPause = 5000;  // ms between two attempts to connect

export class SocketEngine implements Engine {
  readonly can_be_stopped = true;
  private socket: WebSocket | undefined;
  private readonly conversation: Conversation;
  private pause = kFirstPause;
  private over = false;

  constructor(private readonly address: string, private readonly onlooker: Onlooker) {
    this.conversation = new Conversation(onlooker, (text) => {
      if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(text);
      else this.conversation.abandon('there is no connection to s7200');
    });
    this.connect();
  }

  command<Json>(line: string, run?: PieceOfRun): Promise<Reply<Json>> {
    return this.conversation.ask<Json>(run ? { command: line, run } : { command: line });
  }

  stop(run = false): void {
    this.conversation.tell(run ? { stop: true, run } : { stop: true });
  }

  private connect(): void {
    this.onlooker.connection('connecting');
    const socket = new WebSocket(this.address);
    this.socket = socket;
    socket.onopen = () => {
      this.pause = kFirstPause;
      this.over = false;
      this.onlooker.connection('connected');
    };
    socket.onmessage = ({ data }) => {
      if (this.conversation.received(String(data)).event === 'ended') this.over = true;
    };
    socket.onclose = () => {
      this.conversation.abandon(this.over ? 'the session has ended' : 'the connection to s7200 is lost');
      this.onlooker.connection('lost');
      if (this.over) this.pause = kLongestPause;
      setTimeout(() => this.connect(), this.pause);
      this.pause = Math.min(2 * this.pause, kLongestPause);
    };
  }
}

/** The session in the browser: a worker that holds s7200 as WebAssembly. */
export class WorkerEngine implements Engine {
  readonly can_be_stopped = false;
  private readonly worker: Worker;
  private readonly conversation: Conversation;
  private failure = '';

  constructor(address: string | URL, onlooker: Onlooker) {
    this.worker = new Worker(address);  // a page that is a file may have no worker that is a module
    this.conversation = new Conversation(onlooker, (text) => {
      if (this.failure === '') this.worker.postMessage(text);
      else this.conversation.abandon(this.failure);
    });
    this.worker.onmessage = ({ data }) => this.conversation.received(data);
    this.worker.onerror = (event) => {
      this.failure = `the engine in the browser has failed: ${event.message ?? 'it cannot be loaded'}`;
      this.conversation.abandon(this.failure);
      onlooker.connection('ended');
    };
    onlooker.connection('connected');
  }

  command<Json>(line: string, run?: PieceOfRun): Promise<Reply<Json>> {
    return this.conversation.ask<Json>(run ? { command: line, run } : { command: line });
  }

  stop(run = false): void {
    this.conversation.tell(run ? { stop: true, run } : { stop: true });
  }

  open(what: Openable, recording?: Recorded): Promise<Reply<Opened>> {
    const { picture: _of_the_page, ...recorded } = recording ?? {};
    return this.conversation.ask<Opened>({ open: recording ? { ...what, recording: recorded } : what });
  }
}
