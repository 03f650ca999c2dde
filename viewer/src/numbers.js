// Numbers for people.

/** 1, 2 or 5 times a power of ten, at least `value`. */
export function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(Math.max(value, 1e-12)));
  for (const digit of [1, 2, 5]) if (digit * power >= value * (1 - 1e-9)) return digit * power;
  return 10 * power;
}

/** About `count` round numbers from low to high. */
export function ticks(low, high, count) {
  const step = roundUp((high - low) / Math.max(count, 1));
  const result = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) result.push(i * step || 0);
  return result;
}

/** Three digits: 1234 → "1230", 0.012345 → "0.0123". */
export function digits(value) {
  if (!Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const text = Number(value.toPrecision(3));
  const far = Math.abs(text) >= 1e6 || Math.abs(text) < 1e-4;
  return (far ? text.toExponential() : String(text)).replace(/-/g, '\u2212');
}

/** With an SI prefix: 12300 J → "12.3 kJ". */
export function withUnit(value, unit) {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  for (const [factor, prefix] of [[1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, '\u00b5'],
    [1e-9, 'n'], [1e-12, 'p']]) {
    if (size >= factor) return `${digits(value / factor)}\u00a0${prefix}${unit}`;
  }
  return `0\u00a0${unit}`;
}
