// The page as a function of its state: panes return elements as plain data, and render() makes the document so, changing only what
// differs. Texts become text nodes, so whatever a program's files hold is text, never markup.

type Handler = (event: any) => void;
type Value = string | number | boolean | Handler | undefined | null;

export interface Attributes {
  /** Which of its siblings it is; rows that move keep their elements. */
  key?: string | number;
  /** Called with the element each time it has been rendered. */
  ref?: (element: any) => void;
  /** Styles by name, custom properties among them. */
  style?: Record<string, string>;
  [name: string]: Value | Record<string, string> | ((element: any) => void);
}

export interface Part {
  tag: string;
  attributes: Attributes;
  children: (Part | string)[];
}

export type Child = Part | string | number | null | undefined | false | Child[];

export function h(tag: string, attributes: Attributes = {}, ...children: Child[]): Part {
  const flat: (Part | string)[] = [];
  const add = (child: Child): void => {
    if (Array.isArray(child)) child.forEach(add);
    else if (typeof child === 'object' && child !== null) flat.push(child);
    else if (child !== null && child !== undefined && child !== false) flat.push(String(child));
  };
  children.forEach(add);
  return { tag, attributes, children: flat };
}

/** What is made anew only when what it is made of is another one: a part, say, that may be large. */
export function kept<Of, Made>(make: (of: Of) => Made): (of: Of) => Made {
  let last: { of: Of; made: Made } | undefined;
  return (of) => {
    if (last?.of !== of) last = { of, made: make(of) };
    return last.made;
  };
}

/** Whether a key presses the element that has the focus. */
export function is_press(event: KeyboardEvent): boolean {
  if (event.key !== 'Enter' && event.key !== ' ') return false;
  event.preventDefault();
  return true;
}

/** Characters that turn the direction of the text beside them: a name with one of them could make the page read otherwise. */
const kTurning = /[\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]/g;
export function without_turns(text: string): string {
  return text.replace(kTurning, '\ufffd');
}

/** Refs wait until the whole page is rendered, so that sizes can be measured. */
let referred: (() => void)[] = [];

interface Known {
  was?: Part;
}

const kSvg = 'http://www.w3.org/2000/svg';
/** Set as properties: attributes of these names are only how a control begins. What is being typed stays as it is. */
const kProperties = new Set(['value', 'checked', 'selected', 'disabled', 'indeterminate', 'scrollTop']);

function set_attribute(node: Element, name: string, value: unknown, before: unknown): void {
  if (name === 'key' || name === 'ref') return;
  if (name === 'style') {
    const styles = (value ?? {}) as Record<string, string>;
    const style = (node as HTMLElement).style;
    for (const old of Object.keys((before ?? {}) as object)) if (!(old in styles)) style.removeProperty(old);
    for (const [key, text] of Object.entries(styles)) style.setProperty(key, text);
  } else if (name.startsWith('on')) {
    (node as unknown as Record<string, unknown>)[name] = value ?? null;
  } else if (kProperties.has(name)) {
    const target = node as unknown as Record<string, unknown>;
    if (target[name] !== value) target[name] = value ?? (name === 'value' ? '' : false);
  } else if (value === undefined || value === null || value === false) {
    node.removeAttribute(name);
  } else {
    node.setAttribute(name, value === true ? '' : without_turns(String(value)));
  }
}

function create(made: Part | string, inside_svg: boolean): Node {
  if (typeof made === 'string') return document.createTextNode(without_turns(made));
  const svg = inside_svg || made.tag === 'svg';
  const node = svg ? document.createElementNS(kSvg, made.tag) : document.createElement(made.tag);
  update(node, { tag: made.tag, attributes: {}, children: [] }, made);
  return node;
}

function update(node: Element, before: Part, now: Part): void {
  const { attributes: old } = before;
  for (const name of Object.keys(old)) if (!(name in now.attributes)) set_attribute(node, name, undefined, old[name]);
  update_children(node, now.children);
  const typing = node === document.activeElement;
  for (const [name, value] of Object.entries(now.attributes))
    if (value !== old[name] || (kProperties.has(name) && !typing)) set_attribute(node, name, value, old[name]);
  (node as Known).was = now;
  if (now.attributes.ref) referred.push(() => now.attributes.ref!(node));
}

const key_of = (node: Node): string | number | undefined => (node as Known).was?.attributes.key;

/** Whether a node can become that element by changing it. */
function fits(node: Node | null, wanted: Part | string): boolean {
  if (!node) return false;
  if (typeof wanted === 'string') return node.nodeType === Node.TEXT_NODE;
  const was = (node as Known).was;
  return was !== undefined && was.tag === wanted.tag && was.attributes.key === wanted.attributes.key;
}

function update_children(parent: Element, wanted: (Part | string)[]): void {
  const kept = new Set(wanted.map((child) => (typeof child === 'string' ? undefined : child.attributes.key)));
  const keyed = new Map<string | number, Node>();
  for (const node of Array.from(parent.childNodes)) {
    const key = key_of(node);
    if (key === undefined) continue;
    if (kept.has(key)) keyed.set(key, node);
    else parent.removeChild(node);
  }
  const svg = parent.namespaceURI === kSvg;
  let next: Node | null = parent.firstChild;
  for (const child of wanted) {
    const key = typeof child === 'string' ? undefined : child.attributes.key;
    let node = key === undefined ? next : keyed.get(key) ?? null;
    if (!fits(node, child)) node = null;
    if (!node) {
      node = create(child, svg);
      parent.insertBefore(node, next);
      continue;
    }
    if (node === next) next = next.nextSibling;
    else parent.insertBefore(node, next);
    if (typeof child === 'string') {
      const text = without_turns(child);
      if (node.nodeValue !== text) node.nodeValue = text;
    } else if ((node as Known).was !== child) {
      update(node as Element, (node as Known).was!, child);
    }
  }
  while (next) {
    const gone: Node = next;
    next = next.nextSibling;
    parent.removeChild(gone);
  }
}

export function render(root: Element, ...children: Child[]): void {
  update_children(root, h('', {}, ...children).children);
  const all = referred;
  referred = [];
  all.forEach((one) => one());
}
