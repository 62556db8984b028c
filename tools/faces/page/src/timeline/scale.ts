// Time on the horizontal axis.

export interface Scale {
  from_ns: number;
  to_ns: number;
  left: number;   // pixels
  right: number;
}

export function x_of(scale: Scale, ns: number): number {
  return scale.left + (ns - scale.from_ns) / (scale.to_ns - scale.from_ns) * (scale.right - scale.left);
}

export function ns_at(scale: Scale, x: number): number {
  return scale.from_ns + (x - scale.left) / (scale.right - scale.left) * (scale.to_ns - scale.from_ns);
}

const kSecond = 1e9, kDay = 86400 * kSecond;
const kClockSteps = [15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10800, 21600, 43200].map((seconds) => seconds * kSecond);

/** A step so that marks are at least that many pixels apart: 1, 2 or 5 times a power of ten of nanoseconds, or what clocks have. */
export function step_of(scale: Scale, pixels: number): number {
  const least = (scale.to_ns - scale.from_ns) / (scale.right - scale.left) * pixels;
  if (least <= 10 * kSecond) return decimal_step(least);
  return kClockSteps.find((step) => step >= least) ?? decimal_step(least / kDay) * kDay;
}

function decimal_step(least: number): number {
  const power = 10 ** Math.floor(Math.log10(Math.max(1, least)));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= least)!;
}

/** The first of the elements, which are in the order of time, that ends after `ns`. */
export function first_after<T extends { end_ns: number }>(all: T[], ns: number): number {
  let low = 0, high = all.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (all[middle]!.end_ns <= ns) low = middle + 1;
    else high = middle;
  }
  return low;
}
