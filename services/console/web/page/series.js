// One quantity of the archive against time, chosen by the operator. Measurements have no event of their own:
// the newest span is asked for again and again, decimated by the service.
import { Chart, crosses, dots } from './chart.js';
import { byId, element } from './text.js';

const span_ns = 1800e9;
const points = 800;

export async function json(path) {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`the service answered ${answer.status}`);
  return answer.json();
}

// `to` and `from` are beyond the integers of a double, which is off by no more than 256 ns here.
export function seriesOf(spacecraft, quantity, from, to) {
  const query = new URLSearchParams({ spacecraft, quantity, from: BigInt(Math.floor(from)), to: BigInt(Math.ceil(to)), points });
  return json(`/api/v1/series?${query}`);
}

export class Series {
  constructor() {
    this.quantities = [];
    this.rows = [];
    this.select = byId('quantity');
    this.select.addEventListener('change', () => this.choose());
    byId('series').addEventListener('pointermove', () => this.say());
  }

  async open(spacecraft) {
    this.spacecraft = spacecraft;
    this.chart?.destroy();
    this.chart = null;
    this.rows = [];
    this.quantities = [];
    try {
      const { quantities } = await json(`/api/v1/quantities?spacecraft=${encodeURIComponent(spacecraft)}`);
      if (spacecraft !== this.spacecraft) return;
      this.quantities = quantities;
    } catch (error) {
      this.fail(error);
    }
    this.select.replaceChildren(...this.quantities.map(({ name }) => {
      const option = element('option', name.replaceAll('_', ' '));
      option.value = name;
      return option;
    }));
    if (this.quantities.some(({ name }) => name === 'sun_angle')) this.select.value = 'sun_angle';
    if (this.quantities.length) this.choose();
  }

  choose() {
    this.chart?.destroy();
    this.rows = [];
    const { unit } = this.quantities.find(({ name }) => name === this.select.value);
    this.chart = new Chart(byId('series'), [dots('accepted', '#7cb9f2'), crosses('rejected', '#ff8a75')], { unit });
    this.asked = '';
  }

  fail(error) { byId('series-note').textContent = `no series: ${error.message}`; }

  // The span that ends at `t_tai_ns`.
  async refresh(t_tai_ns, utcOf) {
    if (!this.chart || this.busy || !t_tai_ns || this.asked === `${t_tai_ns}`) return;
    this.busy = true;
    const { chart, spacecraft } = this;
    try {
      const answer = await seriesOf(spacecraft, this.select.value, t_tai_ns - span_ns, t_tai_ns);
      if (chart !== this.chart) return;
      this.asked = `${t_tai_ns}`;
      this.rows = answer.points;
      chart.draw([
        this.rows.map(row => utcOf(row.t_tai_ns)),
        this.rows.map(row => row.accepted === false ? null : row.value),
        this.rows.map(row => row.accepted === false ? row.value : null),
      ]);
      const rejected = this.rows.filter(row => row.accepted === false).length;
      this.summary = this.rows.length ? `last 30 min, ${this.rows.length} points, ${rejected} rejected` : 'no points yet';
      this.say();
    } catch (error) {
      this.fail(error);
    } finally {
      this.busy = false;
    }
  }

  say() {
    const row = this.rows[this.chart?.plot.cursor.idx];
    byId('series-note').textContent = row?.accepted === false ? `rejected: ${row.rejected_by ?? 'no reason given'}`
      : this.summary ?? '';
  }
}
