// Numbers as people read them: digits that mean something, a true minus sign, the unit after a space.

const MINUS = "\u2212";
export const DASH = "\u2013";
const THIN = "\u202f";

/** A number with so many decimals at most; a dash for what is not there. */
export function fixed(value: number | null | undefined, decimals: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return DASH;
  const text = Math.abs(value).toFixed(decimals);
  const zero = Number(text) === 0;
  return (value < 0 && !zero ? MINUS : "") + grouped(text);
}

/** Deviations: a tenth of a micrometre below 10, whole ones from 100. */
export function um(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return DASH;
  return fixed(value, Math.abs(value) < 99.95 ? 1 : 0);
}

/** Unit and standard uncertainty after a value: unknown is not zero. */
export function plusMinus(u: number | null | undefined): string {
  return u === null || u === undefined ? "µm ± not known" : `± ${um(u)} µm`;
}

export const mm = (value: number | null | undefined): string => trimmed(value, 1);
export const newton = (value: number | null | undefined): string => trimmed(value, 1);
export const percent = (share: number | null | undefined): string =>
  share === null || share === undefined ? DASH : `${share > 0 && share < 0.01 ? "< 1" : share < 1 && share > 0.99 ? "> 99" : fixed(100 * share, 0)}${THIN}%`;

/** As `fixed`, without zeros at the end. */
export function trimmed(value: number | null | undefined, decimals: number): string {
  const text = fixed(value, decimals);
  return text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

export function bytes(n: number): string {
  if (n < 1000) return `${n} B`;
  const [unit, size] = n < 1e6 ? ["kB", 1e3] : n < 1e9 ? ["MB", 1e6] : ["GB", 1e9];
  return `${trimmed(n / size, n / size < 10 ? 1 : 0)} ${unit}`;
}

export function ago(seconds: number): string {
  if (seconds < 60) return "just now";
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min ago`;
  if (seconds < 86400) return `${Math.floor(seconds / 3600)} h ago`;
  return `${Math.floor(seconds / 86400)} d ago`;
}

export function duration(seconds: number): string {
  if (seconds < 60) return `${fixed(seconds, seconds < 10 ? 1 : 0)} s`;
  return `${Math.floor(seconds / 60)} min ${Math.floor(seconds % 60)} s`;
}

/** Steps of 1, 2 or 5 times a power of ten, `count` of them or a few more over `span`. */
export function niceStep(span: number, count: number): number {
  if (!(span > 0)) return 1;
  const raw = span / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const times = raw / power;
  return power * (times <= 1 ? 1 : times <= 2 ? 2 : times <= 5 ? 5 : 10);
}

/** What a person may type: a comma for the point, a true minus. Null where it is not a number. */
export function parseNumber(text: string): number | null {
  const plain = text.trim().replace(MINUS, "-").replace(/[\s\u202f]/g, "").replace(",", ".");
  if (plain === "" || !/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(plain)) return null;
  const value = Number(plain);
  return Number.isFinite(value) ? value : null;
}

function grouped(text: string): string {
  const [whole = "", rest] = text.split(".");
  const parts = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, THIN) : whole;
  return rest === undefined ? parts : `${parts}.${rest}`;
}
