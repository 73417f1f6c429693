// The operator's word on telemetry: each action with what it needs, and what the service has taken.
import { ask, askFor, field } from './hand.js';
import { byId, clock, fillTable, number } from './text.js';

const channels = { spin: ['sun1', 'sun2', 'north_in', 'north_out', 'south_in', 'south_out'], three_axis: ['gyro', 'star', 'sun', 'magnetometer'] };
const form = '\\d{4}-\\d\\d-\\d\\d \\d\\d:\\d\\d:\\d\\d';
const sent = new Map();  // by action_id: those that no state has told yet

const written = utc_s => Number.isFinite(utc_s) ? new Date(utc_s * 1e3).toISOString().slice(0, 19).replace('T', ' ') : '';
const utc = (word, name, utc_s, attributes) =>
  field(`${word}, UTC`, name, { value: written(utc_s), pattern: form, placeholder: 'YYYY-MM-DD hh:mm:ss', ...attributes });
const degrees = (word, name, value, min, max) =>
  field(`${word}, deg`, name, { type: 'number', step: 'any', min, max, value: Number.isFinite(value) ? Number(value.toFixed(4)) : '' });
const axis = place => [degrees('Right ascension', 'ra_deg', place?.ra_deg, -360, 360), degrees('Declination', 'dec_deg', place?.dec_deg, -90, 90)];
const channel = (craft, first = []) => field('Channel', 'channel', {
  required: !first.length, options: [...first, ...channels[craft.kind].map(name => [name, name])] });

const at = ({ ra_deg, dec_deg }) => `RA ${ra_deg}°, Dec ${dec_deg}°`;

// `place`: the axis that was pointed at, if any was.
const actions = {
  exclude_channel: { word: 'Exclude a channel', fields: craft => [channel(craft)], does: said => `Leaves channel ${said.channel} out` },
  include_channel: { word: 'Include a channel again', fields: craft => [channel(craft)], does: said => `Uses channel ${said.channel} again` },
  exclude_segment: {
    word: 'Exclude a segment',
    fields: (craft, place, now_s) => [utc('From', 'from', now_s - 60), utc('To', 'to', now_s), channel(craft, [['', 'all channels']])],
    isOfItsTime: true,
    does: said => `Leaves out ${said.channel ? `channel ${said.channel}` : 'all channels'} from ${said.from} to ${said.to} UTC: ${
      'batch and reconstruction forget what came of it, other answers that are computed stay'}`,
  },
  choose_root: { word: 'Choose the axis of two', of: 'spin', fields: (craft, place) => axis(place ?? craft.other_axis),
    does: said => `Takes, of two axes that fit, the one near ${at(said)}` },
  set_prior: {
    word: 'Set a prior', of: 'spin',
    fields: craft => [...axis(craft.prior), degrees('Sigma', 'sigma_deg', craft.prior?.sigma_deg, 0.001, 180)],
    does: said => `Holds the axis to be at ${at(said)}, sigma ${said.sigma_deg}°`,
  },
  mark_manoeuvre: { word: 'Mark a manoeuvre', of: 'spin', fields: () => [], does: () => 'Lets the axis be new: its sigma opens again' },
  set_limit: {
    word: 'Set a limit of an alert',
    fields: () => [field('Alert', 'key', { placeholder: 'spin.sigma' }), field('Limit', 'limit', { placeholder: 'deg' }),
      field('Value', 'value', { type: 'number', step: 'any', min: 0 })],
    does: said => `Sets ${said.limit} of ${said.key} to ${said.value}`,
  },
  set_target: { word: 'Set the target axis', of: 'spin', fields: craft => axis(craft.target), does: said => `Measures how far the axis is from ${at(said)}` },
};

const numbers = ['ra_deg', 'dec_deg', 'sigma_deg'];
const times = { from: 'from_tai_ns', to: 'to_tai_ns', since: 't_tai_ns' };

// What is left empty is not sent.
function bodyOf({ limit, value: bound, ...said }, spacecraft, taiOf) {
  const body = { spacecraft };
  if (limit) body[limit] = Number(bound);
  for (const [name, value] of Object.entries(said)) {
    if (value === '') continue;
    if (times[name]) body[times[name]] = taiOf(Date.parse(`${value.replace(' ', 'T')}Z`) / 1e3);
    else body[name] = numbers.includes(name) ? Number(value) : value;
  }
  return body;
}

// `time`: utcOf and taiOf, and the UTC of the last sample.
export function askAction(spacecraft, craft, time, chosen = 'exclude_channel', place = undefined) {
  const known = Object.entries(actions).filter(([, { of = craft.kind }]) => of === craft.kind);
  const select = field('Action', 'action', { options: known.map(([name, { word }]) => [name, word]) });
  const since = utc('From (empty: now)', 'since', NaN, { required: false });
  const fieldsOf = name => [select, ...actions[name].fields(craft, place, time.now_s), ...actions[name].isOfItsTime ? [] : [since]];
  select.lastChild.value = chosen;
  select.lastChild.addEventListener('change', event => {
    askFor(fieldsOf(event.target.value));
    event.target.focus();
  });
  ask({
    title: `Operator's hand: ${spacecraft}`,
    path: '/api/v1/actions',
    fields: fieldsOf(chosen),
    body: said => bodyOf(said, spacecraft, time.taiOf),
    sentence: said => `${actions[said.action].does(said)}, for telemetry of ${spacecraft}${
      actions[said.action].isOfItsTime ? '' : ` from ${said.since ? `${said.since} UTC` : 'now'} on`
    }, by ${said.by}. It is stored, and repeated after a restart.`,
    taken: ({ action_id }, said) => sent.set(action_id, said),
  });
}

const listed = said => said.key ? Object.entries(said).map(pair => pair.filter(word => word !== 'key').join(' ')).join(', ') : ['channel', 'ra_deg', 'dec_deg', 'sigma_deg'].filter(name => said[name] !== undefined)
  .map(name => name === 'channel' ? said.channel : `${name.replace('_deg', '')} ${number(said[name], 2, '°')}`).join(', ');

// The newest first; of this page's what the service has not computed yet above them.
export function drawActions(craft, utcOf) {
  const done = [...craft.actions ?? []].reverse();
  for (const { action_id } of done) sent.delete(action_id);
  const rows = [...sent.values()].map(said => ['◔ sent', said.action, said.by]);
  for (const row of done) {
    const { from_tai_ns, to_tai_ns } = row.arguments;
    const span = from_tai_ns ? `${clock(utcOf(from_tai_ns))} to ${clock(utcOf(to_tai_ns))} ` : '';
    rows.push([`✔ ${clock(utcOf(row.t_tai_ns))}`, `${row.action} ${span}${listed(row.arguments)}`, [row.by, row.note].filter(Boolean).join(': ')]);
    if (row.effect) rows.push(['', row.effect, '']);
  }
  fillTable(byId('actions'), rows.length ? rows : [['nothing done yet']]);
}
