// Attitude of a three-axis spacecraft: quaternion, Euler angles, rates, and the events of a reconstruction.
import { byId, clock, fillTable, number, sigma } from './text.js';

const degrees = radians => radians * 180 / Math.PI;

// Angles phi, theta, psi (about x, y, z; turned psi, phi, theta) in degrees of q = [x, y, z, w], ICRF to body.
export function euler312([x, y, z, w]) {
  return [
    degrees(Math.asin(Math.max(-1, Math.min(1, 2 * (y * z + w * x))))),
    degrees(Math.atan2(-2 * (x * z - w * y), w * w - x * x - y * y + z * z)),
    degrees(Math.atan2(-2 * (x * y - w * z), w * w - x * x + y * y - z * z)),
  ];
}

const list = (values, digits) => values.map(value => number(value, digits)).join('  ');

export function drawAttitude(craft, utcOf) {
  const rows = [];
  if (craft.q_icrf_body) {
    rows.push(['q x y z w', list(craft.q_icrf_body, 5)], ['φ θ ψ (3-1-2), °', list(euler312(craft.q_icrf_body), 3)]);
  }
  if (craft.rate_deg_s) rows.push(['Rate x y z, °/s', list(craft.rate_deg_s, 4)]);
  rows.push(['Sigma', sigma(craft.sigma_deg)], ['Source', craft.source ?? craft.estimator ?? '–']);
  const t1 = craft.separation;
  if (t1) rows.push(['At T1', `${t1.quality}, ${sigma(t1.sigma_deg)}, ${t1.method} at ${clock(utcOf(t1.t_tai_ns))}`]);
  fillTable(byId('attitude'), rows);
  const events = (craft.reconstruction ?? []).map(row => [`${row.event} ${row.method}`, clock(utcOf(row.t_tai_ns)),
    list([1, 2, 3].map(i => row[`euler312_icrf_deg_${i}`]), 2), sigma(row.sigma_deg)]);
  fillTable(byId('events'), events.length ? events : [['none reconstructed']]);
}
