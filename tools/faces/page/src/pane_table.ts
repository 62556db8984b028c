// The panes, in the order of the tabs in a narrow window. Tabs, keys and the help read this table.

export const kPanes = [
  { pane: 'report', name: 'Report', tab: 'Report', title: 'Report, of a page that is one', key: '6', aside: true },
  { pane: 'program', name: 'Program status', tab: 'Program', key: '1', aside: false, keys_to: '#pane-program .listing' },
  { pane: 'chart', name: 'Status chart', tab: 'Chart', key: '2', aside: true },
  { pane: 'line', name: 'Line', tab: 'Line', key: '3', aside: true },
  { pane: 'causes', name: 'Why', tab: 'Why', key: '4', aside: true },
  { pane: 'timeline', name: 'Timeline', tab: 'Timeline', key: '5', aside: false, keys_to: '#timeline' },
] as const;

type Row = (typeof kPanes)[number];
export type PaneName = Row['pane'];
/** One of those that share the right side. */
export type SideName = Extract<Row, { aside: true }>['pane'];

export function side_of(pane: PaneName): SideName | undefined {
  return kPanes.find((one): one is Extract<Row, { aside: true }> => one.aside && one.pane === pane)?.pane;
}

/** What takes arrow keys in a pane. */
export function keys_to(pane: PaneName): string {
  const row = kPanes.find((one) => one.pane === pane)!;
  return 'keys_to' in row ? row.keys_to : `#pane-${pane}`;
}
