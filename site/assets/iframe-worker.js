// Search on pages opened from a disk, where browsers start no workers: the script of the worker runs in a hidden frame.
if (location.protocol === "file:") {
  const folder = new URL(".", document.currentScript.src);
  globalThis.Worker = class extends EventTarget {
    constructor(script) {
      super();
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      this.frame.src = `${new URL("iframe-worker.html", folder)}?${encodeURIComponent(new URL(script, location.href))}`;
      this.waiting = [];
      addEventListener("message", ({ source, data }) => {
        if (source !== this.frame.contentWindow) return;
        if (data === "ready") {
          for (const message of this.waiting) source.postMessage(message, "*");
          this.waiting = null;
        } else this.dispatchEvent(new MessageEvent("message", { data }));
      });
      document.body.append(this.frame);
    }
    postMessage(message) {
      if (this.waiting) this.waiting.push(message);
      else this.frame.contentWindow.postMessage(message, "*");
    }
    terminate() {
      this.frame.remove();
    }
  };
}
