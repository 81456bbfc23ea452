// A tab of the page: its name, its element, and what happens when it is shown.

export interface Tab {
  id: string;
  title: string;
  root: HTMLElement;
  shown?: () => void;
  left?: () => void;
}
