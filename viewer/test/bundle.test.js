// The page that is compiled into muslin is the one that these sources make.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

const at = (path) => fileURLToPath(new URL(`../${path}`, import.meta.url));

test('dist/page.html is what build.js makes', () => {
  const scratch = mkdtempSync(join(tmpdir(), 'muslin-viewer-'));
  try {
    execFileSync(process.execPath, [at('build.js'), join(scratch, 'page.html')]);
    const same = readFileSync(join(scratch, 'page.html')).equals(readFileSync(at('dist/page.html')));
    assert.ok(same, 'viewer/dist/page.html is stale: run `npm run build` in viewer/ and commit it');
  } finally {
    rmSync(scratch, { recursive: true });
  }
});

test('the page fetches nothing and names no other machine', () => {
  const page = readFileSync(at('dist/page.html'), 'utf8');
  assert.ok(!/<(script|link|img|iframe)[^>]+(src|href)=/i.test(page));
  assert.ok(!/@import|url\(\s*['"]?http/i.test(page));
  assert.ok(/^[\x00-\x7f]*$/.test(page), 'plain ASCII survives every mail program');
  assert.match(page, /three.*MIT|MIT.*three|Three\.js Authors/i); // its licence travels with it
});
