// The page of `muslin view` in a real browser, from the disk, without a network.
import assert from 'node:assert/strict';
import { appendFileSync, cpSync, existsSync, mkdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Scratch, launch, muslin, open, readPc2, run, source } from './support.js';

let browser;
const scratch = new Scratch();

/** Two bodies (a lattice with pins and a keyed point force, a shell), gravity, wind. */
const scene = `
title = "Two </script> & \\"friends\\""
[time]
duration = 1
steps_per_frame = 2
[[body]]
name = "flag"
mesh = "${join(source, 'scenes/meshes/flag.obj')}"
thickness = 1.0
voxel_width = 1.0
material = "thesis_flag"
contact = false
colour = [0.8, 0.1, 0.1]
[[body]]
name = "a napkin"
mesh = "${join(source, 'scenes/meshes/napkin.obj')}"
model = "shell"
material = "cotton"
contact = false
scale = [8, 8, 8]
translate = [5, -3, 4]
colour = [0.1, 0.7, 0.2]
[[pin]]
name = "corner"
body = "flag"
where = { line = { from = [0, 6, -1], to = [0, 6, 1] } }
until = 0.5
[[pin]]
name = "napkin corners"
body = "a napkin"
where = { nearest = [[3.4, -3, 2.4], [6.6, -3, 2.4]] }
[[force]]
type = "gravity"
[[force]]
type = "wind"
name = "breeze"
velocity = [0, 0, 3]
[[force]]
type = "point"
name = "pull"
body = "flag"
where = { nearest = [10, 6, 0.5] }
keyframes = [{ time = 0, value = [0, 0, 0] }, { time = 1, value = [100, 0, 0] }]
`;

before(async () => {
  writeFileSync(scratch.at('scene.toml'), scene);
  run('run', scratch.at('scene.toml'), '-o', scratch.at('run'), '--quiet');
  run('view', scratch.at('run'), '-o', scratch.at('page.html'), '--quiet');
  browser = await launch();
}, { timeout: 600000 });

after(async () => {
  await browser?.close();
  scratch.remove();
});

/** Opens the page of the two bodies, hands it over, and wants no complaint in the end. */
async function withPage(options, look) {
  const page = await open(browser, options.file ?? scratch.at('page.html'), options);
  try {
    await look(page);
    assert.deepEqual(page.complaints, []);
  } finally {
    await page.context().close();
  }
}

/** Draws now and counts the pixels of the picture that are clearly red, and clearly green. */
const countPixels = (page) => page.evaluate(() => {
  window.muslin.stage.invalidate();
  window.muslin.draw();
  const view = document.getElementById('view');
  const copy = new OffscreenCanvas(view.width, view.height);
  const g = copy.getContext('2d');
  g.drawImage(view, 0, 0);
  const { data } = g.getImageData(0, 0, view.width, view.height);
  const count = { red: 0, green: 0 };
  for (let i = 0; i < data.length; i += 4) {
    const [r, g8, b, a] = data.subarray(i, i + 4);
    if (a < 200) continue;
    if (r > 1.8 * g8 && r > 1.8 * b) ++count.red;
    if (g8 > 1.3 * r && g8 > 1.3 * b) ++count.green;
  }
  return count;
});

const shownFrame = (page) => page.evaluate(() => window.muslin.clock.frame);
const seek = (page, index) => page.evaluate((i) => {
  window.muslin.clock.stopAt(i);
  window.muslin.refresh();
  window.muslin.draw();
}, index);

test('loads from the disk, draws every body, and its title is only text', () => withPage({}, async (page) => {
  assert.equal(await page.title(), 'Two </script> & "friends"');
  assert.equal(await page.locator('h1').textContent(), 'Two </script> & "friends"');
  await page.keyboard.press('l');
  assert.deepEqual(await page.locator('#bodies label').allTextContents(), ['flag', 'a napkin']);
  const pixels = await countPixels(page);
  assert.ok(pixels.red > 3000, `red pixels of the flag: ${pixels.red}`);
  assert.ok(pixels.green > 1000, `green pixels of the napkin: ${pixels.green}`);
  await page.locator('#bodies input').nth(1).uncheck();
  assert.ok((await countPixels(page)).green < pixels.green / 20);
}));

