// Takes the service's events in, and draws what changed at most ten times a second.
import { askAction, drawActions } from './actions.js';
import { drawAlerts } from './alerts.js';
import { drawAttitude } from './attitude.js';
import { Convergence } from './convergence.js';
import { drawHeader } from './header.js';
import { drawHealth } from './health.js';
import { Raster } from './raster.js';
import { Residuals } from './residuals.js';
import { Series } from './series.js';
import { drawSky, onRoot } from './sky.js';
import { byId, duration, element } from './text.js';

const stale_after_ms = 3000;
const redraw_ms = 100;
const convergence_ms = 1000;
const series_ms = 5000;  // a pixel of their half an hour
const reopen_ms = 2000;

const raster = new Raster();
const series = new Series(trace => trace.refresh(craft().t_tai_ns, utcOf));
let convergence = null;
let residuals = null;
let state = null;
let shown = '';       // the spacecraft on the page
let heard_ms = null;  // when the service was last heard
let state_ms = 0;
let leap_seconds = [];  // [TAI of its start, s, TAI minus UTC from then on, s]
let dirty = true;
let lost = false;     // the connection was, and the past is to be filled in again

const before = holds => leap_seconds.findLast(holds)?.[1] ?? NaN;
const utcOf = t_tai_ns => t_tai_ns / 1e9 - before(([start_s]) => start_s <= t_tai_ns / 1e9);
const taiOf = utc_s => (utc_s + before(([start_s, offset_s]) => start_s - offset_s <= utc_s)) * 1e9;
const craft = () => state?.spacecraft?.[shown] ?? {};

function takeState(next) {
  state = next;
  state_ms = performance.now();
  leap_seconds = state.leap_seconds.map(one => [one.start_tai_ns / 1e9, one.tai_minus_utc_s]);
  const ids = Object.keys(state.spacecraft ?? {}).sort();
  const select = byId('spacecraft');
  if (ids.join('\n') !== [...select.options].map(option => option.value).join('\n')) {
    select.replaceChildren(...ids.map(id => {
      const option = element('option', id);
      option.value = id;
      return option;
    }));
    select.value = ids.includes(shown) ? shown : ids[0] ?? '';
  }
  if (select.value !== shown) show(select.value);
  else if (lost) backfill();
  lost = false;
}

async function show(id) {
  shown = id;
  document.body.dataset.kind = craft().kind ?? 'spin';
  raster.clear();
  convergence?.destroy();
  convergence = new Convergence(craft().kind === 'three_axis' ? ['attitude'] : ['mean', 'sequential', 'batch', 'bound']);
  residuals?.destroy();
  residuals = new Residuals(byId('residuals'), byId('residuals-note'), id, craft().kind ?? 'spin');
  residuals.refresh(craft().t_tai_ns, utcOf);
  await series.open(id);
  if (id === shown) backfill();
}

async function backfill() {
  const { t_tai_ns, kind } = craft();
  if (!t_tai_ns) return;
  try {
    await Promise.all([convergence.backfill(shown, series.quantities, t_tai_ns),
      kind === 'three_axis' ? undefined : raster.backfill(shown, t_tai_ns)]);
  } catch (error) {
    byId('sigma-note').textContent = `the past is missing: ${error.message}`;
  }
}

const handlers = {
  state: takeState,
  estimate(row) {
    if (row.spacecraft !== shown) return;
    convergence?.push(row.estimator, row.t_tai_ns, row.sigma_deg);
    convergence?.push('bound', row.t_tai_ns, row.bound_deg);
  },
  attitude(row) {
    if (row.spacecraft === shown) convergence?.push('attitude', row.t_tai_ns, row.sigma_deg);
  },
  pulse(batch) {
    if (batch.spacecraft === shown) for (const edge of batch.pulses) raster.push(edge);
  },
  health(service) {
    if (state) state.service = { ...state.service, ...service };
  },
  // The whole list stands in the next state, a second away at most.
  alert(row) {
    if (!state) return;
    state.alerts = (state.alerts ?? []).filter(one => one.alert_id !== row.alert_id);
    if (row.state !== 'cleared') state.alerts.push(row);
  },
};

// Those that change what draw() takes from the state.
const drawn = ['state', 'health', 'alert'];

function open() {
  const source = new EventSource('/api/v1/events');
  for (const [name, take] of Object.entries(handlers)) {
    source.addEventListener(name, event => {
      heard_ms = performance.now();
      take(JSON.parse(event.data));
      dirty ||= drawn.includes(name);
    });
  }
  // The browser opens a broken connection again by itself, but not one that was refused.
  source.addEventListener('error', () => {
    lost = true;
    if (source.readyState !== EventSource.CLOSED) return;
    source.close();
    setTimeout(open, reopen_ms);
  });
}

// Of the boxes, whose sizes changed.
function fit() {
  dirty = raster.changed = true;
  for (const one of [series.trace, convergence, residuals]) one?.chart.fit();
}

function drawStale() {
  const silent_ms = heard_ms === null ? Infinity : performance.now() - heard_ms;
  const stale = silent_ms > stale_after_ms;
  if (document.body.classList.contains('stale') !== stale) {
    document.body.classList.toggle('stale', stale);
    fit();
  }
  const why = !stale ? '' : heard_ms === null ? 'no word from the service yet'
    : `no word from the service for ${duration(Math.floor(silent_ms / 1e3))}; what is shown is old`;
  if (byId('stale-why').textContent !== why) byId('stale-why').textContent = why;
  return stale;
}

function draw() {
  if (document.hidden) return;
  const stale = drawStale();
  if (!state) return;
  drawHeader(craft(), state.service, (performance.now() - state_ms) / 1e3, stale);
  const spin = craft().kind !== 'three_axis';
  if (spin) raster.draw(utcOf);
  if (!dirty) return;
  dirty = false;
  const known = Object.values(state.spacecraft ?? {}).some(one => one.state && one.state !== 'waiting');
  drawAlerts(state.alerts ?? [], shown, known, utcOf);
  drawHealth(state.service, stale);
  drawActions(craft(), utcOf);
  residuals?.summarise(craft().residuals);
  if (spin) drawSky(craft());
  else drawAttitude(craft(), utcOf);
}

const act = (...chosen) => askAction(shown, craft(), { utcOf, taiOf, now_s: utcOf(craft().t_tai_ns) }, ...chosen);
byId('act').addEventListener('click', () => act());
onRoot(craft, axis => act('choose_root', axis));

byId('spacecraft').addEventListener('change', event => show(event.target.value));
addEventListener('resize', fit);
document.addEventListener('visibilitychange', () => { dirty = true; });
setInterval(draw, redraw_ms);
setInterval(() => { if (!document.hidden) convergence?.draw(utcOf); }, convergence_ms);
setInterval(() => {
  if (document.hidden || !shown) return;
  residuals?.refresh(craft().t_tai_ns, utcOf);
  if (series.trace) series.refresh();
  else series.open(shown);
}, series_ms);
open();
