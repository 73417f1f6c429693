// Texts of values. What is absent is a dash, never a zero.

export const byId = id => document.getElementById(id);

// The texts of telemetry come in here, and leave as text nodes.
export function element(name, text, className) {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  return made;
}

export const number = (value, digits, unit = '') =>
  Number.isFinite(value) ? `${value.toFixed(digits)}${unit}` : '–';

// No finer than two significant digits of its sigma.
export const withinSigma = (value, most, sigma, unit = '') =>
  number(value, sigma > 0 ? Math.min(most, Math.max(0, 1 - Math.floor(Math.log10(sigma)))) : most, unit);

// Two significant digits of a sigma, so that a small one is no zero.
export function sigma(value, unit = '°') {
  if (!Number.isFinite(value)) return '–';
  const digits = value >= 10 ? value.toFixed(0) : value < 1e-4 ? value.toExponential(1) : Number(value.toPrecision(2));
  return `${digits}${unit}`;
}

export function duration(seconds) {
  if (!Number.isFinite(seconds)) return '–';
  if (seconds < 100) return `${seconds.toFixed(seconds < 10 ? 1 : 0)} s`;
  if (seconds < 6000) return `${(seconds / 60).toFixed(0)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}

export const clock = utc_s => Number.isFinite(utc_s) ? new Date(utc_s * 1e3).toISOString().slice(11, 19) : '–';

// Word, icon and colour of a quality, a state of a link or a severity: `[icon, class]`.
const signs = {
  OK: ['✔', 'good'], CONVERGING: ['◔', 'warn'], AMBIGUOUS: ['⇄', 'warn'], DOUBTFUL: ['▲', 'warn'], LOST: ['✖', 'bad'],
  live: ['●', 'good'], stale: ['✖', 'bad'], waiting: ['○', 'dim'], unknown: ['▲', 'bad'],
  info: ['ℹ', 'dim'], warning: ['▲', 'warn'], critical: ['✖', 'bad'],
};
export const sign = word => signs[word] ?? ['○', 'dim'];

// One row a pair of name and text.
export function fillTable(table, rows) {
  table.replaceChildren(...rows.map(cells => {
    const row = element('tr');
    row.append(...cells.map((cell, i) => element(i ? 'td' : 'th', cell)));
    return row;
  }));
}