test('shows the positions of the cache within half a step', () => withPage({}, async (page) => {
  const bodies = [['flag', 'skin'], ['flag', 'contour'], ['flag', 'lattice'], ['a napkin', 'skin']];
  for (const [index, [name, kind]] of bodies.entries()) {
    const cache = readPc2(scratch.at(`run/${name}.${kind}.pc2`));
    assert.equal(cache.samples, 25);
    for (const frame of [0, 1, 2, 13, 24]) {
      await page.evaluate((k) => window.muslin.setSurface(k), kind);
      await seek(page, frame);
      const shown = await page.evaluate((b) => {
        const { surface } = window.muslin.bodies[b];
        return {
          points: Array.from(surface.shape.points),
          places: Array.from(surface.geometry.attributes.position.array),
          step: surface.track.step,
          count: surface.track.count,
        };
      }, index === 3 ? 1 : 0);
      assert.equal(shown.count, cache.points);
      assert.equal(new Set(shown.points).size, cache.points); // every point of the cache is drawn
      const truth = cache.at(frame);
      shown.points.forEach((point, vertex) => {
        for (let axis = 0; axis < 3; ++axis) {
          const x = truth[3 * point + axis];
          const off = Math.abs(shown.places[3 * vertex + axis] - x);
          const most = 0.5 * shown.step[axis] + 1e-6 * Math.max(1, Math.abs(x));
          assert.ok(off <= most, `${name}.${kind}, frame ${frame}, point ${point}: off by ${off}, allowed ${most}`);
        }
      });
    }
  }
}));

test('plays, pauses, steps, scrubs, by mouse and by keys', () => withPage({}, async (page) => {
  assert.equal(await shownFrame(page), 0);
  await page.locator('#play').click();
  await page.waitForFunction(() => window.muslin.clock.frame > 3);
  await page.waitForFunction(() => window.muslin.clock.frame < 3); // around, for it loops
  await page.keyboard.press('k');
  const stopped = await shownFrame(page);
  await page.waitForTimeout(150);
  assert.equal(await shownFrame(page), stopped);
  await page.keyboard.press('Home');
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Shift+ArrowRight');
  assert.equal(await shownFrame(page), 11);
  await page.keyboard.press('ArrowLeft');
  assert.equal(await shownFrame(page), 10);
  await page.keyboard.press('End');
  assert.match(await page.locator('#now').textContent(), /^24 \/ 24 . 1\.00 s$/);
  await page.locator('#time').fill('7');
  assert.equal(await shownFrame(page), 7);
  assert.equal(await page.locator('#time').getAttribute('aria-valuetext'), 'frame 7, 0.29 seconds');
  const box = await page.locator('#time').boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  assert.equal(await shownFrame(page), 12);
  await page.keyboard.press('.');
  await page.waitForFunction(() => document.getElementById('speed').textContent === '2\u00d7');
  await page.locator('#loop').click();
  await page.waitForFunction(() => document.getElementById('loop').getAttribute('aria-pressed') === 'false');
}));

test('begins to play by itself, unless the viewer wants less motion', async () => {
  await withPage({ hash: '' }, (page) => page.waitForFunction(() => window.muslin.clock.frame > 2));
  await withPage({ hash: '', reducedMotion: 'reduce' }, async (page) => {
    await page.waitForTimeout(200);
    assert.equal(await shownFrame(page), 0);
  });
});

test('the picture changes with time', () => withPage({}, async (page) => {
  await page.evaluate(() => window.muslin.stage.setGround(false));
  const pictures = [];
  for (const frame of [0, 24]) {
    await seek(page, frame);
    pictures.push(await page.screenshot());
  }
  assert.ok(!pictures[0].equals(pictures[1]));
}));

