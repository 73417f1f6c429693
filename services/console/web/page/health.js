import { byId, fillTable, number } from './text.js';

const count = value => Number.isFinite(value) ? value.toLocaleString('en-GB') : '–';

export function drawHealth(service, stale) {
  if (!service) return fillTable(byId('health'), [['nothing known yet']]);
  fillTable(byId('health'), [
    ['Status', stale ? '▲ unknown: no word from the service' : `${service.status === 'ok' ? '✔' : '▲'} ${service.status ?? '–'}`],
    ['Says', service.message || '–'],
    ['Samples received', count(service.samples_received)],
    ['Samples committed', count(service.samples_committed)],
    ['Gaps', count(service.gaps)],
    ['Duplicates', count(service.duplicates)],
    ['Queue', count(service.queue_depth)],
    ['Commit, p99', number(service.commit_p99_ms, 1, ' ms')],
    ['Version', `${service.name ?? ''} ${service.version ?? ''}`],
  ]);
}
