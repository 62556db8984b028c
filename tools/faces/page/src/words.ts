// Times and numbers as people read and type them.

const kMs = 1e6;
const kSecond = 1e9;

function fraction(value: number, digits: number): string {
  return value.toFixed(digits);
}

export const kInSeconds = 100 * kSecond, kAsClock = 3600 * kSecond;  // from where on moments are written so

/** `102.605583 ms`, from 100 s on `123.456789 s`, from an hour on `1:30:00.000125`: down to the nanosecond or microsecond. */
export function moment_text(ns: number, decimals_of_ms = 6): string {
  if (ns >= kAsClock) return clock_text(ns, 6);
  return ns < kInSeconds ? `${fraction(ns / kMs, decimals_of_ms)} ms` : `${fraction(ns / kSecond, 6)} s`;
}

/** What the session says, with times as the page writes them: its moments are in ms, however long, and its microseconds in us. */
export function with_times(text: string): string {
  return text.replace(/\b(\d+\.\d{3}(?:\d{3})?) ms\b/g, (all, ms) => (Number(ms) * kMs < kInSeconds ? all : moment_text(Number(ms) * kMs)))
    .replace(/\b(\d+(?:\.\d+)?) us\b/g, '$1 µs').replace(", to which 'back' returns", '').replace(/^answer +none within/, 'no answer within');
}

/** A moment as a command takes it, without rounding. */
export function moment_word(ns: number): string {
  return `${Math.round(ns)}ns`;
}

/** `1.234 ms`, in the unit that fits: down to the microsecond, as the session's answers have it. */
export function duration_text(ns: number): string {
  const size = Math.abs(ns);
  const [unit, name] = size < 1e3 ? [1, 'ns'] : size < 1e6 ? [1e3, 'µs'] : size < kSecond ? [kMs, 'ms']
    : size < 60 * kSecond ? [kSecond, 's'] : size < 3600 * kSecond ? [60 * kSecond, 'min'] : [3600 * kSecond, 'h'];
  return `${trimmed(ns / unit, unit === kMs ? 3 : undefined)} ${name}`;
}

function trimmed(value: number, decimals?: number): string {
  const text = decimals === undefined ? value.toPrecision(6) : value.toFixed(decimals);
  return text.includes('.') && !text.includes('e') ? text.replace(/\.?0+$/, '') : String(Number(text));
}

const kUnits: Record<string, number> = { ns: 1, us: 1e3, µs: 1e3, ms: kMs, s: kSecond, min: 60 * kSecond, h: 3600 * kSecond };

/** `13:30`, with seconds `0:01:30`, with that many decimals of them: hours, minutes. */
export function clock_text(ns: number, decimals: number | 'minutes'): string {
  const digits = decimals === 'minutes' ? 0 : decimals, unit = 10 ** digits;
  const parts = Math.round(ns / kSecond * unit), seconds = Math.floor(parts / unit), two = (part: number): string => String(part % 60).padStart(2, '0');
  const rest = digits === 0 ? '' : `.${String(parts % unit).padStart(digits, '0')}`;
  return `${Math.floor(seconds / 3600)}:${two(Math.floor(seconds / 60))}${decimals === 'minutes' ? '' : `:${two(seconds)}${rest}`}`;
}

/** The nanoseconds of `15.193ms`, `2 s`, `1h`, and of `13:30` or `13:30:15.5`, as the ruler counts; undefined if it is not a time. */
export function moment_from(text: string): number | undefined {
  const clock = /^\s*(\d+):([0-5]\d)(?::([0-5]\d(?:[.,]\d+)?))?\s*$/.exec(text);
  if (clock) return Math.round((Number(clock[1]) * 3600 + Number(clock[2]) * 60) * kSecond + Number((clock[3] ?? '0').replace(',', '.')) * kSecond);
  const parts = /^\s*(\d+(?:[.,]\d+)?)\s*(ns|us|µs|ms|s|min|h)\s*$/i.exec(text);
  if (!parts) return undefined;
  return Math.round(Number(parts[1]!.replace(',', '.')) * kUnits[parts[2]!.toLowerCase()]!);
}

/** What is written for a moment in `#t=15.193ms`; undefined where there is none. */
export function written_in_link(hash: string): string | undefined {
  const written = /[#&]t=([^&]*)/.exec(hash)?.[1];
  try {
    return written === undefined ? undefined : decodeURIComponent(written);
  } catch {
    return written;  // such as `%` alone
  }
}

/** The moment of `#t=15.193ms`. */
export function moment_of_link(hash: string): number | undefined {
  return moment_from(written_in_link(hash) ?? '');
}

export function link_of(ns: number): string {
  const text = ns % kMs === 0 ? `${ns / kMs}ms` : ns % 1e3 === 0 ? `${(ns / kMs).toFixed(3)}ms` : `${(ns / kMs).toFixed(6)}ms`;
  return `#t=${text}`;
}
