// Small pictures of 16 by 16, drawn in the colour of the text beside them.
import { h, type Part } from './dom';

const kPaths: Record<string, string> = {
  run: 'M4 2.5v11l9-5.5z',
  pause: 'M4 3h3v10H4zM9 3h3v10H9z',
  back: 'M11 3v10L4 8z',
  forward: 'M5 3v10l7-5z',
  start: 'M3 3h2v10H3zM13 3v10L6 8z',
  end: 'M11 3h2v10h-2zM3 3v10l7-5z',
  link: 'M6.5 9.5a2.5 2.5 0 0 1 0-3.5l2.5-2.5a2.5 2.5 0 0 1 3.5 3.5L11.3 8.2M9.5 6.5a2.5 2.5 0 0 1 0 3.5L7 12.5A2.5 2.5 0 0 1 3.500 9L4.7 7.8',
  theme: 'M8 2a6 6 0 1 0 0 12zM8 2a6 6 0 0 1 0 12',
  help: 'M5.5 6a2.5 2.5 0 1 1 3.6 2.2c-.8.4-1.1.8-1.1 1.8M8 12.6v.6',
  lock: 'M4 7h8v6.500H4zM5.500 7V5a2.500 2.500 0 0 1 5 0v2',
  close: 'M4 4l8 8M12 4l-8 8',
  plus: 'M8 3v10M3 8h10',
  minus: 'M3 8h10',
};
const kLines = new Set(['link', 'help', 'lock', 'close', 'plus', 'minus']);

export function icon(name: string): Part {
  const drawn = kLines.has(name) ? { fill: 'none', stroke: 'currentColor', 'stroke-width': 1.6, 'stroke-linecap': 'round' }
    : { fill: 'currentColor' };
  return h('svg', { class: 'icon', viewBox: '0 0 16 16', 'aria-hidden': 'true' }, h('path', { d: kPaths[name]!, ...drawn }));
}
