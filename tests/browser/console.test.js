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

const shown = async () => (await (await fetch(`${service.url}api/v1/state`)).json()).spacecraft['GMS-5'];
const stale = () => page.locator('body.stale').waitFor({ timeout: within_ms });
const fresh = (of = page) => of.locator('body:not(.stale)').waitFor({ timeout: within_ms });

before(async () => {
  service = new Service('spin/gms5');
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
  assert.equal(await text('go'), '✖ NO GO');
  assert.match(await text('against'), /no telemetry has come yet; no answer yet/);
  assert.match(await text('alerts'), /nothing known/);
});

const fill = async values => {
  for (const [name, value] of Object.entries(values)) await page.fill(`#${name}`, value);
};

test('tells what an action does and why it is refused', async () => {
  await page.click('#act');
  await page.selectOption('#action', 'exclude_segment');
  await fill({ from: '1996-01-01 00:00:10', to: '1996-01-01 00:00:00', by: 'night shift', token: service.token() });
  await page.click('#hand-send');
  assert.equal(await text('hand-sentence'), 'Leaves out all channels from 1996-01-01 00:00:10 to 1996-01-01 00:00:00 UTC: batch and ' +
    'reconstruction forget what came of it, other answers that are computed stay, for telemetry of GMS-5, by night shift. ' +
    'It is stored, and repeated after a restart.');
  await page.click('#hand-send');
  await eventually(async () => assert.match(await text('hand-said'), /^Refused \(400\): .*to_tai_ns.*must be later/));
  await page.click('#hand-cancel');
});

