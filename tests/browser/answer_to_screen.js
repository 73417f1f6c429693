// node answer_to_screen.js URL ARCHIVE SECONDS: time from the announcement of an axis to the frame of Chromium that shows it.
import { execFileSync } from 'node:child_process';
import { setTimeout as sleep } from 'node:timers/promises';
import { chromium } from 'playwright-core';

const [url, archive, seconds] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox'] });
const page = await browser.newPage({ viewport: { width: 1366, height: 768 } });
await page.goto(url);
await sleep(5000);
const shown = await page.evaluate(ms => new Promise(done => {
  const seen = [];
  const look = () => {
    const [, estimator, time] = document.querySelector('header').innerText.match(/(\w+) at (\d\d:\d\d:\d\d)Z/) ?? [];
    if (time && time !== seen.at(-1)?.time) seen.push({ estimator, time, at_ms: Date.now() });
  };
  const frames = () => { look(); requestAnimationFrame(frames); };
  frames();
  setTimeout(() => done(seen), ms);
}), seconds * 1e3);
await browser.close();

const announced = new Map(JSON.parse(execFileSync('sqlite3', ['-readonly', '-json', archive,
  `SELECT estimator, announced_utc, strftime('%H:%M:%S', t_tai_ns / 1000000000 - tai_minus_utc_s, 'unixepoch') AS time
   FROM spin_estimate, (SELECT tai_minus_utc_s FROM leap_second ORDER BY start_tai_ns DESC LIMIT 1)`], { encoding: 'utf8' }))
  .map(row => [`${row.estimator} ${row.time}`, Date.parse(row.announced_utc)]));
// The first was on the page already.
const took_ms = shown.slice(1).map(one => one.at_ms - announced.get(`${one.estimator} ${one.time}`)).filter(Number.isFinite).sort((a, b) => a - b);
const at = share => took_ms[Math.ceil(share * (took_ms.length - 1))]?.toFixed(0);
console.log(`${took_ms.length} of ${shown.length - 1} answers: median ${at(0.5)} ms, 99 % ${at(0.99)} ms, most ${at(1)} ms`);
