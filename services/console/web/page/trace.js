// One quantity of the archive against time. Measurements have no event of their own: the newest span is asked for
// again and again, decimated by the service.
import { crosses, dots } from './chart.js';
import { isLeftOut, whatBecameOf } from './held.js';
import { PointPanel } from './point_panel.js';
import { clock } from './text.js';

const points = 800;

export async function json(path) {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`the service answered ${answer.status}`);
  return answer.json();
}

// `to` and `from` are beyond the integers of a double, which is off by no more than 256 ns here.
export function seriesOf(spacecraft, quantity, from, to, most = points) {
  const query = new URLSearchParams({ spacecraft, quantity, from: BigInt(Math.floor(from)), to: BigInt(Math.ceil(to)), points: most });
  return json(`/api/v1/series?${query}`);
}

export class Trace extends PointPanel {
  constructor(box, note, spacecraft, { name, unit }) {
    super(box, note, 'series', [dots('accepted', '#7cb9f2'), crosses('left out', '#ff8a75')], unit);
    Object.assign(this, { spacecraft, quantity: name });
  }

  async pointsBetween(from, to) {
    return (await seriesOf(this.spacecraft, this.quantity, from, to)).points;
  }

  columns() {
    const leftOut = this.rows.filter(isLeftOut).length;
    this.summary = this.rows.length ? `last 30 min, ${this.rows.length} points, ${leftOut} left out` : 'no points yet';
    return [this.rows.map(row => isLeftOut(row) ? null : row.value), this.rows.map(row => isLeftOut(row) ? row.value : null)];
  }

  say(row) {
    this.told = row && isLeftOut(row) ? row : undefined;
    this.note.textContent = this.told ? `${clock(row.utc_s)} ${whatBecameOf(row)}` : this.summary ?? '';
  }
}
