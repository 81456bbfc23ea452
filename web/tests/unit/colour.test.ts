import { expect, test } from "vitest";
import { along, viridis } from "../../src/scene/colour";

/** Relative luminance of WCAG 2. */
const luminance = (rgb: number[]) => {
  const [r, g, b] = rgb.map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)) as [number, number, number];
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};

test("the ends are those of the published map", () => {
  expect(viridis(0).map((c) => Math.round(c * 255))).toEqual([68, 1, 84]);
  expect(viridis(1).map((c) => Math.round(c * 255))).toEqual([253, 231, 37]);
  expect(viridis(-3)).toEqual(viridis(0));
  expect(viridis(7)).toEqual(viridis(1));
});

test("larger is lighter everywhere, so that it reads in grey", () => {
  for (let i = 1; i <= 200; i++) expect(luminance(viridis(i / 200))).toBeGreaterThan(luminance(viridis((i - 1) / 200)));
});

test("a value is between the ends of its scale", () => {
  const scale = [100, 110, 120, 130, 140, 150, 160];
  expect(along(scale, 130)).toBeCloseTo(0.5, 12);
  expect([along(scale, 100), along(scale, 160)]).toEqual([0, 1]);
});
