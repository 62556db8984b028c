// The ladder of the networks in view.
import { h, type Part } from '../dom';

export function ladder_view(): Part {
  return h('p', { class: 'empty' }, 'Not drawn yet.');
}
