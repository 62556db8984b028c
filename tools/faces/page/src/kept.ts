// What the page keeps from one visit to the next, where the browser allows it.

export function remember(name: string, value: string): void {
  try {
    localStorage.setItem(`s7200.${name}`, value);
  } catch { /* a page without storage forgets it */ }
}

export function remembered(name: string): string | null {
  try {
    return localStorage.getItem(`s7200.${name}`);
  } catch {
    return null;
  }
}
