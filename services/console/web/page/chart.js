// A uPlot chart that fills its box.
import { clock } from './text.js';

const axis = label => ({ label, labelSize: 18, stroke: '#a4b0b9', grid: { stroke: '#2a333b' }, ticks: { stroke: '#38434d' },
  font: '13px "DejaVu Sans"', labelFont: '13px "DejaVu Sans"' });

// `lines`: uPlot's series without the time.
export class Chart {
  constructor(box, lines, options = {}) {
    this.box = box;
    this.plot = new uPlot({
      width: box.clientWidth || 300,
      height: 100,
      padding: [null, 32, null, null],  // Half of a time stands right of its tick.
      series: [{ label: 'UTC', value: (plot, utc_s) => clock(utc_s ?? NaN) }, ...lines],
      axes: [{ ...axis(), values: (plot, ticks) => ticks.map(clock), space: 80 }, { ...axis(options.unit), size: 64 }],
      scales: { y: { distr: options.logarithmic ? 3 : 1 } },
      cursor: { y: false },
    }, lines.map(() => []).concat([[]]), box);
  }

  fit() {
    const legend = this.box.querySelector('.u-legend')?.offsetHeight ?? 0;
    const [width, height] = [this.box.clientWidth, Math.max(60, this.box.clientHeight - legend)];
    if (width && (width !== this.plot.width || height !== this.plot.height)) this.plot.setSize({ width, height });
  }

  draw(data) {
    this.fit();
    this.plot.setData(data);
  }

  destroy() { this.plot.destroy(); }
}

export const line = (label, stroke, dash) => ({ label, stroke, dash, width: 2, points: { size: 4 } });

// A small cross a point: what was rejected is told by its form, too.
export const crosses = (label, stroke) => ({ label, stroke, width: 1.5, paths: (plot, series, from, to) => {
  const path = new Path2D();
  const half = 4 * devicePixelRatio;
  for (let i = from; i <= to; ++i) {
    const value = plot.data[series][i];
    if (value == null) continue;
    const x = plot.valToPos(plot.data[0][i], 'x', true);
    const y = plot.valToPos(value, 'y', true);
    path.moveTo(x - half, y - half);
    path.lineTo(x + half, y + half);
    path.moveTo(x - half, y + half);
    path.lineTo(x + half, y - half);
  }
  return { stroke: path, fill: null, clip: null, band: null, gaps: null, flags: 0 };
}, points: { show: false } });

export const dots = (label, stroke) => ({ label, stroke, paths: () => null, points: { show: true, size: 5, fill: stroke } });
