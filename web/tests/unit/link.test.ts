// Links to a state.

import { expect, test } from "vitest";
import { linkOf, stateOf } from "../../src/changes/link";

test("a state survives a link, without a token in it", async () => {
  const state = { text: `# Größe µm\n${"tolerance_um = 50\n".repeat(500)}`, analysis: "Fig. 6", tab: "live" };
  const link = (await linkOf(state))!;
  expect(link).toMatch(/^#live&state=[\w-]+$/);
  expect(link.length).toBeLessThan(400);
  expect(await stateOf(link)).toEqual(state);
  expect(await stateOf((await linkOf({ ...state, analysis: null }))!)).toMatchObject({ analysis: null });
});

test("damaged, foreign and too long links are none", async () => {
  const link = (await linkOf({ text: "x", analysis: null, tab: "live" }))!;
  for (const hash of ["", "#live", "#live&state=", "#live&state=AAAA", link.slice(0, -2), link + "!", "#live&token=1&state=x"]) expect(await stateOf(hash)).toBeNull();
  const random = Array.from({ length: 200_000 }, (_, k) => String.fromCharCode(33 + ((k * 7919 + ((k * k) % 101) * 31) % 90))).join("");
  expect((await linkOf({ text: random, analysis: null, tab: "live" }))?.length ?? 0).toBeLessThan(60_100);
  // Unpacks to more than any study.
  const large = (await linkOf({ text: " ".repeat(6_000_000), analysis: null, tab: "live" }))!;
  expect(await stateOf(large)).toBeNull();
});
