// Which curves the page shows.
import { digits, withUnit } from './numbers.js';
import { Plot } from './plot.js';

const energies = ['kinetic', 'elastic', 'potential', 'work', 'dissipated'];

/** Energies as changes since the first frame, their balance, stretch, and the least gap where bodies touch. */
export function makePlots(element, run, seek) {
  const column = (name) => run.floats(run.head.curves[name]);
  const times = column('time');
  if (times.length < 2) {
    element.textContent = 'There are curves from the second frame on.';
    return [];
  }
  const curves = energies.map((key) => ({ key, label: key, values: sinceStart(column(key)) }));
  const [kinetic, elastic, potential, work, dissipated] = curves.map((curve) => curve.values);
  const balance = kinetic.map((_, i) => kinetic[i] + elastic[i] + potential[i] - work[i] + dissipated[i]);
  curves.push({ key: 'balance', label: 'balance', values: balance });
  const stretch = column('max_stretch').map((ratio) => 100 * (ratio - 1));
  const plots = [
    new Plot(element, { title: 'Energy since the start [J]', times, curves, format: (x) => withUnit(x, 'J') }, seek),
    new Plot(element, {
      title: 'Largest stretch [%]', times, curves: [{ key: 'max_stretch', label: 'stretch', values: stretch }],
      format: (x) => (Number.isFinite(x) ? `${digits(x)} %` : '\u2013'),
    }, seek),
  ];
  const gap = column('min_distance').map((metres) => 1000 * metres);
  if (gap.some(Number.isFinite)) {
    plots.push(new Plot(element, {
      title: 'Smallest gap between surfaces [mm]', times, curves: [{ key: 'min_distance', label: 'gap', values: gap }],
      format: (x) => (Number.isFinite(x) ? `${digits(x)} mm` : '\u2013'),
    }, seek));
  }
  return plots;
}

const sinceStart = (values) => values.map((value) => value - values[0]);
