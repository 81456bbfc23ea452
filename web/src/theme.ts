// Light or dark: the setting of the system, until the user selects one.

const KEY = "armill-theme";
const dark = matchMedia("(prefers-color-scheme: dark)");

export type Theme = "light" | "dark";
export const theme = (): Theme => {
  const chosen = localStorage.getItem(KEY);
  return chosen === "light" || chosen === "dark" ? chosen : dark.matches ? "dark" : "light";
};

export function startTheme(changed: () => void): void {
  const apply = () => {
    document.documentElement.dataset.theme = theme();
    changed();
  };
  dark.addEventListener("change", apply);
  apply();
}

export function switchTheme(changed: () => void): void {
  localStorage.setItem(KEY, theme() === "dark" ? "light" : "dark");
  document.documentElement.dataset.theme = theme();
  changed();
}
