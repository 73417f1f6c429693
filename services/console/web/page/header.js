// What the operator must see at a glance, whatever else is on the page.
import { byId, duration, element, sigma, sign, withinSigma } from './text.js';

const figures = ['UTC', 'Data age', 'Mode', 'Link', 'Spin rate', 'Axis RA / Dec', '1 σ', 'To target'];
const ofSpin = ['Spin rate', 'Axis RA / Dec'];
const settled = { GEOMETRY: 'by geometry', CONSTRAINT: 'by constraint', PRIOR: 'by prior', DISPERSION: 'by dispersion',
  AMBIGUOUS: '⇄ NOT settled' };
const places = new Map();

for (const name of figures) {
  const box = element('div');
  const value = element('dd', '–');
  value.id = `figure-${name.toLowerCase().replaceAll(/[^a-z]+/g, '-')}`;
  box.append(element('dt', name), value);
  byId('figures').append(box);
  places.set(name, value);
}

function write(place, text, className = '') {
  if (place.textContent !== text) place.textContent = text;
  place.className = className;
}
const say = (id, ...what) => write(byId(id), ...what);
const put = (name, ...what) => write(places.get(name), ...what);

// What was go when the service was last heard is not known to be so now.
function drawGo(go, stale) {
  const isGo = go?.is_go === true && !stale;
  const accepted = (go?.accepted ?? []).map(one => one.text).join('; ');
  say('go', isGo ? '✔ GO' : '✖ NO GO', isGo ? 'good' : 'bad');
  say('against', stale ? 'no word from the service' : isGo ? accepted || 'nothing stands against it'
    : (go?.against ?? []).map(one => one.text).join('; ') || 'nothing is known yet');
}

// `since_s`: since the service said so. `stale`: too long ago to be called the state of the link.
export function drawHeader(craft, service, since_s, stale) {
  const spin = craft.kind !== 'three_axis';
  for (const name of ofSpin) places.get(name).parentElement.hidden = !spin;
  places.get('To target').parentElement.hidden = !Number.isFinite(craft.to_target_deg);
  put('UTC', craft.utc ? craft.utc.replace('T', ' ').replace(/(\.\d+)?Z$/, '') : '–');
  const isOfBefore = craft.utc && !Number.isFinite(craft.data_age_s);
  put('Data age', isOfBefore ? 'before the start' : duration(craft.data_age_s + since_s),
    craft.state === 'stale' ? 'bad' : '');
  put('Mode', service?.mode === 'replay' ? '↻ REPLAY' : service?.mode ? `▶ ${service.mode.toUpperCase()}` : '–',
    service?.mode === 'replay' ? 'warn' : '');
  const link = stale ? 'unknown' : craft.state ?? 'waiting';
  const [icon, colour] = sign(link);
  put('Link', `${icon} ${link.toUpperCase()}`, colour);
  put('Spin rate', `${withinSigma(craft.spin_rate_rpm, 4, craft.sigma_rpm)} ± ${sigma(craft.sigma_rpm, '')} rpm`);
  put('Axis RA / Dec', [craft.ra_deg, craft.dec_deg].map(angle => withinSigma(angle, 3, craft.sigma_deg, '°')).join(' / '));
  put('1 σ', sigma(craft.sigma_deg));
  put('To target', withinSigma(craft.to_target_deg, 2, craft.sigma_deg, '°'));
  const [mark, tone] = sign(craft.quality);
  const waiting = (craft.state ?? 'waiting') === 'waiting';
  say('quality', `${mark} ${craft.quality ?? (waiting ? 'WAITING' : 'NO ANSWER')}`, tone);
  const asOf = craft.answer_utc ? `${craft.estimator} at ${craft.answer_utc.replace(/^.*T/, '').replace(/\.\d+Z$/, 'Z')}` : craft.estimator;
  say('why', craft.quality ? [asOf, craft.why].filter(Boolean).join(': ') : waiting ? 'for the first telemetry' : 'no estimator has one yet');
  // The answer may rest on more than the last fix, which alone leaves two axes.
  const isOpen = craft.resolution === 'AMBIGUOUS' && !['OK', 'CONVERGING'].includes(craft.quality);
  const dual = craft.resolution === 'AMBIGUOUS' && !isOpen ? 'last fix alone leaves it open' : settled[craft.resolution] ?? '–';
  say('case', Number.isFinite(craft.geometry_case) ? `case ${craft.geometry_case}, dual solution: ${dual}` : '', isOpen ? 'warn' : 'dim');
  drawGo(craft.go, stale);
}
