// Sigma of each estimator against time, beside the Cramer-Rao bound of the batch where the archive has one.
import { Ring } from './ring.js';
import { Chart, line } from './chart.js';
import { seriesOf } from './trace.js';
import { byId, sigma } from './text.js';

const span_ns = 1800e9;
const points = 1000;
// Lines told apart by their dashes, too. Each has a quantity of its own for the past.
const lines = {
  mean: ['#f2b134', [2, 4]], sequential: ['#7cb9f2', [8, 4]], batch: ['#6fd08c', undefined], bound: ['#a4b0b9', [1, 3]],
  attitude: ['#7cb9f2', undefined],
};

export class Convergence {
  constructor(names) {
    this.names = names;
    this.newest = {};
    this.is_newer = true;  // Than what is written, which may be of another spacecraft.
    this.rings = Object.fromEntries(names.map(name => [name, new Ring(points)]));
    this.chart = new Chart(byId('sigma'), names.map(name => line(name, ...lines[name])), { unit: 'deg', logarithmic: true });
  }

  push(name, t_tai_ns, sigma_deg) {
    const ring = this.rings[name];
    if (!(t_tai_ns < this.newest[name]?.t_tai_ns) && sigma_deg > 0) {
      this.newest[name] = { t_tai_ns, sigma_deg };
      this.is_newer = true;
    }
    // What comes sooner than its share of the span would push the past out.
    if (!ring || !(sigma_deg > 0) || t_tai_ns - (ring.last?.[0] ?? -Infinity) < span_ns / points) return;
    ring.push([t_tai_ns, sigma_deg]);
    this.changed = true;
  }

  // What came before the page was opened, or while it was cut off.
  async backfill(spacecraft, quantities, t_tai_ns) {
    for (const name of this.names) {
      const quantity = name === 'bound' ? 'bound_deg' : name === 'attitude' ? 'sigma_deg' : `${name}_sigma_deg`;
      if (!quantities.some(one => one.name === quantity)) continue;
      const { points } = await seriesOf(spacecraft, quantity, t_tai_ns - span_ns, t_tai_ns);
      const kept = [...this.rings[name]];
      const last = points.at(-1)?.t_tai_ns ?? -Infinity;
      this.rings[name].clear();
      for (const { t_tai_ns: t, value } of points) this.push(name, t, value);
      for (const [t, value] of kept) if (t > last) this.push(name, t, value);
    }
  }

  draw(utcOf) {
    if (this.is_newer) {
      byId('sigma-note').textContent = this.names.filter(name => this.newest[name])
        .map(name => `${name} ${sigma(this.newest[name].sigma_deg)}`).join(', ');
    }
    this.is_newer = false;
    if (!this.changed) return;
    this.changed = false;
    const times = new Map();
    this.names.forEach((name, i) => {
      for (const [t, value] of this.rings[name]) {
        if (!times.has(t)) times.set(t, this.names.map(() => undefined));
        times.get(t)[i] = value;
      }
    });
    const sorted = [...times.keys()].sort((a, b) => a - b);
    // undefined, unlike null, does not break a line.
    this.chart.draw([sorted.map(utcOf), ...this.names.map((_, i) => sorted.map(t => times.get(t)[i]))]);
  }

  destroy() { this.chart.destroy(); }
}
