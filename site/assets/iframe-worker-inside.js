// Inside of the hidden frame: what the script of the worker posts goes to the page; see iframe-worker.js. Only scripts of this
// site are run.
{
  const page = parent;
  globalThis.parent = {}; // The script reads it, which browsers forbid in a frame from a disk.
  globalThis.postMessage = (message) => page.postMessage(message, "*");
  const address = new URL(decodeURIComponent(location.search.slice(1)));
  const script = document.createElement("script");
  script.src = new URL(`javascripts/workers/${address.pathname.split("/").at(-1)}`, location.href);
  script.onload = () => page.postMessage("ready", "*");
  document.head.append(script);
}
