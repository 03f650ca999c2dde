// Curves over time with a cursor at the present, drawn on a canvas.
import { curveColours } from './colours.js';
import { digits, ticks } from './numbers.js';

const margin = { left: 52, right: 10, top: 8, bottom: 20 };

export class Plot {
  /**
   * @param curves [{key, label, values}], one value per row
   * @param times of the rows [s]
   * @param format of a value in the legend
   */
  constructor(element, { title, times, curves, format }, seek) {
    Object.assign(this, { times, curves, format });
    const heading = document.createElement('h3');
    heading.textContent = title;
    this.canvas = document.createElement('canvas');
    this.canvas.setAttribute('role', 'img');
    this.legend = document.createElement('ul');
    this.legend.className = 'legend';
    this.readings = curves.map(({ key, label }) => {
      const item = document.createElement('li');
      const swatch = document.createElement('i');
      swatch.style.background = curveColours[key];
      const value = document.createElement('b');
      item.append(swatch, label, ' ', value);
      this.legend.append(item);
      return value;
    });
    this.canvas.setAttribute('aria-label', `${title} over time; the values now follow`);
    element.append(heading, this.canvas, this.legend);
    const all = curves.flatMap((curve) => Array.from(curve.values)).filter(Number.isFinite);
    [this.low, this.high] = bounds(all);
    const seekTo = (event) => {
      const box = this.canvas.getBoundingClientRect();
      seek(this.timeAt(event.clientX - box.left));
    };
    this.canvas.addEventListener('pointerdown', (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      seekTo(event);
    });
    this.canvas.addEventListener('pointermove', (event) => {
      if (event.buttons & 1) seekTo(event);
    });
  }

  get span() {
    return this.times[this.times.length - 1] || 1;
  }
  get inner() {
    return {
      width: this.canvas.clientWidth - margin.left - margin.right,
      height: this.canvas.clientHeight - margin.top - margin.bottom,
    };
  }
  x(time) {
    return margin.left + (time / this.span) * this.inner.width;
  }
  y(value) {
    return margin.top + (1 - (value - this.low) / (this.high - this.low)) * this.inner.height;
  }
  timeAt(x) {
    return ((x - margin.left) / this.inner.width) * this.span;
  }

  /** Draws the curves into a picture of their own; the cursor goes over it. */
  paint() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const picture = document.createElement('canvas');
    picture.width = width * ratio;
    picture.height = height * ratio;
    const g = picture.getContext('2d');
    g.scale(ratio, ratio);
    const style = getComputedStyle(this.canvas);
    g.font = `11px ${style.fontFamily}`;
    g.fillStyle = style.color;
    g.strokeStyle = style.borderTopColor;
    g.lineWidth = 1;
    g.textAlign = 'right';
    g.textBaseline = 'middle';
    for (const value of ticks(this.low, this.high, 4)) {
      const y = Math.round(this.y(value)) + 0.5;
      line(g, margin.left, y, width - margin.right, y);
      g.fillText(digits(value), margin.left - 6, y);
    }
    g.textAlign = 'center';
    g.textBaseline = 'top';
    for (const time of ticks(0, this.span, 4)) g.fillText(`${digits(time)} s`, this.x(time), height - margin.bottom + 6);
    g.lineWidth = 1.6;
    g.lineJoin = 'round';
    for (const { key, values } of this.curves) {
      g.strokeStyle = curveColours[key];
      g.beginPath();
      let down = false;
      for (let row = 0; row < values.length; ++row) {
        const known = Number.isFinite(values[row]);
        if (known) g[down ? 'lineTo' : 'moveTo'](this.x(this.times[row]), this.y(values[row]));
        down = known;
      }
      g.stroke();
    }
    this.picture = picture;
    this.size = `${width} ${height} ${ratio}`;
    this.canvas.width = picture.width;
    this.canvas.height = picture.height;
  }

  /** Shows the present. */
  moveTo(time, row) {
    this.readings.forEach((reading, i) => {
      reading.textContent = this.format(this.curves[i].values[row]);
    });
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    if (this.size !== `${width} ${height} ${ratio}`) this.paint();
    const g = this.canvas.getContext('2d');
    g.setTransform(1, 0, 0, 1, 0, 0);
    g.clearRect(0, 0, this.canvas.width, this.canvas.height);
    g.drawImage(this.picture, 0, 0);
    g.scale(ratio, ratio);
    const style = getComputedStyle(this.canvas);
    this.cursor = this.x(time);
    g.strokeStyle = style.color;
    g.lineWidth = 1;
    line(g, this.cursor, margin.top, this.cursor, height - margin.bottom);
    for (const { key, values } of this.curves) {
      if (!Number.isFinite(values[row])) continue;
      g.fillStyle = curveColours[key];
      g.beginPath();
      g.arc(this.cursor, this.y(values[row]), 3.2, 0, 2 * Math.PI);
      g.fill();
    }
  }

  /** Colours changed. */
  forget() {
    this.size = '';
  }
}

function line(g, x0, y0, x1, y1) {
  g.beginPath();
  g.moveTo(x0, y0);
  g.lineTo(x1, y1);
  g.stroke();
}

/** Lowest and highest value, a little apart. */
function bounds(values) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (!(low <= high)) return [0, 1];
  const room = (high - low || Math.abs(high) || 1) * 0.05;
  return [low - room, high + room];
}
