// What each channel, or sensor, says to the filter: its whitened residuals against time, whose standard deviation is 1 when
// all is well, with the share that is used and the noise factor of each.
import { crosses, dots, line } from './chart.js';
import { whatBecameOf } from './held.js';
import { PointPanel } from './point_panel.js';
import { seriesOf } from './trace.js';
import { clock, number } from './text.js';

const points = 300;  // of a source
const bounds = [-3, 3];
const sources = {
  spin: { sun1: '#f2b134', sun2: '#ffd98a', north_in: '#7cb9f2', north_out: '#b4d7f7', south_in: '#6fd08c', south_out: '#b0e8c0' },
  three_axis: { star: '#7cb9f2', sun: '#f2b134', magnetometer: '#6fd08c' },
};

export class Residuals extends PointPanel {
  constructor(box, note, spacecraft, kind) {
    super(box, note, 'residuals', [...Object.entries(sources[kind]).map(([name, colour]) => dots(name, colour)),
      crosses('left out', '#ff8a75'), ...bounds.map(bound => line(`${bound}`, '#a4b0b9', [6, 4]))], 'sigma');
    Object.assign(this, { spacecraft, names: Object.keys(sources[kind]) });
  }

  async pointsBetween(from, to) {
    const series = await Promise.all(this.names.map(async name =>
      (await seriesOf(this.spacecraft, `residual_${name}`, from, to, points)).points.map(point => ({ ...point, name }))));
    return series.flat();
  }

  columns() {
    return [
      ...this.names.map(name => this.rows.map(row => row.name === name && row.accepted ? row.value : null)),
      this.rows.map(row => row.accepted ? null : row.value),
      ...bounds.map(bound => this.rows.map(() => bound)),
    ];
  }

  // `known`: of each source the share used and the noise factor, by the service's ledger.
  summarise(known = {}) {
    this.summary = this.names.filter(name => known[name])
      .map(name => `${name} ${number(100 * known[name].used, 0, ' %')} × ${number(known[name].noise, 2)}`).join(', ');
    if (!this.told) this.say();
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
