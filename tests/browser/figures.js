// node figures.js URL MINUTES [SPACECRAFT]: what the console at URL costs a browser.
import { setTimeout as sleep } from 'node:timers/promises';
import { chromium } from 'playwright-core';

const [url, minutes, spacecraft] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox'] });
const page = await browser.newPage({ viewport: { width: 1366, height: 768 } });
const system = await browser.newBrowserCDPSession();
const inside = await page.context().newCDPSession(page);
await inside.send('Performance.enable');

async function figures() {
  await inside.send('HeapProfiler.collectGarbage');
  const { metrics } = await inside.send('Performance.getMetrics');
  const of = name => metrics.find(metric => metric.name === name).value;
  const { processInfo } = await system.send('SystemInfo.getProcessInfo');
  return { at_s: performance.now() / 1e3, tasks_s: of('TaskDuration'), heap_mb: of('JSHeapUsedSize') / 1e6, nodes: of('Nodes'),
    cpu_s: processInfo.reduce((sum, { cpuTime }) => sum + cpuTime, 0),
    page_s: processInfo.filter(({ type }) => type === 'renderer').reduce((sum, { cpuTime }) => sum + cpuTime, 0) };
}

await page.goto(url);
const [paint_ms, files] = await page.evaluate(() => [performance.getEntriesByName('first-contentful-paint')[0]?.startTime,
  performance.getEntries().filter(({ encodedBodySize, name }) => encodedBodySize && !name.includes('/api/'))
    .map(({ encodedBodySize }) => encodedBodySize)]);
console.log(`first contentful paint ${paint_ms?.toFixed(0)} ms; ${files.length} files, ${files.reduce((sum, size) => sum + size, 0)} bytes`);
if (spacecraft) await page.selectOption('#spacecraft', spacecraft);
await sleep(5000);
for (let last = await figures(), minute = 1; minute <= minutes; ++minute) {
  await sleep(60_000);
  const now = await figures();
  const share = name => `${(100 * (now[name] - last[name]) / (now.at_s - last.at_s)).toFixed(1)} %`;
  console.log(`${minute} min: tasks ${share('tasks_s')}, page's process ${share('page_s')}, all of Chromium ${share('cpu_s')} of a core; heap ${
    now.heap_mb.toFixed(1)} MB, ${now.nodes} nodes`);
  last = now;
}
await browser.close();
