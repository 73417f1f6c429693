// node viewers.js URL PID SECONDS: what twenty viewers, who ask for what the page asks for, cost the service that is process PID.
import { readFileSync } from 'node:fs';
import { get } from 'node:http';
import { setTimeout as sleep } from 'node:timers/promises';

const [url, pid, seconds] = process.argv.slice(2);
const ticks_s = 100;
const shown = [['sun_angle'], ['rate_x_deg_s', 'innovation']];

const cpu_s = () => readFileSync(`/proc/${pid}/stat`, 'utf8').replace(/.*\) /, '').split(' ').slice(11, 13)
  .reduce((sum, ticks) => sum + Number(ticks), 0) / ticks_s;
const json = async path => (await fetch(new URL(path, url))).json();

async function share() {
  const [begin_s, begin] = [cpu_s(), performance.now()];
  await sleep(seconds * 1e3);
  return 100 * (cpu_s() - begin_s) / ((performance.now() - begin) / 1e3);
}

let asked = 0;
async function view(number) {
  get(new URL('api/v1/events', url), answer => answer.resume());
  for (;;) {
    const { spacecraft } = await json('api/v1/state');
    const all = Object.entries(spacecraft);
    const [id, { kind, t_tai_ns: t }] = all[number % all.length];
    for (const quantity of shown[kind === 'three_axis' ? 1 : 0]) {
      await json(`api/v1/series?spacecraft=${id}&quantity=${quantity}&from=${BigInt(t - 1800e9)}&to=${BigInt(t)}&points=800`);
      ++asked;
    }
    await sleep(5000);
  }
}

const alone = await share();
for (let i = 0; i < 20; ++i) view(i);
const watched = await share();
console.log(`without viewers ${alone.toFixed(1)} % of a core, with twenty ${watched.toFixed(1)} %; ${asked} series`);
process.exit();
