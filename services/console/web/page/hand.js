// Asks who says so, why, and for the token, which stays in this page's memory, and sends it.
import { byId, element } from './text.js';

let asked = null;

export function field(word, name, attributes = {}) {
  const label = element('label', `${word} `);
  const input = element(attributes.options ? 'select' : 'input');
  input.id = input.name = name;
  const { options = [], ...rest } = attributes;
  input.append(...options.map(([value, text]) => {
    const option = element('option', text);
    option.value = value;
    return option;
  }));
  Object.assign(input, { required: true, autocomplete: 'off', ...rest });
  label.append(input);
  return label;
}

const values = () => Object.fromEntries(new FormData(byId('hand-form')));

function stage(confirming) {
  byId('hand-asks').disabled = confirming;
  byId('hand-back').hidden = !confirming;
  byId('hand-send').textContent = asked.sentence && !confirming ? 'Review' : 'Send';
  byId('hand-sentence').textContent = confirming ? asked.sentence(asked.values) : '';
}

// `path`: where to send to. `fields`: what is asked for besides. `body`: what is sent, of the form's values.
// `sentence`: what that does, to be confirmed; without it, it is sent at once. `taken`: told the service's answer.
export function ask(question) {
  asked = question;
  byId('hand-title').textContent = question.title;
  byId('hand-fields').replaceChildren(...question.fields);
  byId('hand-said').textContent = '';
  byId('note').value = '';
  stage(false);
  byId('hand').showModal();
  (byId('hand-fields').querySelector('select, input') ?? byId('by')).focus();
}

// Other fields, of the same question.
export function askFor(fields) { byId('hand-fields').replaceChildren(...fields); }

async function send({ token, ...said }) {
  try {
    const answer = await fetch(asked.path, {
      method: 'POST',
      headers: { Authorization: `Bearer ${token}`, 'Content-Type': 'application/json' },
      body: JSON.stringify(asked.body(said)),
    });
    if (answer.ok) {
      asked.taken?.(await answer.json(), said);
      byId('hand').close();
      return '';
    }
    if (answer.status !== 401) return `Refused (${answer.status}): ${(await answer.json()).error}`;
    byId('token').value = '';
    return 'Wrong token: nothing was changed.';
  } catch (error) {
    return `The service gave no answer (${error.message}): it is not known whether anything was changed.`;
  }
}

byId('hand-form').addEventListener('submit', async event => {
  event.preventDefault();
  const confirming = byId('hand-asks').disabled;
  if (!confirming) asked.values = values();
  byId('hand-said').textContent = '';
  if (asked.sentence && !confirming) {
    stage(true);
    return byId('hand-send').focus();
  }
  byId('hand-send').disabled = true;
  const said = await send(asked.values);
  byId('hand-send').disabled = false;
  if (said) stage(false);
  byId('hand-said').textContent = said;
});
byId('hand-back').addEventListener('click', () => stage(false));
byId('hand-cancel').addEventListener('click', () => byId('hand').close());
