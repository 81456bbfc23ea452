// Comparison with a pinned state.

import { expect, test } from "vitest";
import { difference, isWithinUncertainty, significant } from "../../src/changes/pin";

test("the difference is relative to the pinned state", () => {
  expect(difference(59, 100)).toBe("41\u202f% less than pinned");
  expect(difference(150, 100)).toBe("50\u202f% more than pinned");
  expect(difference(100.2, 100)).toBe("the same as pinned");
  expect([difference(null, 100), difference(100, null), difference(100, 0)]).toEqual([null, null, null]);
});

test("a difference within the uncertainty of the two is not reported", () => {
  const of = (worst_um: number | null, worst_u_um: number | null) => ({ worst_um, worst_u_um });
  expect(isWithinUncertainty(of(95, 4), of(100, 3))).toBe(true);
  expect(significant(of(95, 4), of(100, 3))).toBeNull();
  expect(significant(of(59, 4), of(100, 3))).toBe("41\u202f% less than pinned");
  // Where an uncertainty is not known, nothing is said of it.
  expect(significant(of(95, null), of(100, 3))).toBe("5\u202f% less than pinned");
  expect(significant(of(null, null), of(100, 3))).toBeNull();
});
