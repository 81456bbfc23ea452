// The program as WebAssembly: compressed in its own file, or as text in a script where the page is opened from a disk,
// from which browsers load nothing else.

declare global {
  // Set by `armill-program.js`.
  var armill_program: string | undefined;
}

const FILE = "armill.wasm.gz";
const SCRIPT = "armill-program.js";

export async function loadProgram(): Promise<WebAssembly.Module> {
  const compressed = location.protocol === "file:" ? await fromScript() : (await fetched()).body!;
  const wasm = compressed.pipeThrough(new DecompressionStream("gzip") as ReadableWritablePair<Uint8Array<ArrayBuffer>, Uint8Array<ArrayBuffer>>);
  return WebAssembly.compileStreaming(new Response(wasm, { headers: { "Content-Type": "application/wasm" } }));
}

async function fetched(): Promise<Response> {
  const response = await fetch(FILE);
  if (!response.ok) throw new Error(`${FILE} is missing next to this page (${response.status}).`);
  return response;
}

async function fromScript(): Promise<ReadableStream<Uint8Array<ArrayBuffer>>> {
  await new Promise<void>((done, fail) => {
    const script = document.createElement("script");
    script.src = SCRIPT;
    script.onload = () => done();
    script.onerror = () => fail(new Error(`${SCRIPT} is missing next to this page.`));
    document.head.append(script);
  });
  const text = atob(globalThis.armill_program!);
  globalThis.armill_program = undefined;
  const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  return new Blob([bytes]).stream() as ReadableStream<Uint8Array<ArrayBuffer>>;
}
