// Rows of buttons and boxes to tick.
import { css } from './colours.js';

/** Buttons of which one is chosen; arrow keys go along. Returns what brings it up to date. */
export function choice(row, options, current, choose) {
  const buttons = options.map(([value, text]) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = text;
    button.dataset.value = value;
    button.setAttribute('role', 'radio');
    button.addEventListener('click', () => choose(value));
    row.append(button);
    return button;
  });
  row.addEventListener('keydown', (event) => {
    const move = { ArrowLeft: -1, ArrowUp: -1, ArrowRight: 1, ArrowDown: 1 }[event.key];
    if (!move) return;
    event.preventDefault();
    event.stopPropagation();
    const at = buttons.indexOf(document.activeElement);
    const next = buttons[(at + move + buttons.length) % buttons.length];
    next.focus();
    next.click();
  });
  return () => {
    const chosen = buttons.find((button) => button.dataset.value === current());
    for (const button of buttons) {
      button.setAttribute('aria-checked', button === chosen);
      button.tabIndex = button === (chosen ?? buttons[0]) ? 0 : -1;
    }
  };
}

/** A box to tick, with a dot of a colour if one is given. */
export function tick(parent, text, on, change, colour) {
  const line = document.createElement('label');
  const box = document.createElement('input');
  box.type = 'checkbox';
  box.checked = on;
  box.addEventListener('change', () => change(box.checked));
  line.append(box);
  if (colour) {
    const dot = document.createElement('i');
    dot.style.background = css(colour.map((x) => Math.round(255 * x)));
    line.append(dot);
  }
  const words = document.createElement('span');
  words.textContent = text;
  words.title = text;
  line.append(words);
  parent.append(line);
  return box;
}
