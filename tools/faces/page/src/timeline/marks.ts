// Marks of the reader's own on the timeline, kept with the page for each program.
import { remember, remembered } from '../kept';
import { changed, state } from '../state';

const kMost = 99;

function kept_as(): string {
  return `marks.${state.hello?.program ?? ''}`;
}

export function load_marks(): void {
  try {
    const all: unknown = JSON.parse(remembered(kept_as()) ?? '[]');
    state.marks = Array.isArray(all) ? all.filter((one): one is number => Number.isFinite(one) && one >= 0).slice(0, kMost) : [];
  } catch {
    state.marks = [];
  }
}

/** Sets a mark at the present moment, or takes away the one that is there. */
export function toggle_mark(): void {
  const now = state.past?.now_ns ?? 0;
  state.marks = state.marks.includes(now) ? state.marks.filter((one) => one !== now)
    : [...state.marks, now].sort((a, b) => a - b).slice(0, kMost);
  remember(kept_as(), JSON.stringify(state.marks));
  changed();
}

/** The mark before or after the present moment; nothing if there is none. */
export function next_mark(direction: 1 | -1): number | undefined {
  const now = state.past?.now_ns ?? 0;
  return direction > 0 ? state.marks.find((one) => one > now) : [...state.marks].reverse().find((one) => one < now);
}
