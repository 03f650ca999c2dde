// Makes dist/page.html from src/: one page with its script and style inside, into which `muslin view` puts a run.
// Usage: node build.js [FILE]
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { buildSync } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, 'dist', 'page.html');

const bundled = (entry, options) => buildSync({
  entryPoints: [join(here, 'src', entry)],
  absWorkingDir: here,
  bundle: true,
  minify: true,
  charset: 'ascii',
  legalComments: 'inline',
  target: ['chrome103', 'firefox113', 'safari16.4'],
  write: false,
  ...options,
}).outputFiles[0].text.trim();

const parts = {
  '%STYLE%': bundled('style.css'),
  '%SCRIPT%': bundled('main.js', { format: 'iife' }),
};
let page = readFileSync(join(here, 'src', 'page.html'), 'utf8');
for (const [place, text] of Object.entries(parts)) page = page.replace(place, () => text);
for (const place of ['%TITLE%', '%RUN%']) {
  if (page.split(place).length !== 2) throw new Error(`${place} must stand in the page once`);
}
writeFileSync(out, page);
