// Runs of the muslin program, and a browser to look at their pages.
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { delimiter, join } from 'node:path';
import { accessSync, constants } from 'node:fs';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

export const source = fileURLToPath(new URL('../../', import.meta.url));
export const program = process.env.MUSLIN ?? join(source, 'build/release/muslin');

/** Runs muslin; gives {code, out, err}. */
export function muslin(...words) {
  const done = spawnSync(program, words, { encoding: 'utf8' });
  if (done.error) throw done.error;
  return { code: done.status, out: done.stdout, err: done.stderr };
}

/** As muslin(), but a failure is an error. */
export function run(...words) {
  return execFileSync(program, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
}

export class Scratch {
  path = mkdtempSync(join(tmpdir(), 'muslin-viewer-'));
  at(name) {
    return join(this.path, name);
  }
  remove() {
    rmSync(this.path, { recursive: true, force: true });
  }
}

function browserPath() {
  if (process.env.CHROMIUM) return process.env.CHROMIUM;
  for (const folder of process.env.PATH.split(delimiter)) {
    for (const name of ['chromium', 'chromium-browser', 'google-chrome']) {
      try {
        accessSync(join(folder, name), constants.X_OK);
        return join(folder, name);
      } catch {
        // look on
      }
    }
  }
  throw new Error('no Chromium found: apt-get install chromium, or set CHROMIUM to a browser');
}

export function launch() {
  // Without these two a headless Chromium draws no WebGL, and says nothing.
  const args = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
  if (process.getuid?.() === 0) args.push('--no-sandbox');
  return chromium.launch({ executablePath: browserPath(), args });
}

/**
 * Opens a page from the disk. `complaints` fills with everything that should not be: errors, messages on the
 * console, requests to anywhere.
 */
export async function open(browser, file, { hash = 'play=0', ...options } = {}) {
  const context = await browser.newContext({ viewport: { width: 1000, height: 640 }, offline: true, ...options });
  context.setDefaultTimeout(150000); // a busy machine without a graphics card takes its time
  const page = await context.newPage();
  page.complaints = [];
  page.on('console', (message) => page.complaints.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => page.complaints.push(`error: ${error.message}`));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) page.complaints.push(`request: ${request.url()}`);
  });
  await page.goto(`${pathToFileURL(file)}#${hash}`);
  await page.waitForFunction(() => window.muslin || /^(?!Opening)/.test(document.getElementById('trouble').textContent));
  return page;
}

/** A PC2 point cache: {points, samples, at(sample)}. */
export function readPc2(path) {
  const bytes = readFileSync(path);
  const points = bytes.readInt32LE(16);
  const samples = bytes.readInt32LE(28);
  const at = (sample) => {
    const from = bytes.byteOffset + 32 + 12 * points * sample;
    return new Float32Array(bytes.buffer.slice(from, from + 12 * points));
  };
  return { points, samples, at };
}
