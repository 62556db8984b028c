// How numbers are spread, from the least to the most.
import { h, type Part } from '../dom';
import { duration_text } from '../words';

const kBars = 24, kWidth = 120, kHeight = 20;

export function histogram(numbers: number[], text = duration_text): Part | null {
  if (numbers.length < 2) return null;
  const least = numbers.reduce((a, b) => Math.min(a, b)), most = numbers.reduce((a, b) => Math.max(a, b));
  if (least === most) return null;
  const width = (most - least) / kBars;
  const counts = new Array<number>(kBars).fill(0);
  for (const one of numbers) counts[Math.min(kBars - 1, Math.floor((one - least) / width))]! += 1;
  const highest = Math.max(...counts), bar = kWidth / kBars;
  const path = counts.map((count, i) => `M${i * bar},${kHeight}v${-count / highest * kHeight}h${bar - 1}V${kHeight}z`).join('');
  return h('span', { class: 'spread' }, h('svg', { class: 'histogram', viewBox: `0 0 ${kWidth} ${kHeight}`, preserveAspectRatio: 'none', role: 'img', 'aria-label': `Spread from ${text(least)} to ${text(most)}` }, h('path', { d: path })),
    h('span', { class: 'ends', 'aria-hidden': 'true' }, h('span', {}, text(least)), h('span', {}, text(most))));
}
