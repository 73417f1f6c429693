// The quantity that the operator chooses.
import { Trace, json } from './trace.js';
import { byId, element } from './text.js';

const shown_first = ['sun_angle', 'rate_x_deg_s'];

export class Series {
  // `fill`: gives a trace its points.
  constructor(fill) {
    this.fill = fill;
    this.quantities = [];
    this.select = byId('quantity');
    this.select.addEventListener('change', () => this.choose());
  }

  async open(spacecraft) {
    this.spacecraft = spacecraft;
    this.trace?.destroy();
    this.trace = null;
    this.quantities = [];
    try {
      const { quantities } = await json(`/api/v1/quantities?spacecraft=${encodeURIComponent(spacecraft)}`);
      if (spacecraft !== this.spacecraft) return;
      this.quantities = quantities;
    } catch (error) {
      byId('series-note').textContent = `no series: ${error.message}`;
      return;
    }
    this.select.replaceChildren(...this.quantities.map(({ name }) => {
      const option = element('option', name.replaceAll('_', ' '));
      option.value = name;
      return option;
    }));
    this.select.value = this.quantities.find(({ name }) => shown_first.includes(name)).name;
    this.choose();
  }

  choose() {
    this.trace?.destroy();
    byId('series-note').textContent = '';
    this.trace = new Trace(byId('series'), byId('series-note'), this.spacecraft,
      this.quantities.find(({ name }) => name === this.select.value));
    this.refresh();
  }

  refresh() { this.fill(this.trace); }
}
