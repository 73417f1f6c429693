// Acknowledge and shelve: asks who, why and for the token, which stays in this page's memory.
import { byId } from './text.js';

let token = '';
let send = null;

export function ask(alert, verb) {
  byId('hand-title').textContent = `${verb === 'ack' ? 'Acknowledge' : 'Shelve'} ${alert.key}`;
  byId('minutes-label').hidden = verb === 'ack';
  byId('minutes').disabled = verb === 'ack';
  byId('hand-said').textContent = '';
  byId('token').value = token;
  send = () => post(alert, verb);
  byId('hand').showModal();
  byId('by').focus();
}

async function post(alert, verb) {
  const body = { by: byId('by').value, note: byId('note').value };
  if (verb === 'shelve') body.minutes = Number(byId('minutes').value);
  token = byId('token').value;
  let said;
  try {
    const answer = await fetch(`/api/v1/alerts/${encodeURIComponent(alert.alert_id)}/${verb}`, {
      method: 'POST',
      headers: { Authorization: `Bearer ${token}`, 'Content-Type': 'application/json' },
      body: JSON.stringify(body),
    });
    if (answer.ok) return byId('hand').close();
    said = answer.status === 401 ? 'Wrong token: nothing was changed.'
      : `Refused (${answer.status}): ${(await answer.json()).error}`;
    if (answer.status === 401) token = '';
  } catch (error) {
    said = `The service gave no answer (${error.message}): it is not known whether anything was changed.`;
  }
  byId('hand-said').textContent = said;
}

byId('hand-form').addEventListener('submit', event => {
  event.preventDefault();
  send?.();
});
byId('hand-cancel').addEventListener('click', () => byId('hand').close());
