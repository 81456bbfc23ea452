// A link to a state: analysis and text are in the part of the address behind #, which a browser sends to no server; the token is not.

/** Characters of a link that programs still pass on. */
const MOST_LINK = 60_000;

export interface LinkedState {
  text: string;
  analysis: string | null;
  /** The tab of the page. */
  tab: string;
}

/** The part behind # for a state; null if it is too long for a link. */
export async function linkOf(state: LinkedState): Promise<string | null> {
  const bytes = new TextEncoder().encode(JSON.stringify([state.analysis, state.text]));
  const packed = await through(bytes, new CompressionStream("deflate-raw"));
  const text = base64(packed);
  return text.length > MOST_LINK ? null : `#${state.tab}&state=${text}`;
}

/** The state behind #; null if there is none, or if it is damaged. */
export async function stateOf(hash: string): Promise<LinkedState | null> {
  const [, tab, packed] = /^#([a-z]*)&state=([\w-]+)$/.exec(hash) ?? [];
  if (tab === undefined || packed === undefined || packed.length > MOST_LINK) return null;
  try {
    const text = new TextDecoder().decode(await through(bytesOf(packed), new DecompressionStream("deflate-raw"), 4_000_000));
    const [analysis, study] = JSON.parse(text) as unknown[];
    return typeof study === "string" && (analysis === null || typeof analysis === "string") ? { text: study, analysis, tab } : null;
  } catch {
    return null;
  }
}

/** All bytes behind a stream; an error if they are more than `most`. */
async function through(bytes: Uint8Array<ArrayBuffer>, stream: GenericTransformStream, most = Infinity): Promise<Uint8Array<ArrayBuffer>> {
  const reader = (new Blob([bytes]).stream().pipeThrough(stream as ReadableWritablePair<Uint8Array<ArrayBuffer>, Uint8Array<ArrayBuffer>>)).getReader();
  const pieces: Uint8Array<ArrayBuffer>[] = [];
  let size = 0;
  for (let read = await reader.read(); !read.done; read = await reader.read()) {
    size += read.value.length;
    if (size > most) throw new Error("too long");
    pieces.push(read.value);
  }
  return new Uint8Array(await new Blob(pieces).arrayBuffer());
}

const base64 = (bytes: Uint8Array): string => btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
const bytesOf = (text: string): Uint8Array<ArrayBuffer> => Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0));
