// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

// Uses the web pages as their readers do, in Chromium, at the sizes of a desk and of a phone:
//   node page_test.mjs FOLDER [SCREENSHOTS]
// FOLDER is what make_pages wrote.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, statSync } from 'node:fs';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const [folder, screenshots] = process.argv.slice(2);
const executablePath = process.env.CHROMIUM || ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);
if (!executablePath) {
  console.log('SKIPPED: the tests of the web page need Chromium (Debian: chromium)');
  process.exit(77);
}
if (screenshots) mkdirSync(screenshots, { recursive: true });

const browser = await chromium.launch({
  executablePath,
  args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-sync'],
});

const kDesk = { viewport: { width: 1440, height: 900 } };
const kPhone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true };

/** A page that fails the test on any error of its script and on any request that leaves the file. */
async function open(name, { device = kDesk, scheme = 'light', hash = '' } = {}) {
  const context = await browser.newContext({ ...device, colorScheme: scheme });
  const page = await context.newPage();
  page.faults = [];
  page.on('pageerror', error => page.faults.push(String(error.stack)));
  page.on('console', message => { if (message.type() === 'error') page.faults.push(message.text()); });
  page.on('request', request => { if (/^(https?|wss?|ftp):/.test(request.url())) page.faults.push('asks for ' + request.url()); });
  await page.goto(pathToFileURL(resolve(folder, name)).href + hash);
  return page;
}

async function close(page, picture) {
  if (screenshots && picture) await page.screenshot({ path: resolve(screenshots, picture + '.png') });
  assert.deepEqual(page.faults, []);
  await page.context().close();
}

const heading = page => page.locator('#panel h2').first().textContent();
const hash = page => new URL(page.url()).hash;
/** What a switch changes: the pixels of the canvas. */
const painted = page => page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() =>
  done(document.querySelector('#map canvas').toDataURL())))));
const toggle = (page, name) => page.locator(`[data-switch="${name}"]`).click();

