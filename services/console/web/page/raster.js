// Spin phase of the edges against time: a dot for an accepted one, a cross for a rejected one, in another colour for one
// that only the filter left out; each channel's name at its last edge.
import { Ring } from './ring.js';
import { begin, colours, cross } from './canvas.js';
import { byId, clock, number } from './text.js';
import { isLeftOut, isRejected, nextLeftOut, whatBecameOf } from './held.js';
import { seriesOf } from './trace.js';

const shown_s = 300;
const most = 1000;  // edges of a channel: 200 rpm
const channels = { sun1: '#f2b134', sun2: '#ffd98a', north_in: '#7cb9f2', north_out: '#b4d7f7', south_in: '#6fd08c',
  south_out: '#b0e8c0' };
const left = 40;
const right = 74;  // of the names
const row = 14;
const bottom = 20;

export class Raster {
  constructor() {
    this.canvas = byId('raster');
    this.edges = new Ring(6000);
    this.drawn = [];
    this.canvas.addEventListener('pointermove', event => this.say(event.offsetX, event.offsetY));
    this.canvas.addEventListener('keydown', event => this.walk(event));
  }

  push(edge) {
    this.edges.push(edge);
    this.changed = true;
  }
  clear() {
    this.edges.clear();
    this.changed = true;
  }

  // What came before the page was opened, or while it was cut off.
  async backfill(spacecraft, t_tai_ns) {
    const series = await Promise.all(Object.keys(channels).map(async channel => {
      const { points } = await seriesOf(spacecraft, `phase_${channel}`, t_tai_ns - shown_s * 1e9, t_tai_ns, most);
      return points.map(({ value, ...edge }) => ({ ...edge, channel, phase_deg: value }));
    }));
    const past = series.flat().sort((a, b) => a.t_tai_ns - b.t_tai_ns);
    const last = past.at(-1)?.t_tai_ns ?? -Infinity;
    const later = [...this.edges].filter(edge => edge.t_tai_ns > last);
    this.clear();
    for (const edge of [...past, ...later]) this.push(edge);
  }

  draw(utcOf) {
    if (!this.changed) return;
    this.changed = false;
    const { pen, width, height } = begin(this.canvas);
    const plot = { w: width - left - right, h: height - bottom - 8 };
    let last = -Infinity;
    for (const edge of this.edges) last = Math.max(last, utcOf(edge.t_tai_ns));
    pen.fillStyle = colours.dim;
    pen.strokeStyle = colours.line;
    for (const phase of [0, 90, 180, 270, 360]) {
      const y = 6 + plot.h * (1 - phase / 360);
      pen.fillText(`${phase}°`, 2, y + 5);
      pen.beginPath();
      pen.moveTo(left, y);
      pen.lineTo(left + plot.w, y);
      pen.stroke();
    }
    this.drawn = [];
    const named = new Map();
    if (!Number.isFinite(last)) {
      pen.fillText('no edges in the last 5 min', left + 10, 40);
      return;
    }
    for (const part of plot.w < 200 ? [0, 1] : [0, 0.5, 1]) {
      pen.fillText(clock(last - shown_s * (1 - part)), left + part * (plot.w - 60), height - 4);
    }
    for (const edge of this.edges) {
      const x = left + plot.w * (1 - (last - utcOf(edge.t_tai_ns)) / shown_s);
      if (x < left || !Number.isFinite(edge.phase_deg)) continue;
      const y = 6 + plot.h * (1 - edge.phase_deg / 360);
      this.drawn.push({ x, y, edge, at: utcOf(edge.t_tai_ns) });
      named.set(edge.channel, y);
      if (isLeftOut(edge)) {
        pen.strokeStyle = isRejected(edge) ? colours.bad : colours.warn;
        cross(pen, x, y, 4);
      } else {
        pen.fillStyle = channels[edge.channel] ?? colours.text;
        pen.fillRect(x - 1.5, y - 1.5, 3, 3);
      }
    }
    this.name(pen, named, left + plot.w + 8, 6 + plot.h);
  }

  // Below one another where their edges are close.
  name(pen, named, x, lowest) {
    const places = [...named].sort(([, a], [, b]) => a - b);
    let free = 0;
    places.forEach(([channel, y], i) => {
      const at = Math.max(free, Math.min(y + 5, lowest - row * (places.length - 1 - i)));
      free = at + row;
      pen.fillStyle = channels[channel] ?? colours.text;
      pen.fillText(channel, x, at);
    });
  }

  say(x, y) {
    let nearest = null;
    let best = 15;
    for (const one of this.drawn) {
      const away = Math.hypot(one.x - x, one.y - y);
      if (away < best) [nearest, best] = [one, away];
    }
    this.tell(nearest);
  }

  walk(event) {
    const edge = nextLeftOut(event, this.drawn.map(one => one.edge), this.told);
    if (edge) this.tell(this.drawn.find(one => one.edge === edge));
  }

  tell(one) {
    this.told = one?.edge;
    byId('raster-said').textContent = one
      ? `${one.edge.channel} ${clock(one.at)} ${number(one.edge.phase_deg, 1, '°')} ${whatBecameOf(one.edge)}`
      : '';
  }
}
