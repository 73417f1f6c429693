// The console in Chromium, of a running service and a replayed pass.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { chromium } from 'playwright-core';
import { Service } from './service.js';

const within_ms = 60_000;
let service;
let browser;
let page;
const complaints = [];

const text = (id, of = page) => of.locator(`#${id}`).textContent();

// Waits for `holds`; the last failure is the test's.
async function eventually(holds) {
  const end = Date.now() + within_ms;
  for (;;) {
    try {
      return await holds();
    } catch (error) {
      if (Date.now() > end) throw error;
      await new Promise(done => setTimeout(done, 200));
    }
  }
}

const stale = () => page.locator('body.stale').waitFor({ timeout: within_ms });
const fresh = (of = page) => of.locator('body:not(.stale)').waitFor({ timeout: within_ms });

before(async () => {
  service = new Service();
  await service.start();
  browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox'] });
  page = await browser.newPage({ viewport: { width: 1366, height: 768 } });
  page.on('pageerror', error => complaints.push(error.message));
  page.on('console', message => {
    if (/Content Security Policy/.test(message.text())) complaints.push(message.text());
  });
  await page.goto(service.url);
});

after(async () => {
  await browser?.close();
  await service?.stop();
  service?.remove();
});

test('says nothing good before the first telemetry', async () => {
  await fresh();
  assert.equal(await text('quality'), '○ WAITING');
  assert.match(await text('alerts'), /nothing known/);
});

test('shows the values of the archive', async () => {
  await service.replay();
  await eventually(async () => {
    const verdict = service.row('SELECT * FROM pass_verdict');
    assert.ok(verdict.ra_deg !== null, 'no axis in the archive yet');
    assert.equal(await text('figure-axis-ra-dec'), `${verdict.ra_deg.toFixed(3)}° / ${verdict.dec_deg.toFixed(3)}°`);
    assert.ok((await text('quality')).endsWith(` ${verdict.quality}`));
    assert.ok((await text('why')).endsWith(verdict.why));
    const rate = service.row(`SELECT spin_rate_rpm FROM pass_answer WHERE estimator = '${verdict.estimator}'`);
    assert.ok((await text('figure-spin-rate')).startsWith(rate.spin_rate_rpm.toFixed(4)));
  });
});

test('needs no scrolling at 1366x768 and on a tablet', async () => {
  for (const [width, height] of [[1366, 768], [1024, 768]]) {
    await page.setViewportSize({ width, height });
    const [w, h] = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]);
    assert.ok(w <= width && h <= height, `${w}x${h} on ${width}x${height}`);
  }
});

test('tells a wrong token from the right one', async () => {
  const acknowledge = page.locator('#alerts button', { hasText: 'Acknowledge' }).first();
  await acknowledge.click({ timeout: within_ms });
  await page.fill('#by', 'night shift');
  await page.fill('#token', 'wrong');
  await page.press('#token', 'Enter');
  await eventually(async () => assert.match(await text('hand-said'), /^Wrong token/));
  await page.fill('#token', service.token());
  await page.press('#token', 'Enter');
  await page.locator('#hand').waitFor({ state: 'hidden' });
  await page.locator('#alerts article', { hasText: 'acknowledged' }).first().waitFor({ timeout: within_ms });
  assert.equal(service.row("SELECT count(*) AS n FROM alert_transition WHERE by = 'night shift'").n, 1);
});

test('serves twelve viewers at once', async () => {
  const viewers = await Promise.all(Array.from({ length: 12 }, async () => {
    const context = await browser.newContext();
    const viewer = await context.newPage();
    await viewer.goto(service.url);
    await fresh(viewer);
    return viewer;
  }));
  const axis = await text('figure-axis-ra-dec');
  for (const viewer of viewers) {
    await eventually(async () => assert.equal(await text('figure-axis-ra-dec', viewer), axis));
    await viewer.context().close();
  }
});

test('goes stale by itself when the service stops, and fresh when it goes on', async () => {
  service.signal('SIGSTOP');
  await stale();
  assert.match(await text('stale'), /STALE: no word from the service for/);
  assert.equal(await text('figure-link'), '▲ UNKNOWN');
  service.signal('SIGCONT');
  await fresh();
});

test('connects again by itself to a service that was started again', async () => {
  assert.equal(await service.stop(), 0);
  await stale();
  await service.start(new URL(service.url).host);
  await fresh();
});

test('breaks no rule of the content security policy and has no error', () => assert.deepEqual(complaints, []));
