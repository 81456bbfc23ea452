// Tabs of one browser on one study: which there are, and what they tell each other. A tab that is opened at a new address after a
// restart of the server passes its token on, so that the others continue.

export interface Message {
  kind: "hello" | "here" | "saved" | "bye";
  tab: string;
  token: string;
  unsaved: boolean;
}

export interface Handlers {
  token: () => string;
  unsaved: () => boolean;
  /** Another tab has saved the study. */
  saved: () => void;
  /** Another tab has a token, which is newer if it says hello. */
  token_from: (token: string) => void;
  /** The other tabs have changed. */
  others: (tabs: ReadonlyMap<string, boolean>) => void;
}

const LOCK = "armill-tab-";
const TOKENS = "armill-token";
/** How long a tab without a token waits for one. */
const TOKEN_MS = 400;

/** Gives the token to tabs of this server that are opened by a link without it. */
function shareToken(token: () => string): void {
  const channel = new BroadcastChannel(TOKENS);
  channel.onmessage = (event: MessageEvent<string>) => event.data === "" && channel.postMessage(token());
}

/** The token of another tab of this server; "" if there is none. */
export function tokenOfOthers(): Promise<string> {
  const channel = new BroadcastChannel(TOKENS);
  return new Promise<string>((done) => {
    channel.onmessage = (event: MessageEvent<string>) => event.data !== "" && done(event.data);
    setTimeout(() => done(""), TOKEN_MS);
    channel.postMessage("");
  }).finally(() => channel.close());
}

export class Tabs {
  private readonly channel: BroadcastChannel;
  private readonly known = new Map<string, boolean>();
  readonly others: ReadonlyMap<string, boolean> = this.known;

  constructor(
    identity: string,
    readonly tab: string,
    private readonly handlers: Handlers,
  ) {
    this.channel = new BroadcastChannel(`armill\n${identity}`);
    this.channel.onmessage = (event: MessageEvent<Message>) => this.receive(event.data);
    // Held until the tab is closed.
    void navigator.locks?.request(LOCK + tab, () => new Promise<never>(() => undefined));
    addEventListener("pagehide", () => this.send("bye"));
    addEventListener("pageshow", (event) => event.persisted && this.send("hello"));
    shareToken(handlers.token);
    this.send("hello");
  }

  send(kind: Message["kind"]): void {
    this.channel.postMessage({ kind, tab: this.tab, token: this.handlers.token(), unsaved: this.handlers.unsaved() } satisfies Message);
  }

  private receive(message: Message): void {
    const { kind, tab, token, unsaved } = message;
    if (kind === "hello") {
      this.handlers.token_from(token);
      this.send("here");
    }
    if (kind === "saved") this.handlers.saved();
    const before = JSON.stringify([...this.known]);
    if (kind === "bye") this.known.delete(tab);
    else this.known.set(tab, unsaved);
    if (JSON.stringify([...this.known]) !== before) this.handlers.others(this.known);
  }
}

/** Name of this tab: the same after a reload, another one than that of every open tab. */
export async function nameOfTab(): Promise<string> {
  const KEY = "armill-tab";
  const kept = sessionStorage.getItem(KEY);
  // A duplicated tab has the name of its original. A reloaded one may be seen as open for a moment.
  const [navigation] = performance.getEntriesByType("navigation") as PerformanceNavigationTiming[];
  const own = kept !== null && (navigation?.type === "reload" || !(await openTabs()).has(kept));
  const name = own ? kept : Math.random().toString(36).slice(2, 12);
  sessionStorage.setItem(KEY, name);
  return name;
}

/** Names of the tabs that are open now. */
export async function openTabs(): Promise<Set<string>> {
  const held = (await navigator.locks?.query())?.held ?? [];
  return new Set(held.flatMap(({ name }) => (name?.startsWith(LOCK) ? [name.slice(LOCK.length)] : [])));
}