test('stretch colours show what the edges say', () => withPage({}, async (page) => {
  const cache = readPc2(scratch.at('run/a napkin.skin.pc2'));
  await page.keyboard.press('v');
  await seek(page, 24);
  assert.ok(await page.locator('#scale').isVisible());
  const shown = await page.evaluate(() => {
    const { surface } = window.muslin.bodies[1];
    return {
      stretch: Array.from(surface.stretch), ends: Array.from(surface.ends), rest: Array.from(surface.restLengths),
      drawn: Array.from(surface.geometry.attributes.stretch.array), points: Array.from(surface.shape.points),
      step: Math.hypot(...surface.track.step),
    };
  });
  const x = cache.at(24);
  const start = cache.at(0); // the scene begins at rest
  const truth = new Float64Array(cache.points);
  let shortest = Infinity;
  for (let e = 0; e < shown.rest.length; ++e) {
    const [a, b] = [3 * shown.ends[2 * e], 3 * shown.ends[2 * e + 1]];
    const length = (of) => Math.hypot(of[a] - of[b], of[a + 1] - of[b + 1], of[a + 2] - of[b + 2]);
    assert.ok(Math.abs(length(start) / shown.rest[e] - 1) < 1e-5);
    shortest = Math.min(shortest, shown.rest[e]);
    for (const p of [a / 3, b / 3]) truth[p] = Math.max(truth[p], 100 * (length(x) / shown.rest[e] - 1));
  }
  const allowed = (100 * shown.step) / shortest; // what 16 bits do to the shortest edge [%]
  assert.ok(allowed < 0.5);
  truth.forEach((percent, p) => assert.ok(Math.abs(percent - shown.stretch[p]) <= allowed));
  shown.points.forEach((point, vertex) => assert.equal(shown.drawn[vertex], shown.stretch[point]));
  assert.ok(Math.max(...truth) > 0.1);
  await page.keyboard.press('o'); // arrows of forces are reddish
  const { red } = await countPixels(page);
  assert.ok(red < 300, `${red} pixels of the flag's own red are left`);
}));

test('checker and texture colours, edges and the lattice change the picture', () => withPage({}, async (page) => {
  await seek(page, 12);
  const picture = () => page.evaluate(() => {
    window.muslin.stage.invalidate();
    window.muslin.draw();
    return document.getElementById('view').toDataURL();
  });
  const seen = new Set([await picture()]);
  for (const key of ['v', 'v', 'v', 'e', 'm', 'm', 'u', '4']) {
    await page.keyboard.press(key);
    await page.evaluate(() => window.muslin.draw());
    seen.add(await picture());
  }
  assert.equal(seen.size, 9);
}));

test('both sides of a sheet are seen', () => withPage({}, async (page) => {
  for (const view of ['front', 'back']) {
    await page.evaluate((name) => window.muslin.stage.setView(name), view);
    assert.ok((await countPixels(page)).red > 3000, view);
  }
}));

test('pins hold until they let go; forces have the size of the moment', () => withPage({}, async (page) => {
  const pin = () => page.evaluate(() => window.muslin.annotations.pins[0].object.visible);
  const labels = () => page.locator('.label:not([hidden])').allTextContents();
  await seek(page, 11);
  assert.equal(await pin(), true);
  assert.deepEqual((await labels()).map((text) => text.replaceAll('\u00a0', ' ')),
    ['gravity 9.8 m/s\u00b2', 'breeze 3 m/s', 'pull 45.8 N']);
  await seek(page, 13);
  assert.equal(await pin(), false);
  await seek(page, 0);
  assert.equal((await labels()).length, 2); // the pull begins at nothing
  // A pin is drawn where the cache has its vertices.
  const cache = readPc2(scratch.at('run/flag.lattice.pc2'));
  const held = JSON.parse(readFileSync(scratch.at('run/selections.json'))).pins[0].vertices;
  const drawn = await page.evaluate(() => Array.from(window.muslin.annotations.pins[0].positions));
  assert.equal(drawn.length, 3 * held.length);
  held.forEach((vertex, i) => {
    for (let axis = 0; axis < 3; ++axis) {
      assert.ok(Math.abs(drawn[3 * i + axis] - cache.at(0)[3 * vertex + axis]) < 1e-4);
    }
  });
  await page.keyboard.press('o');
  await page.evaluate(() => window.muslin.draw());
  assert.equal((await labels()).length, 0);
}));

test('curves follow the diagnostics, the cursor follows time, and a click goes there', () => withPage({}, async (page) => {
  const rows = readFileSync(scratch.at('run/diagnostics.csv'), 'utf8').trim().split('\n').map((row) => row.split(','));
  const column = (name) => rows.slice(1).map((row) => Number(row[rows[0].indexOf(name)]));
  await page.keyboard.press('c');
  await seek(page, 6);
  const plot = await page.evaluate(() => {
    const [energy, stretch] = window.muslin.plots;
    return {
      kinetic: Array.from(energy.curves[0].values), stretch: Array.from(stretch.curves[0].values),
      cursor: energy.cursor, at: energy.x(0.25), reading: stretch.readings[0].textContent,
    };
  });
  const kinetic = column('kinetic');
  plot.kinetic.forEach((value, i) => assert.ok(Math.abs(value - (kinetic[i] - kinetic[0])) <= 1e-5 * Math.abs(value) + 1e-9));
  const stretch = column('max_stretch').map((ratio) => 100 * (ratio - 1));
  plot.stretch.forEach((value, i) => assert.ok(Math.abs(value - stretch[i]) < 1e-4));
  assert.ok(Math.abs(plot.cursor - plot.at) < 1e-6);
  assert.equal(plot.reading, `${Number(stretch[6].toPrecision(3))} %`);
  const box = await page.locator('#curves canvas').first().boundingBox();
  const x = await page.evaluate(() => window.muslin.plots[0].x(0.75));
  await page.mouse.click(box.x + x, box.y + 40);
  assert.equal(await shownFrame(page), 18);
}));