test('takes an action on telemetry that is to come', async () => {
  await page.click('#act');
  await page.selectOption('#action', 'set_target');
  await fill({ ra_deg: '50', dec_deg: '-80', since: '1996-01-01 00:00:00', note: 'as planned' });
  await page.press('#since', 'Enter');
  await page.press('#hand-send', 'Enter');
  await page.locator('#hand').waitFor({ state: 'hidden' });
  await eventually(async () => assert.match(await text('actions'), /(sent|00:00:00)set_target/));
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

test('shows what an operator did and how far the target is', async () => {
  await eventually(async () => assert.match(await text('actions'), /✔ 00:00:00set_target ra 50.00°, dec -80.00°night shift: as planned/));
  await eventually(async () => assert.equal(await text('figure-to-target'), `${(await shown()).to_target_deg.toFixed(2)}°`));
  // As text: a double does not hold nanoseconds. TAI was 30 s ahead of UTC.
  const done = service.row("SELECT *, CAST(t_tai_ns AS TEXT) AS t FROM operator_action WHERE by = 'night shift'");
  assert.deepEqual([done.action, JSON.parse(done.arguments), done.t],
    ['set_target', { ra_deg: 50, dec_deg: -80 }, `${Date.UTC(1996, 0) / 1e3 + 30}000000000`]);
});

test('is not go, and says all that stands against it', async () => eventually(async () => {
  const { is_go, against } = (await shown()).go;
  assert.ok(!is_go);
  assert.ok(against.some(({ code }) => code === 'target') && against.some(({ code }) => code === 'link'));
  assert.equal(await text('go'), '✖ NO GO');
  const seen = await text('against');
  for (const one of against.filter(({ code }) => code !== 'link')) assert.ok(seen.includes(one.text), `${one.text} in ${seen}`);
  assert.match(seen, /no telemetry for/);
}));

test('shows the edges of before to who comes late', async () => {
  await page.reload();
  const raster = page.locator('#raster');
  await eventually(async () => {
    const { width, height } = await raster.boundingBox();
    await page.mouse.move(0, 0);
    await raster.hover({ position: { x: width - 75, y: height - 22 } });
    assert.match(await text('raster-said'), /^sun1 \d\d:\d\d:\d\d 0.0° accepted/);
  });
});

test('tells what the edges say to the filter, and why some were left out', async () => {
  await eventually(async () => {
    await page.mouse.move(0, 0);
    assert.match(await text('residuals-note'), /^used × noise: sun1 \d+ % × \d\.\d\d, sun2 /);
  });
  const { used, noise } = (await shown()).residuals.sun1;
  assert.ok(used > 0.9 && noise > 0.8 && noise < 1.2, `${used}, ${noise}`);
  await page.focus('#raster');
  await page.keyboard.press('ArrowRight');
  const said = await text('raster-said');
  const ofLeftOut = /(rejected: \w+|left out by sequential: innovation), -?[\d.e-]+ (deg|s|sigma), (limit|at least) [\d.e-]+$/;
  if (said) assert.match(said, ofLeftOut);
  await eventually(async () => {
    assert.match(await text('series-note'), /^last 30 min, \d+ points, \d+ left out$/);
  });
  const [, count] = (await text('series-note')).match(/(\d+) left out$/);
  await page.focus('#series');
  await page.keyboard.press('ArrowLeft');
  if (count > 0) assert.match(await text('series-note'), /^\d\d:\d\d:\d\d (rejected|accepted, left out)/);
});

test('asks for the axis that was pointed at', async () => eventually(async () => {  // The axis may move between both readings.
  const { width, height } = await page.locator('#sky').boundingBox();
  const { ra_deg, dec_deg } = await shown();
  await page.locator('#sky').click({ position: {
    x: 34 + (width - 40) * (1 - ra_deg / 360), y: 6 + (height - 24) * (90 - dec_deg) / 180 } });
  const asked = [await page.inputValue('#action'), await page.inputValue('#ra_deg')];
  await page.press('#ra_deg', 'Escape');
  assert.deepEqual(asked, ['choose_root', `${Number(ra_deg.toFixed(4))}`]);
}));

test('names places on the sky wherever they lie together', { timeout: within_ms }, () => page.evaluate(async () => {
  const { drawSky } = await import('/sky.js');
  for (let dec = -90; dec <= 90; dec += 0.1) drawSky({ ra_deg: 9, dec_deg: dec, sun_ra_deg: 9, sun_dec_deg: dec });
}));

test('says beside GO what an operator has accepted, and that telemetry without an answer is no wait', async () => {
  const said = await page.evaluate(async () => {
    const { drawHeader } = await import('/header.js');
    const text = 'the table of leap seconds is old, accepted by OPS1 03:12';
    drawHeader({ state: 'live', go: { is_go: true, against: [], accepted: [{ text }] } }, { mode: 'live' }, 0, false);
    return ['go', 'against', 'quality'].map(id => document.getElementById(id).textContent);
  });
  assert.deepEqual(said.slice(0, 2), ['✔ GO', 'the table of leap seconds is old, accepted by OPS1 03:12']);
  assert.match(said[2], /NO ANSWER$/);
});

test('shows no digit finer than sigma, and the other axis only while the answer leaves it open', async () => {
  const shownOf = craft => page.evaluate(async one => {
    const { drawHeader } = await import('/header.js');
    const { drawSky } = await import('/sky.js');
    drawHeader(one, { mode: 'live' }, 0, false);
    drawSky(one);
    const other = document.getElementById('other-root');
    return [document.getElementById('figure-axis-ra-dec').textContent, other.hidden, other.textContent];
  }, { ra_deg: 100.337, dec_deg: -54.815, sigma_deg: 0.51, other_axis: { ra_deg: 80.126, dec_deg: -9.874, sigma_deg: 2.3 }, resolution: 'AMBIGUOUS', ...craft });
  assert.deepEqual((await shownOf({ quality: 'OK' })).slice(0, 2), ['100.34° / -54.81°', true]);
  assert.deepEqual(await shownOf({ quality: 'AMBIGUOUS', sigma_deg: 12 }), ['100° / -55°', false, 'Choose RA 80.1° Dec -9.9°']);
  assert.equal((await shownOf({}))[1], false);
  assert.equal((await shownOf({ quality: 'AMBIGUOUS', other_axis: null }))[1], true);
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
  const viewers = [];
  for (let i = 0; i < 12; ++i) {  // One after the other: they come while the others watch, and a slow machine starts them all.
    const viewer = await (await browser.newContext()).newPage();
    await viewer.goto(service.url, { timeout: within_ms });
    await viewer.bringToFront();
    await fresh(viewer);
    viewers.push(viewer);
  }
  for (const viewer of viewers) {
    await viewer.bringToFront();  // A page that nobody sees draws nothing.
    await eventually(async () => assert.equal(await text('figure-axis-ra-dec', viewer), await text('figure-axis-ra-dec')));
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
