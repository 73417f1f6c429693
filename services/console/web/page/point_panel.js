// A chart of points in the last half hour, and a line that says what became of the one that is pointed at, or that the
// arrow keys have reached.
import { Chart } from './chart.js';
import { nextLeftOut } from './held.js';

const span_ns = 1800e9;

// Who extends it gives `pointsBetween(from, to)`, `columns()` of the rows, in the order of `series`, and `say(row)`.
export class PointPanel {
  constructor(box, note, what, series, unit) {
    Object.assign(this, { box, note, what, rows: [], chart: new Chart(box, series, { unit }) });
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
      const points = await this.pointsBetween(t_tai_ns - span_ns, t_tai_ns);
      if (!this.chart) return;
      this.asked = t_tai_ns;
      this.rows = points.map(point => ({ ...point, utc_s: utcOf(point.t_tai_ns) })).sort((a, b) => a.utc_s - b.utc_s);
      this.chart.draw([this.rows.map(row => row.utc_s), ...this.columns()]);
      if (!this.told) this.say();
    } catch (error) {
      this.note.textContent = `no ${this.what}: ${error.message}`;
    } finally {
      this.busy = false;
    }
  }

  walk(event) {
    const row = nextLeftOut(event, this.rows, this.told);
    if (row) this.say(row);
  }
}
