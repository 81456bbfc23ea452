// A tab of the page: what it is called, its element, and what happens when it comes into view.

export interface Tab {
  id: string;
  title: string;
  root: HTMLElement;
  shown?: () => void;
  left?: () => void;
}
