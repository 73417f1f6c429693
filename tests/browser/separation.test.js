// The console in Chromium, of a separation that was replayed.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { chromium } from 'playwright-core';
import { Service } from './service.js';

let service;
let browser;
let page;

before(async () => {
  service = new Service('three-axis/separation');
  await service.start();
  browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox'] });
  page = await browser.newPage();
  await page.goto(service.url);
  await service.replay();
});

after(async () => {
  await browser?.close();
  await service?.stop();
  service?.remove();
});

test('shows the events of the archive, and the attitude in the same order of angles', async () => {
  await page.locator('#events tr', { hasText: 'T4 batch' }).waitFor({ timeout: 60_000 });
  const stored = service.row("SELECT * FROM reconstruction_event WHERE event = 'T4' AND method = 'batch'");
  const angles = [1, 2, 3].map(i => stored[`euler312_icrf_deg_${i}`]);
  const event = await page.locator('#events tr', { hasText: 'T4 batch' }).textContent();
  assert.ok(event.includes(angles.map(angle => angle.toFixed(2)).join('  ')), `${angles} in ${event}`);
  const shown = await page.evaluate(async q => (await import('/attitude.js')).euler312(q),
    [stored.qx, stored.qy, stored.qz, stored.qw]);
  shown.forEach((angle, i) => assert.ok(Math.abs(angle - angles[i]) < 1e-9, `${shown} and ${angles}`));
});

test('tells what the sensors say to the filter', async () => {
  await page.locator('#residuals-note', { hasText: /^used × noise: sun \d+ % × \d\.\d\d/ }).waitFor({ timeout: 20_000 });
});