test('a finger turns the view, two come nearer, and nothing scrolls', () =>
  withPage({ hasTouch: true, isMobile: true, viewport: { width: 390, height: 780 } }, async (page) => {
    const eye = () => page.evaluate(() => {
      const { camera, controls } = window.muslin.stage;
      const back = camera.position.clone().sub(controls.target);
      return { azimuth: Math.atan2(back.x, back.z), distance: back.length() };
    });
    const touch = await page.context().newCDPSession(page);
    const send = (type, touchPoints) => touch.send('Input.dispatchTouchEvent', { type, touchPoints });
    const before = await eye();
    await send('touchStart', [{ x: 150, y: 400 }]);
    for (let i = 1; i <= 10; ++i) await send('touchMove', [{ x: 150 + 10 * i, y: 400 }]);
    await send('touchEnd', []);
    await page.waitForTimeout(300);
    const turned = await eye();
    assert.ok(Math.abs(turned.azimuth - before.azimuth) > 0.2);
    await send('touchStart', [{ x: 170, y: 400 }, { x: 220, y: 400 }]);
    for (let i = 1; i <= 10; ++i) await send('touchMove', [{ x: 170 - 10 * i, y: 400 }, { x: 220 + 10 * i, y: 400 }]);
    await send('touchEnd', []);
    await page.waitForTimeout(300);
    assert.ok((await eye()).distance < 0.8 * turned.distance);
    await page.locator('#play').tap();
    await page.waitForFunction(() => window.muslin.clock.playing);
    const page_size = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth, scrollY]);
    assert.equal(page_size[0], page_size[1]);
    assert.equal(page_size[2], 0);
    // Every button lies in the window and is large enough for a finger.
    for (const button of await page.locator('nav button:visible, footer button:visible').all()) {
      const box = await button.boundingBox();
      assert.ok(box.x >= 0 && box.x + box.width <= 390 && box.y >= 0 && box.y + box.height <= 780);
      assert.ok(box.width >= 36 && box.height >= 36);
    }
  }));

test('can be used with the keyboard alone', () => withPage({}, async (page) => {
  const names = [];
  for (let i = 0; i < 14; ++i) {
    await page.keyboard.press('Tab');
    names.push(await page.evaluate(() => document.activeElement.id));
  }
  for (const id of ['view', 'open-look', 'open-curves', 'theme', 'play', 'time', 'speed', 'loop']) {
    assert.ok(names.includes(id), `${id} among ${names}`);
  }
  await page.keyboard.press('?');
  assert.ok(await page.locator('#help').isVisible());
  await page.keyboard.press('Escape');
  assert.ok(!await page.locator('#help').isVisible());
  await page.locator('#open-look').focus();
  await page.keyboard.press('Enter');
  await page.locator('#colouring button[aria-checked=true]').focus();
  await page.keyboard.press('ArrowRight');
  assert.equal(await page.locator('#colouring button[aria-checked=true]').textContent(), 'Stretch');
  // Nothing that can be pressed is nameless.
  const nameless = await page.evaluate(() => [...document.querySelectorAll('button, input')].filter((each) =>
    !(each.textContent.trim() || each.getAttribute('aria-label') || each.closest('label')?.textContent.trim())).length);
  assert.equal(nameless, 0);
}));

test('light and dark', () => withPage({ colorScheme: 'dark' }, async (page) => {
  const paper = () => page.evaluate(() => getComputedStyle(document.documentElement).getPropertyValue('--paper'));
  const dark = await paper();
  await page.keyboard.press('d');
  assert.notEqual(await paper(), dark);
}));

