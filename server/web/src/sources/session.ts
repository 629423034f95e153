/** Questions over a WebSocket: the last of a kind wins; a session that is lost is opened again. */

import { Refused, type Answer, type Request } from "../contract";
import { answerOf, readReply, replaced } from "./answer";

type Listener = (state: "lost" | "back" | Refused) => void;
interface Waiting { ask: Request["ask"]; resolve(answer: Answer): void; reject(error: Error): void }

const PROTOCOL = "wsrender.v1";
const KEY_PREFIX = "wsrender.key64."; // browsers can't set headers of a WebSocket, nor name a subprotocol by any letter
const NORMAL = 1000, REFUSED = 1008; // with which the server closes
const FIRST_PAUSE_MS = 500, LONGEST_PAUSE_MS = 8000;

export class Session {
  private socket: WebSocket | null = null;
  private open: Promise<WebSocket> | null = null;
  private waiting = new Map<number, Waiting>();
  private listeners = new Set<Listener>();
  private next = 1;
  private pause = FIRST_PAUSE_MS;
  private lost = false;
  private silent = false; // since a session was refused
  private closed = false;
  private refused: Refused | null = null; // what the server said before it closed

  /** `first`: what the session is about, where its address does not say. */
  constructor(private readonly url: URL, private readonly key: () => string, private readonly first?: string) {
    this.url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  }

  async ask(request: Request): Promise<Answer> {
    for (const [id, other] of this.waiting) if (other.ask === request.ask) this.settle(id)?.reject(replaced());
    const id = this.next++;
    const answer = new Promise<Answer>((resolve, reject) => this.waiting.set(id, { ask: request.ask, resolve, reject }));
    this.connected().then(
      (socket) => { if (this.waiting.has(id)) socket.send(JSON.stringify({ id, ...request })); },
      (error) => this.settle(id)?.reject(error),
    );
    return answer;
  }

  onState(listener: Listener): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  close(): void {
    this.closed = true;
    for (const id of [...this.waiting.keys()]) this.settle(id)?.reject(replaced());
    this.socket?.close(NORMAL);
  }

  private connected(): Promise<WebSocket> {
    if (this.closed) return Promise.reject(replaced());
    this.open ??= new Promise((resolve, reject) => {
      const socket = new WebSocket(this.url, [PROTOCOL, ...(this.key() ? [KEY_PREFIX + base64url(this.key())] : [])]);
      socket.binaryType = "arraybuffer";
      socket.onopen = () => {
        if (this.closed) return socket.close(NORMAL);
        this.socket = socket;
        this.pause = FIRST_PAUSE_MS;
        if (this.first !== undefined) socket.send(this.first);
        if (this.lost) this.say("back");
        resolve(socket);
      };
      socket.onmessage = ({ data }) => this.receive(data);
      socket.onclose = (event) => {
        this.socket = this.open = null;
        const refused = event.code === REFUSED ? this.refused ?? new Refused(event.reason) : null, error = refused ?? new Refused(event.reason || "The interactive session has ended.", "", "lost");
        this.refused = null;
        reject(error);
        for (const id of [...this.waiting.keys()]) this.settle(id)?.reject(error);
        if (this.closed || event.code === NORMAL) return; // ended when idle: the next question opens another
        if (refused) this.say(refused);
        else this.reconnect();
      };
    });
    return this.open;
  }

  private reconnect(): void {
    if (!this.lost) this.say("lost");
    setTimeout(() => { if (!this.closed && this.lost) this.connected().catch(() => undefined); }, this.pause);
    this.pause = Math.min(2 * this.pause, LONGEST_PAUSE_MS);
  }

  private say(state: Parameters<Listener>[0]): void {
    this.lost = state === "lost";
    this.silent = state instanceof Refused;
    for (const listener of this.listeners) listener(state);
  }

  private receive(data: ArrayBuffer | string): void {
    if (typeof data === "string") return;
    const { reply, blobs } = readReply(data);
    if (reply.id === null && reply.refused) this.refused = new Refused(reply.refused.message, reply.refused.field, reply.refused.code);
    else if (this.silent) this.say("back");
    const waiting = this.settle(Number(reply.id));
    if (!waiting) return;
    try {
      waiting.resolve(answerOf(reply, blobs));
    } catch (error) {
      waiting.reject(error as Error);
    }
  }

  private settle(id: number): Waiting | undefined {
    const waiting = this.waiting.get(id);
    this.waiting.delete(id);
    return waiting;
  }
}

function base64url(text: string): string {
  return btoa(String.fromCharCode(...new TextEncoder().encode(text))).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}
