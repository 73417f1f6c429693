// The sky in right ascension (rising to the left) and declination.
import { begin, colours, cross } from './canvas.js';
import { byId, sigma, withinSigma } from './text.js';

const left = 34;
const bottom = 18;
const smallest_px = 9;  // of an ellipse that can be seen
const near_px = 22;     // for a finger

function place(width, height) {
  return (ra_deg, dec_deg) => [left + (width - left - 6) * (1 - ra_deg / 360), 6 + (height - bottom - 6) * (90 - dec_deg) / 180];
}

// Half-axes in degrees and the angle of the larger one from east to north.
function ellipseOf({ cov_east_east_deg2: ee, cov_east_north_deg2: en, cov_north_north_deg2: nn }) {
  const mean = (ee + nn) / 2;
  const apart = Math.hypot((ee - nn) / 2, en);
  return { a: Math.sqrt(mean + apart), b: Math.sqrt(Math.max(0, mean - apart)), angle: Math.atan2(2 * en, ee - nn) / 2 };
}

function grid(pen, width, height, at) {
  pen.strokeStyle = colours.line;
  pen.fillStyle = colours.dim;
  for (const dec of [-90, -45, 0, 45, 90]) {
    const [, y] = at(0, dec);
    pen.beginPath();
    pen.moveTo(left, y);
    pen.lineTo(width - 6, y);
    pen.stroke();
    pen.fillText(`${dec}`, 2, Math.min(height - bottom, Math.max(12, y + 5)));
  }
  for (const ra of [0, 90, 180, 270, 360]) {
    const [x] = at(ra, 0);
    pen.beginPath();
    pen.moveTo(x, 6);
    pen.lineTo(x, height - bottom);
    pen.stroke();
    pen.fillText(`${ra}`, Math.min(x - 8, width - 30), height - 4);
  }
}

// `word` beside the place, on the side that has room, below the words that stand there.
function label(pen, width, x, y, word, words) {
  const length = pen.measureText(word).width;
  const from = x + 15 + length > width ? x - 15 - length : x + 15;
  let at = Math.round(Math.max(14, y + 5));  // Whole, so that a word below another one is exactly so far away.
  const taken = one => from < one.to && from + length > one.from && Math.abs(one.at - at) < 14;
  for (let other = words.find(taken); other; other = words.find(taken)) at = other.at + 14;
  words.push({ from, to: from + length, at });
  pen.fillText(word, from, at);
}

function mark(pen, width, [x, y], shape, colour, word, words) {
  pen.strokeStyle = pen.fillStyle = colour;
  pen.lineWidth = 2;
  pen.beginPath();
  if (shape === 'cross') cross(pen, x, y, 5);
  if (shape === 'disc' || shape === 'ring') pen.arc(x, y, 6, 0, 2 * Math.PI);
  if (shape === 'square') pen.rect(x - 6, y - 6, 12, 12);
  if (shape === 'disc') pen.fill(); else pen.stroke();
  label(pen, width, x, y, word, words);
}

// Draws the ellipse and says how much larger than true it is.
function drawEllipse(pen, [x, y], craft, estimate, deg_px) {
  const { a, b, angle } = ellipseOf(estimate);
  if (!(a > 0)) return '';
  const across = deg_px.ra / Math.max(0.05, Math.cos(craft.dec_deg * Math.PI / 180));
  const times = Math.max(1, smallest_px / (a * deg_px.dec));
  pen.save();
  pen.strokeStyle = colours.good;
  pen.lineWidth = 1.5;
  pen.translate(x, y);
  pen.scale(-across, -deg_px.dec);
  pen.rotate(angle);
  pen.beginPath();
  pen.ellipse(0, 0, a * times, b * times, 0, 0, 2 * Math.PI);
  pen.restore();
  pen.strokeStyle = colours.good;
  pen.stroke();
  return times > 1 ? `, drawn ${Number(times.toPrecision(2))} times its size` : '';
}

const otherText = byId('other-root');
// A single fix of two axes asks nothing while the answer is sure.
const otherRoot = craft => (craft.quality ?? craft.resolution) === 'AMBIGUOUS' && craft.other_axis ? [craft.other_axis.ra_deg, craft.other_axis.dec_deg] : [NaN, NaN];
const candidates = craft => [[craft.ra_deg, craft.dec_deg], otherRoot(craft)]
  .filter(place => place.every(Number.isFinite));

// Tells `choose` which of the two axes was pointed at.
export function onRoot(craft, choose) {
  byId('sky').addEventListener('click', ({ offsetX, offsetY, target }) => {
    const at = place(target.clientWidth, target.clientHeight);
    const near = candidates(craft()).map(one => [one, Math.hypot(at(...one)[0] - offsetX, at(...one)[1] - offsetY)])
      .filter(([, away]) => away < near_px).sort(([, a], [, b]) => a - b);
    if (near.length) choose({ ra_deg: near[0][0][0], dec_deg: near[0][0][1] });
  });
  otherText.addEventListener('click', () => choose(craft().other_axis));
}

function drawOtherText(craft) {
  const [ra, dec] = otherRoot(craft);
  otherText.hidden = !Number.isFinite(ra);
  const shown = degrees => withinSigma(degrees, 2, craft.other_axis?.sigma_deg, '°');
  const text = `Choose RA ${shown(ra)} Dec ${shown(dec)}`;
  if (otherText.textContent !== text) otherText.textContent = text;
}

export function drawSky(craft) {
  drawOtherText(craft);
  const { pen, width, height } = begin(byId('sky'));
  const at = place(width, height);
  grid(pen, width, height, at);
  const words = [];
  const put = (ra, dec, shape, colour, word) => {
    if (Number.isFinite(ra) && Number.isFinite(dec)) mark(pen, width, at(ra, dec), shape, colour, word, words);
  };
  put(craft.ra_deg, craft.dec_deg, 'cross', colours.good, 'axis');
  put(craft.sun_ra_deg, craft.sun_dec_deg, 'disc', colours.warn, 'Sun');
  put(craft.earth_ra_deg, craft.earth_dec_deg, 'ring', colours.mark, 'Earth');
  put(craft.prior?.ra_deg, craft.prior?.dec_deg, 'square', colours.dim, 'prior');
  put(craft.target?.ra_deg, craft.target?.dec_deg, 'square', colours.text, 'target');
  put(...otherRoot(craft), 'cross', colours.bad, 'other axis');
  const estimate = craft.estimates?.[craft.estimator];
  let note = 'no axis yet';
  if (Number.isFinite(craft.ra_deg)) {
    const scale = estimate ? drawEllipse(pen, at(craft.ra_deg, craft.dec_deg), craft, estimate,
      { ra: (width - left - 6) / 360, dec: (height - bottom - 6) / 180 }) : '';
    note = `1 σ ${sigma(craft.sigma_deg)}${scale}`;
    if (Number.isFinite(craft.to_target_deg)) note += `; ${withinSigma(craft.to_target_deg, 2, craft.sigma_deg, '°')} to the target`;
  }
  byId('sky-note').textContent = note;
}
