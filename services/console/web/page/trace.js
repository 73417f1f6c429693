// One quantity of the archive against time. Measurements have no event of their own: the newest span is asked for
// again and again, decimated by the service.
import { Chart, crosses, dots } from './chart.js';
import { heldAgainst } from './held.js';

const span_ns = 1800e9;
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

export class Trace {
  constructor(box, note, spacecraft, { name, unit }) {
    Object.assign(this, { note, spacecraft, quantity: name, rows: [] });
    this.chart = new Chart(box, [dots('accepted', '#7cb9f2'), crosses('rejected', '#ff8a75')], { unit });
    box.addEventListener('pointermove', this.hovered = () => this.say());
  }

  destroy() {
    this.chart.box.removeEventListener('pointermove', this.hovered);
    this.chart.destroy();
    this.chart = null;
  }

  // The span that ends at `t_tai_ns`.
  async refresh(t_tai_ns, utcOf) {
    if (this.busy || !t_tai_ns || this.asked === t_tai_ns) return;
    this.busy = true;
    try {
      const answer = await seriesOf(this.spacecraft, this.quantity, t_tai_ns - span_ns, t_tai_ns);
      if (!this.chart) return;
      this.asked = t_tai_ns;
      this.rows = answer.points;
      this.chart.draw([
        this.rows.map(row => utcOf(row.t_tai_ns)),
        this.rows.map(row => row.accepted === false ? null : row.value),
        this.rows.map(row => row.accepted === false ? row.value : null),
      ]);
      const rejected = this.rows.filter(row => row.accepted === false).length;
      this.summary = this.rows.length ? `last 30 min, ${this.rows.length} points, ${rejected} rejected` : 'no points yet';
      this.say();
    } catch (error) {
      this.note.textContent = `no series: ${error.message}`;
    } finally {
      this.busy = false;
    }
  }

  say() {
    const row = this.rows[this.chart.plot.cursor.idx];
    this.note.textContent = row?.accepted === false ? `rejected: ${row.rejected_by ?? 'no reason given'}${heldAgainst(row)}` : this.summary ?? '';
  }
}
