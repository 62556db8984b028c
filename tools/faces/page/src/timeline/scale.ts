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

/** 1, 2 or 5 times a power of ten, so that marks are at least that many pixels apart. */
export function step_of(scale: Scale, pixels: number): number {
  const least = (scale.to_ns - scale.from_ns) / (scale.right - scale.left) * pixels;
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
