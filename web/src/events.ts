// Server-sent events read from a request with headers: EventSource would need the token in the address.

export class Events {
  private rest = "";

  constructor(private readonly data: (data: string) => void) {}

  /** The next piece of the stream; an event ends with an empty line. */
  take(piece: string): void {
    const events = (this.rest + piece).split("\n\n");
    this.rest = events.pop()!;
    for (const event of events) {
      const data = event.split("\n").flatMap((line) => (line.startsWith("data:") ? [line.slice(5).replace(/^ /, "")] : []));
      if (data.length > 0) this.data(data.join("\n"));
    }
  }
}
