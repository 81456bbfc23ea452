// Comparison with a pinned state.

import { expect, test } from "vitest";
import { difference } from "../../src/changes/pin";

test("the difference is relative to the pinned state", () => {
  expect(difference(59, 100)).toBe("41\u202f% less than pinned");
  expect(difference(150, 100)).toBe("50\u202f% more than pinned");
  expect(difference(100.2, 100)).toBe("the same as pinned");
  expect([difference(null, 100), difference(100, null), difference(100, 0)]).toEqual([null, null, null]);
});