const tests = {
  async 'a click on a node shows what it holds and names it in the address'() {
    const page = await open('house.html', { hash: '#node=s3' });
    await page.keyboard.press('Escape');
    assert.equal(await page.locator('#panel').isHidden(), true);
    assert.equal(hash(page), '#floor=0');
    await page.evaluate(() => { location.hash = '#node=s3'; });
    await page.waitForSelector('#panel:not([hidden])');
    assert.equal(await heading(page), 's3');
    for (const text of ['Sub-map · place 1 · floor 0', 'Readings', '147', 'Neighbours', 'Occupancy grid', 'Points']) {
      assert.ok((await page.locator('#panel').textContent()).includes(text), text);
    }
    assert.ok(await page.locator('#panel .thumb img').evaluate(image => image.decode().then(() => image.naturalWidth > 0)));
    await page.locator('#panel [data-id="s1"]').click();
    assert.equal(await heading(page), 's1');
    assert.equal(hash(page), '#node=s1&floor=0');
    await close(page, 'desk');
  },

  async 'a click on the map picks the nearest thing, one beside it nothing'() {
    const page = await open('house.html', { hash: '#node=s4' });
    // The link has put s4 in the middle of what the cards leave free.
    const spot = await page.evaluate(() => {
      const [side, panel] = ['side', 'panel'].map(id => document.getElementById(id).getBoundingClientRect());
      return { x: (side.right + panel.left) / 2, y: (24 + innerHeight - 44) / 2 };
    });
    await page.mouse.click(spot.x, spot.y - 330);
    assert.equal(await page.locator('#panel').isHidden(), true, 'nothing lies there');
    await page.mouse.click(spot.x, spot.y);
    assert.equal(await heading(page), 's4');
    await close(page);
  },

  async 'switches change the picture, and back'() {
    const page = await open('house.html');
    for (const name of ['graph', 'labels', 'refined', 'travelled', 'doors', 'stairs', 'entities', 'predictions']) {
      const before = await painted(page);
      await toggle(page, name);
      assert.notEqual(await painted(page), before, name);
      await toggle(page, name);
      assert.equal(await painted(page), before, name + ' again');
    }
    const images = () => page.locator('.leaflet-plan-pane img').count();
    assert.equal(await images(), 1);
    await toggle(page, 'plan');
    assert.equal(await images(), 0);
    await toggle(page, 'layer:points');
    assert.equal(await images(), 1);
    await close(page);
  },

  async 'a deep link opens floor and thing'() {
    const page = await open('house.html', { hash: '#node=s5&floor=1' });
    assert.equal(await heading(page), 's5');
    assert.equal(await page.locator('#floors [aria-checked="true"]').textContent(), '1');
    await page.locator('#floors button', { hasText: '0' }).click();
    assert.equal(hash(page), '#node=s5&floor=0');
    await close(page);
    const entity = await open('house.html', { hash: '#entity=o4' });
    assert.equal(await heading(entity), 'Staircase');
    await close(entity);
    const unknown = await open('house.html', { hash: '#node=s99' });
    assert.equal(await unknown.locator('#panel').isHidden(), true);
    await close(unknown);
  },

  async 'edges and predictions say what they are'() {
    const page = await open('house.html', { hash: '#edge=e2' });
    assert.match(await page.locator('#panel').textContent(), /Door edge.*Length.*Joins.*s1.*s3.*Through.*o1/);
    await close(page);
    const bet = await open('house.html', { hash: '#prediction=p1', scheme: 'dark' });
    assert.match(await bet.locator('#panel').textContent(), /Prediction · open.*82 %.*17.5 m²/);
    await close(bet, 'prediction-dark');
  },

  async 'search finds ids, classes and places, by keyboard alone'() {
    const page = await open('house.html');
    await page.keyboard.press('/');
    await page.keyboard.type('door');
    assert.ok(await page.locator('#found li').count() >= 3);
    await page.keyboard.press('Escape');
    await page.keyboard.press('/');
    await page.keyboard.type('4');
    await page.keyboard.press('Enter');
    assert.equal(await heading(page), 's4');
    await page.keyboard.press(']');
    assert.equal(await heading(page), 's5');
    await page.keyboard.press('[');
    assert.equal(await heading(page), 's4');
    await page.keyboard.press('/');
    await page.keyboard.type('zebra');
    assert.equal(await page.locator('#found').textContent(), 'Nothing of that name');
    await close(page);
  },

  async 'zooms by button, wheel and key, and fits again'() {
    const page = await open('house.html');
    const scale = () => page.locator('.leaflet-control-scale-line').textContent();
    const whole = await scale();
    for (let i = 0; i < 4; ++i) { await page.locator('#zoom-in').click(); await page.waitForTimeout(350); }
    assert.notEqual(await scale(), whole);
    await page.keyboard.press('f');
    await page.waitForTimeout(500);
    assert.equal(await scale(), whole);
    await page.mouse.move(700, 450);
    for (let i = 0; i < 6; ++i) { await page.mouse.wheel(0, -240); await page.waitForTimeout(120); }
    await page.waitForTimeout(400);
    assert.notEqual(await scale(), whole);
    await close(page);
  },

  async 'on a phone a sheet rises from below, and fingers find every button'() {
    const page = await open('house.html', { device: kPhone, hash: '#node=s3' });
    const sheet = await page.locator('#panel').boundingBox();
    assert.ok(sheet.y > 300 && sheet.width === 390 && sheet.y + sheet.height <= 845);
    const small = await page.evaluate(() => [...document.querySelectorAll('button, .switch, input[type=text]')]
      .filter(target => target.offsetParent !== null)
      .map(target => [target.id || target.ariaLabel || target.textContent, target.getBoundingClientRect()])
      .filter(([, box]) => box.width < 40 || box.height < 40).map(([name]) => name));
    assert.deepEqual(small, []);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
    await close(page, 'phone');
    const layers = await open('house.html', { device: kPhone });
    await layers.locator('#layers-button').click();
    await layers.locator('[data-switch="travelled"]').click();
    await close(layers, 'phone-layers');
  },

  async 'controls have names'() {
    const page = await open('house.html', { hash: '#node=s2' });
    const nameless = await page.evaluate(() => [...document.querySelectorAll('button, input, [role=radio]')]
      .filter(target => target.offsetParent !== null && !(target.ariaLabel || target.textContent.trim() || target.closest('label')?.textContent.trim())).map(target => target.outerHTML));
    assert.deepEqual(nameless, []);
    await close(page);
  },

  async 'an empty map says so'() {
    const page = await open('empty.html');
    assert.equal(await page.locator('#empty').isVisible(), true);
    await close(page, 'empty');
  },

  async 'a thousand sub-maps stay below 20 MB and open quickly'() {
    const megabytes = statSync(resolve(folder, 'large.html')).size / 1e6;
    const begin = Date.now();
    const page = await open('large.html');
    await painted(page);
    const seconds = (Date.now() - begin) / 1000;
    console.log(`     1,000 sub-maps: ${megabytes.toFixed(1)} MB, shown after ${seconds.toFixed(1)} s`);
    assert.ok(megabytes < 20);
    assert.ok(seconds < 20);
    await close(page, 'large');
  },

  async 'a page that follows comes back as it was left'() {
    const page = await open('follow.html', { hash: '#node=s4' });
    await toggle(page, 'labels');
    for (let i = 0; i < 2; ++i) await page.locator('#zoom-in').click();
    await page.waitForTimeout(700);  // until the zoom has come to rest
    const view = () => page.evaluate(() => [document.querySelector('.leaflet-control-scale-line').textContent, document.querySelector('[data-switch=labels]').checked,
      document.querySelector('#panel h2').textContent]);
    await page.evaluate(() => { window.sameLoad = true; });
    const before = await view();
    await page.waitForFunction(() => !window.sameLoad, null, { timeout: 15000 });
    await page.waitForSelector('#panel:not([hidden])');
    assert.deepEqual(await view(), before);
    await page.locator('#live').click();
    assert.equal(await page.locator('#live').textContent(), 'paused');
    await close(page);
  },
};

let failed = 0;
for (const [name, run] of Object.entries(tests)) {
  try {
    await run();
    console.log('ok   ' + name);
  } catch (error) {
    ++failed;
    console.log('FAIL ' + name + '\n' + error.stack);
  }
}
await browser.close();
console.log(failed ? `${failed} of ${Object.keys(tests).length} failed` : `all ${Object.keys(tests).length} passed`);
process.exit(failed ? 1 : 0);
