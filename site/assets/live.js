// Live pages in folded blocks are loaded when the block is opened; browsers load lazy frames of a page from a disk at once.
for (const details of document.querySelectorAll("details.example")) {
  const load = () => {
    for (const frame of details.querySelectorAll("iframe[data-src]")) {
      frame.src = frame.dataset.src;
      delete frame.dataset.src;
    }
  };
  if (details.open) load();
  details.addEventListener("toggle", load);
}
