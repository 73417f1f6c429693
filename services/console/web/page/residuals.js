// What each channel, or sensor, says to the filter: its whitened residuals against time, whose standard deviation is 1 when
// all is well, with the share that is used and the noise factor of each.
import { Chart, crosses, dots, line } from './chart.js';
import { nextLeftOut, whatBecameOf } from './held.js';
import { seriesOf } from './trace.js';
import { clock, number } from './text.js';

const span_ns = 1800e9;
const points = 300;  // of a source
const bounds = [-3, 3];
const sources = {
  spin: { sun1: '#f2b134', sun2: '#ffd98a', north_in: '#7cb9f2', north_out: '#b4d7f7', south_in: '#6fd08c', south_out: '#b0e8c0' },
  three_axis: { star: '#7cb9f2', sun: '#f2b134', magnetometer: '#6fd08c' },
};

export class Residuals {
  constructor(box, note, spacecraft, kind) {
    Object.assign(this, { box, note, spacecraft, rows: [], names: Object.keys(sources[kind]) });
    this.chart = new Chart(box, [...Object.entries(sources[kind]).map(([name, colour]) => dots(name, colour)),
      crosses('left out', '#ff8a75'), ...bounds.map(bound => line(`${bound}`, '#a4b0b9', [6, 4]))], { unit: 'sigma' });
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
      const series = await Promise.all(this.names.map(async name => {
        const answer = await seriesOf(this.spacecraft, `residual_${name}`, t_tai_ns - span_ns, t_tai_ns, points);
        return answer.points.map(point => ({ ...point, name, utc_s: utcOf(point.t_tai_ns) }));
      }));
      if (!this.chart) return;
      this.asked = t_tai_ns;
      this.rows = series.flat().sort((a, b) => a.utc_s - b.utc_s);
      this.chart.draw([
        this.rows.map(row => row.utc_s),
        ...this.names.map(name => this.rows.map(row => row.name === name && row.accepted ? row.value : null)),
        this.rows.map(row => row.accepted ? null : row.value),
        ...bounds.map(bound => this.rows.map(() => bound)),
      ]);
    } catch (error) {
      this.note.textContent = `no residuals: ${error.message}`;
    } finally {
      this.busy = false;
    }
  }

  // `known`: of each source the share used and the noise factor, by the service's ledger.
  summarise(known = {}) {
    this.summary = this.names.filter(name => known[name])
      .map(name => `${name} ${number(100 * known[name].used, 0, ' %')} × ${number(known[name].noise, 2)}`).join(', ');
    if (!this.told) this.say();
  }

  walk(event) {
    const row = nextLeftOut(event, this.rows, this.told);
    if (row) this.say(row);
  }

  say(row) {
    this.told = row;
    this.note.textContent = row ? `${row.name} ${clock(row.utc_s)} ${whatBecameOf(row, 'used')}` : this.overall();
  }

  // Of a run from before the service there is no summary.
  overall() {
    return this.summary ? `used × noise: ${this.summary}` : this.rows.length ? `${this.rows.length} of the last 30 min` : 'no residuals yet';
  }
}
