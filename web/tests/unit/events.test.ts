// Events of jobs, in pieces as they arrive.

import { expect, test } from "vitest";
import { Events } from "../../src/events";

test("events are complete however the stream is cut", () => {
  const stream = 'event: job\ndata: {"a":1}\n\n: keep alive\n\nevent: job\ndata: {"a":\ndata: 2}\n\ndata: not ended';
  for (const size of [1, 2, 3, 7, stream.length]) {
    const given: string[] = [];
    const events = new Events((data) => given.push(data));
    for (let at = 0; at < stream.length; at += size) events.take(stream.slice(at, at + size));
    expect(given).toEqual(['{"a":1}', '{"a":\n2}']);
  }
});