test('a run too large for the page is thinned in time, and says so', async () => {
  const empty = statSync(join(source, 'viewer/dist/page.html')).size;
  const whole = statSync(scratch.at('page.html')).size;
  const megabytes = (empty + 0.4 * (whole - empty)) / 1e6;
  const out = run('view', scratch.at('run'), '-o', scratch.at('thin.html'), '--max-size', String(megabytes));
  assert.match(out, /One frame in \d+ is shown/);
  assert.ok(statSync(scratch.at('thin.html')).size <= 1e6 * megabytes);
  await withPage({ file: scratch.at('thin.html') }, async (page) => {
    const frames = await page.evaluate(() => window.muslin.clock.frames);
    assert.ok(frames.length > 1 && frames.length < 25, frames.join());
    assert.equal(frames.at(-1), 24);
    assert.match(await page.locator('#notes').textContent(), /One frame in \d+ is shown, to keep the page below/);
    const cache = readPc2(scratch.at('run/flag.skin.pc2'));
    for (const index of [1, frames.length - 1]) {
      await seek(page, index);
      const shown = await page.evaluate(() => Array.from(window.muslin.bodies[0].surface.positions));
      cache.at(frames[index]).forEach((x, i) => assert.ok(Math.abs(shown[i] - x) < 5e-4));
    }
    await page.keyboard.press('End');
    assert.match(await page.locator('#now').textContent(), /^24 \/ 24/);
  });
});

test('an unfinished run is shown as far as it came', async () => {
  cpSync(scratch.at('run'), scratch.at('half'), { recursive: true });
  const summary = JSON.parse(readFileSync(scratch.at('half/run.json')));
  writeFileSync(scratch.at('half/run.json'), JSON.stringify({ ...summary, status: 'running' }));
  const rows = readFileSync(scratch.at('half/diagnostics.csv'), 'utf8').split('\n').slice(0, 11);
  writeFileSync(scratch.at('half/diagnostics.csv'), `${rows.join('\n')}\n10,0.4`); // a row being written
  run('view', scratch.at('half'), '-o', scratch.at('half.html'), '--quiet');
  await withPage({ file: scratch.at('half.html') }, async (page) => {
    assert.match(await page.locator('#facts').textContent(), /still running: 10 of 25 frames/);
    await page.keyboard.press('End');
    assert.equal(await shownFrame(page), 9);
  });
});

test('a page that was cut off says so', async () => {
  const page = readFileSync(scratch.at('page.html'), 'utf8');
  writeFileSync(scratch.at('cut.html'), page.replace(/(id="data" type="text\/plain">.{1000})[^<]*/, '$1'));
  const shown = await open(browser, scratch.at('cut.html'));
  assert.ok(await shown.locator('#trouble').isVisible());
  await shown.context().close();
});

test('what cannot be shown is an error and leaves no page', () => {
  const refused = (code, words, pattern) => {
    const done = muslin('view', ...words);
    assert.equal(done.code, code, done.err);
    assert.match(done.err, pattern);
    assert.ok(!existsSync(scratch.at('none.html')));
    assert.ok(!existsSync(scratch.at('none.html.part')));
  };
  const out = ['-o', scratch.at('none.html'), '--quiet'];
  cpSync(scratch.at('run'), scratch.at('damaged'), { recursive: true });
  writeFileSync(scratch.at('damaged/run.json'), '{"muslin":');
  refused(3, [scratch.at('damaged'), ...out], /run\.json/);
  cpSync(scratch.at('run'), scratch.at('other'), { recursive: true });
  appendFileSync(scratch.at('other/flag.skin.obj'), 'v 1 2 3\n');
  refused(3, [scratch.at('other'), ...out], /another number of points/);
  refused(5, [scratch.at('nowhere'), ...out], /no run here/);
  writeFileSync(scratch.at('file'), '');
  refused(5, [scratch.at('run'), '-o', scratch.at('file/page.html'), '--quiet'], /page|file/);
  mkdirSync(scratch.at('folder.html'));
  refused(5, [scratch.at('run'), '-o', scratch.at('folder.html'), '--quiet'], /folder\.html/);
  refused(2, [scratch.at('run'), '-o', scratch.at('page.pdf'), '--quiet'], /\.html/);
  refused(2, [scratch.at('run'), ...out, '--max-size', '0.001'], /--max-size/);
  refused(2, [scratch.at('run'), ...out, '--max-size', '-1'], /positive|max-size/);
});
