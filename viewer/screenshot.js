// A picture of a page, as a browser shows it.
// Usage: node screenshot.js PAGE.html OUT.png [--size WxH] [--scale N] [--hash WORDS] [--keys KEYS]
// WORDS go behind the # of the address; KEYS are pressed one by one. Waits until the page has drawn.
import { parseArgs } from 'node:util';
import { resolve } from 'node:path';
import { launch, open } from './test/support.js';

const { values, positionals: [page, out] } = parseArgs({
  allowPositionals: true,
  options: {
    size: { type: 'string', default: '1280x760' },
    scale: { type: 'string', default: '1' },
    hash: { type: 'string', default: 'play=0' },
    keys: { type: 'string', default: '' },
  },
});
if (!out) throw new Error('usage: node screenshot.js PAGE.html OUT.png [--size WxH] [--scale N] [--hash WORDS] [--keys KEYS]');
const [width, height] = values.size.split('x').map(Number);
const browser = await launch();
try {
  const tab = await open(browser, resolve(page), {
    hash: values.hash, viewport: { width, height }, deviceScaleFactor: Number(values.scale),
  });
  for (const key of values.keys) await tab.keyboard.press(key);
  await tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await tab.screenshot({ path: out });
  if (tab.complaints.length) throw new Error(tab.complaints.join('\n'));
} finally {
  await browser.close();
}
