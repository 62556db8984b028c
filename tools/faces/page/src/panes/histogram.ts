// How latencies are spread, from the shortest to the longest.
import { h, type Part } from '../dom';
import { duration_text } from '../words';

const kBars = 24, kWidth = 120, kHeight = 20;

export function histogram(latencies: number[]): Part | null {
  if (latencies.length < 2) return null;
  const least = latencies.reduce((a, b) => Math.min(a, b)), most = latencies.reduce((a, b) => Math.max(a, b));
  const width = (most - least) / kBars || 1;
  const counts = new Array<number>(kBars).fill(0);
  for (const one of latencies) counts[Math.min(kBars - 1, Math.floor((one - least) / width))]! += 1;
  const highest = Math.max(...counts), bar = kWidth / kBars;
  const path = counts.map((count, i) => `M${i * bar},${kHeight}v${-count / highest * kHeight}h${bar - 1}V${kHeight}z`).join('');
  return h('svg', { class: 'histogram', viewBox: `0 0 ${kWidth} ${kHeight}`, role: 'img', 'aria-label': `Spread of the latencies from ${duration_text(least)} to ${duration_text(most)}` }, h('path', { d: path }));
}
