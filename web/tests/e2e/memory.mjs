// Memory of the page after a collection of all that is not used any more.

/** Heap and buffers of numbers, MB. */
export async function heapAfterGc(page) {
  const session = await page.context().newCDPSession(page);
  await session.send("HeapProfiler.enable");
  // Objects with finalisers need more than one.
  for (let i = 0; i < 3; i++) await session.send("HeapProfiler.collectGarbage");
  const { usedSize, backingStorageSize = 0 } = await session.send("Runtime.getHeapUsage");
  await session.detach();
  return (usedSize + backingStorageSize) / 1e6;
}
