// Newest wins: one request at a time, the newest input next, everything between dropped.
//
// While the user drags, inputs come faster than answers. The running request may end, so that the picture follows the
// hand; if it takes longer than `patience_ms` it is aborted in favour of the newest. An answer that is older than
// the one shown can never arrive, since no two requests run at once.

export interface Handlers<Input, Output> {
  work: (input: Input, signal: AbortSignal) => Promise<Output>;
  /** `settled`: nothing newer waits. */
  done: (output: Output, input: Input, settled: boolean) => void;
  failed: (error: unknown, input: Input) => void;
  busy?: (busy: boolean) => void;
}

export class Newest<Input, Output> {
  private running: { abort: AbortController; since: number } | null = null;
  private waiting: { input: Input } | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly handlers: Handlers<Input, Output>,
    private readonly patience_ms = 400,
  ) {}

  get idle(): boolean {
    return this.running === null && this.waiting === null;
  }

  submit(input: Input): void {
    if (this.running === null) {
      void this.run(input);
      return;
    }
    this.waiting = { input };
    clearTimeout(this.timer);
    const { abort, since } = this.running;
    this.timer = setTimeout(() => abort.abort(), Math.max(0, since + this.patience_ms - Date.now()));
  }

  /** Drops what waits and what runs: its answer will not be shown. */
  cancel(): void {
    this.waiting = null;
    clearTimeout(this.timer);
    this.running?.abort.abort();
  }

  private async run(input: Input): Promise<void> {
    const abort = new AbortController();
    this.running = { abort, since: Date.now() };
    this.handlers.busy?.(true);
    try {
      const output = await this.handlers.work(input, abort.signal);
      if (!abort.signal.aborted) this.handlers.done(output, input, this.waiting === null);
    } catch (error) {
      // Errors of superseded requests are ignored.
      if (!abort.signal.aborted && this.waiting === null) this.handlers.failed(error, input);
    }
    clearTimeout(this.timer);
    this.running = null;
    const next = this.waiting;
    this.waiting = null;
    if (next) void this.run(next.input);
    else this.handlers.busy?.(false);
  }
}
