// The open alerts: those of the spacecraft that is shown first, of them those that nobody has taken up, then most severe first.
import { byId, clock, element, sign } from './text.js';
import { ask, field } from './hand.js';

const order = ['critical', 'warning', 'info'];
const states = ['active', 'acknowledged', 'shelved'];
let shown = '';

function evidenceOf(alert) {
  try {
    return typeof alert.evidence === 'string' ? JSON.parse(alert.evidence) : alert.evidence ?? {};
  } catch {
    return {};
  }
}

const words = { ack: 'Acknowledge', shelve: 'Shelve' };

function askAlert(alert, verb) {
  ask({
    title: `${words[verb]} ${alert.key}`,
    path: `/api/v1/alerts/${encodeURIComponent(alert.alert_id)}/${verb}`,
    fields: verb === 'shelve' ? [field('Minutes', 'minutes', { type: 'number', min: 1, max: 10080, value: 15 })] : [],
    body: ({ minutes, ...said }) => minutes ? { ...said, minutes: Number(minutes) } : said,
  });
}

function made(alert, utcOf) {
  const [icon, colour] = sign(alert.severity);
  const article = element('article', undefined, colour);
  const { since_tai_ns } = evidenceOf(alert);
  article.append(
    element('strong', `${icon} ${alert.severity.toUpperCase()} ${alert.spacecraft} ${alert.key}`),
    element('p', alert.message),
    element('p', `${alert.state}${alert.state === 'shelved' ? ` until ${clock(utcOf(alert.shelved_until_tai_ns))}` : ''
    }; began ${clock(utcOf(since_tai_ns ?? alert.raised_tai_ns))}`));
  for (const [verb, word] of Object.entries(words)) {
    if (verb === 'ack' && alert.state !== 'active') continue;
    const button = element('button', word);
    button.setAttribute('aria-label', `${word} ${alert.key}`);
    button.dataset.of = `${verb} ${alert.alert_id}`;
    button.addEventListener('click', () => askAlert(alert, verb));
    article.append(button);
  }
  return article;
}

// Made anew only when they changed, with the focus kept: a key pressed on a button must hit it.
export function drawAlerts(alerts, spacecraft, known, utcOf) {
  const text = JSON.stringify(alerts) + spacecraft + known;
  if (text === shown) return;
  shown = text;
  const list = byId('alerts');
  const focused = list.contains(document.activeElement) ? document.activeElement.dataset.of : undefined;
  const sorted = [...alerts].sort((a, b) => (b.spacecraft === spacecraft) - (a.spacecraft === spacecraft) || states.indexOf(a.state) - states.indexOf(b.state)
    || order.indexOf(a.severity) - order.indexOf(b.severity));
  list.replaceChildren(...sorted.map(alert => made(alert, utcOf)));
  if (!sorted.length) list.append(element('p', known ? 'no open alerts' : 'nothing known before the first telemetry', 'dim'));
  if (focused) [...list.querySelectorAll('button')].find(button => button.dataset.of === focused)?.focus();
  byId('alerts-title').textContent = sorted.length ? `Alerts (${sorted.length})` : 'Alerts';
}
