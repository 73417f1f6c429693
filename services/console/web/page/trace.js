// One quantity of the archive against time. Measurements have no event of their own: the newest span is asked for
// again and again, decimated by the service.
import { Chart, crosses, dots } from './chart.js';
import { isLeftOut, nextLeftOut, whatBecameOf } from './held.js';
import { clock } from './text.js';

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
    Object.assign(this, { box, note, spacecraft, quantity: name, rows: [] });
    this.chart = new Chart(box, [dots('accepted', '#7cb9f2'), crosses('left out', '#ff8a75')], { unit });
    box.tabIndex = 0;
    box.addEventListener('pointermove', this.hovered = () => this.say(this.rows[this.chart.plot.cursor.idx]));
    box.addEventListener('keydown', this.walked = event => this.walk(event));
  }

  destroy() {
    this.box.removeEventListener('pointermove', this.hovered);
    this.box.removeEventListener('keydown', this.walked);
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
      this.rows = answer.points.map(point => ({ ...point, utc_s: utcOf(point.t_tai_ns) }));
      this.chart.draw([
        this.rows.map(row => row.utc_s),
        this.rows.map(row => isLeftOut(row) ? null : row.value),
        this.rows.map(row => isLeftOut(row) ? row.value : null),
      ]);
      const leftOut = this.rows.filter(isLeftOut).length;
      this.summary = this.rows.length ? `last 30 min, ${this.rows.length} points, ${leftOut} left out` : 'no points yet';
      if (!this.told) this.say();
    } catch (error) {
      this.note.textContent = `no series: ${error.message}`;
    } finally {
      this.busy = false;
    }
  }

  walk(event) {
    const row = nextLeftOut(event, this.rows, this.told);
    if (row) this.say(row);
  }

  say(row) {
    this.told = row && isLeftOut(row) ? row : undefined;
    this.note.textContent = this.told ? `${clock(row.utc_s)} ${whatBecameOf(row)}` : this.summary ?? '';
  }
}
