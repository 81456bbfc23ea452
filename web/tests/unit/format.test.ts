import { expect, test } from "vitest";
import { bytes, fixed, niceStep, parseNumber, percent, trimmed, um } from "../../src/format";

test("deviations keep the digits that mean something", () => {
  expect(um(158.8315)).toBe("159");
  expect(um(62.949)).toBe("62.9");
  expect(um(0.04)).toBe("0.0");
  expect(um(99.96)).toBe("100");
  expect(um(-72.53)).toBe("−72.5");
  expect(um(null)).toBe("–");
});

test("a rounded zero has no sign", () => {
  expect(fixed(-0.0001, 2)).toBe("0.00");
  expect(fixed(Number.NaN, 1)).toBe("–");
});

test("long numbers are grouped, short ones are not", () => {
  expect(fixed(4848000, 0)).toBe("4\u202f848\u202f000");
  expect(fixed(1234.5, 1)).toBe("1234.5");
});

test("trailing zeros go", () => {
  expect(trimmed(50, 1)).toBe("50");
  expect(trimmed(12.5, 1)).toBe("12.5");
  expect(trimmed(100, 0)).toBe("100");
});

test("small and large shares are not rounded to none and all", () => {
  expect(percent(0)).toBe("0\u202f%");
  expect(percent(0.001)).toBe("< 1\u202f%");
  expect(percent(0.999)).toBe("> 99\u202f%");
  expect(percent(1)).toBe("100\u202f%");
  expect(percent(0.6604)).toBe("66\u202f%");
});

test("numbers as people type them", () => {
  expect(parseNumber("12,5")).toBe(12.5);
  expect(parseNumber(" −3 ")).toBe(-3);
  expect(parseNumber("1e3")).toBe(1000);
  for (const wrong of ["", "-", "1.2.3", "12mm", "NaN", "Infinity", "1e999", "0x10"]) expect(parseNumber(wrong), wrong).toBeNull();
});

test("steps are 1, 2 or 5", () => {
  expect(niceStep(1500, 10)).toBe(200);
  expect(niceStep(0, 10)).toBe(1);
});

test("bytes", () => {
  expect(bytes(999)).toBe("999 B");
  expect(bytes(4899)).toBe("4.9 kB");
  expect(bytes(812345)).toBe("812 kB");
});
