// Heat map of the lining, and curves over time (uPlot).
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
const kSeries = 6, kPlotHeight = 230;

function mixed(from, to, fraction) {
  return `color-mix(in srgb, ${to} ${Math.round(100 * fraction)}%, ${from})`;
}

/// Color of a displacement, inward or outward, from zero to the end of the scale.
const displacementColor = (inward_mm, end_mm) => mixed(ink('still'), ink(inward_mm > 0 ? 'inward' : 'outward'), Math.min(1, Math.abs(inward_mm) / end_mm));

/// Clock angle with the crown in the middle: -180 ... 180.
const unrolled = (clock_deg) => (clock_deg > 180 ? clock_deg - 360 : clock_deg);

export class HeatMap {
  constructor(figure) {
    this.canvas = figure.querySelector('canvas');
    this.output = figure.querySelector('output');
    this.ramp = figure.querySelector('.ramp');
    this.cells = [];
    new ResizeObserver(() => this.draw()).observe(figure);
    this.canvas.addEventListener('pointermove', (event) => this.describe(event.offsetX, event.offsetY));
    this.canvas.addEventListener('pointerdown', (event) => this.describe(event.offsetX, event.offsetY));
    this.canvas.addEventListener('pointerleave', () => { this.output.textContent = ''; });
  }

  /// Shows the cells of the scans of /api/lining, newest first. For a ring in several scans the newest is used.
  show(scans) {
    const owner = new Map();
    for (const scan of scans) for (const cell of scan.data.cells) if (!owner.has(cell.ring)) owner.set(cell.ring, scan);
    this.cells = scans.flatMap((scan) => scan.data.cells.filter((cell) => cell.inward_m != null && owner.get(cell.ring) === scan));
    this.rings = [...new Set(this.cells.map((cell) => cell.ring))].sort((a, b) => a - b);
    const clocks = [...new Set(this.cells.map((cell) => cell.clock_deg))].sort((a, b) => a - b);
    this.step = clocks.slice(1).reduce((min, clock, i) => Math.min(min, clock - clocks[i]), 30);
    const max_mm = 1e3 * this.cells.reduce((a, cell) => Math.max(a, Math.abs(cell.inward_m)), 0);
    this.end_mm = [3, 6, 10, 15, 20, 30, 50, 100].find((end) => end >= max_mm) || Math.ceil(max_mm);
    this.draw();
    const gradient = ['outward', 'still', 'inward'].map(ink).join(', ');
    const bar = document.createElement('i');
    bar.style.background = `linear-gradient(to right, ${gradient})`;
    this.ramp.replaceChildren(`${this.end_mm} mm outward`, bar, `${this.end_mm} mm inward`, ' \u2013 pale: within twice its standard deviation');
  }

  /// Positions of the cells: rings in a row, with a gap at missing ring numbers.
  layout() {
    const left = 44, bottom = 22, width = this.canvas.clientWidth - left - 4, height = this.canvas.clientHeight - bottom - 4;
    let slots = 0;
    const slot = new Map();
    this.rings.forEach((ring, i) => {
      if (i > 0 && ring !== this.rings[i - 1] + 1) slots += 0.6;
      slot.set(ring, slots++);
    });
    const wide = Math.min(width / Math.max(1, slots), 64);
    return { left, height, wide, x: (ring) => left + slot.get(ring) * wide, y: (clock_deg) => 4 + (unrolled(clock_deg) + 180) / 360 * height };
  }

  draw() {
    const ratio = devicePixelRatio || 1, width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (!width || !this.rings) return;
    Object.assign(this.canvas, { width: width * ratio, height: height * ratio });
    const context = this.canvas.getContext('2d'), at = this.layout(), tall = this.step / 360 * at.height;
    context.scale(ratio, ratio);
    for (const cell of this.cells) {
      const isSignificant = cell.std_m == null || Math.abs(cell.inward_m) >= 2 * cell.std_m;
      context.globalAlpha = isSignificant ? 1 : 0.45;
      context.fillStyle = displacementColor(1e3 * cell.inward_m, this.end_mm);
      const x = at.x(cell.ring), y = at.y(cell.clock_deg) - tall / 2;
      context.fillRect(x, y, Math.max(1, at.wide - (at.wide > 8 ? 1 : 0)), Math.max(1, tall - (tall > 5 ? 1 : 0)));
    }
    context.globalAlpha = 1;
    Object.assign(context, { fillStyle: ink('soft'), font: '11px ' + ink('font'), textBaseline: 'middle' });
    context.textAlign = 'right';
    for (const [clock, name] of [[270, '9 h'], [0, '12 h'], [90, '3 h']]) context.fillText(name, at.left - 8, at.y(clock));
    context.textAlign = 'center';
    let free = -Infinity;
    for (const ring of this.rings) {
      const x = at.x(ring) + at.wide / 2, half = context.measureText(ring).width / 2 + 5;
      if (x - half < free) continue;
      context.fillText(ring, x, at.height + 16);
      free = x + half;
    }
  }

  describe(x, y) {
    const at = this.layout(), tall = this.step / 360 * at.height;
    const cell = this.cells.find((one) => x >= at.x(one.ring) && x < at.x(one.ring) + at.wide && Math.abs(y - at.y(one.clock_deg)) <= tall / 2);
    this.output.textContent = cell ? `ring ${cell.ring}, ${Math.round(cell.clock_deg)}\u00b0: ${(1e3 * cell.inward_m).toFixed(1)} \u00b1 ${cell.std_m == null ? '?' : (1e3 * cell.std_m).toFixed(1)} mm` : '';
  }
}

/// Axis labels: time of day with the resolution of the ticks, or dates for ticks at least one day apart.
function timesOf(plot, splits) {
  const apart_s = splits.length > 1 ? splits[1] - splits[0] : 60;
  const form = apart_s >= 86400 ? { month: 'short', day: 'numeric' } : { hour: '2-digit', minute: '2-digit', hour12: false, ...(apart_s < 60 ? { second: '2-digit' } : {}) };
  const [first, last] = [splits[0], splits[splits.length - 1]], spansDays = apart_s < 86400 && last - first > 86400;
  return splits.map((s) => new Date(1000 * s).toLocaleString([], spansDays ? { weekday: 'short', ...form } : form));
}

/// Plot of curves over wall-clock time.
export class TimePlot {
  constructor(container, keys) {
    this.container = container;
    this.keys = keys;
    this.plot = null;
    new ResizeObserver(() => this.plot && this.plot.setSize({ width: this.container.clientWidth, height: kPlotHeight })).observe(container);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.series && this.show(this.series));
  }

  /// Shows curves [{name, points: [[ms, value], ...]}]; at most six are drawn.
  show(series) {
    this.series = series;
    if (this.plot) this.plot.destroy();
    this.plot = null;
    const shown = series.slice(0, kSeries);
    this.keys.replaceChildren(...shown.map((one, i) => {
      const key = Object.assign(document.createElement('span'), { textContent: `${one.name}: ${+one.points[one.points.length - 1][1].toPrecision(3)}` });
      key.style.setProperty('--ink', `var(--series-${i + 1})`);
      return key;
    }), ...(series.length > kSeries ? [`and ${series.length - kSeries} more`] : []));
    if (!shown.length) return;
    const data = uPlot.join(shown.map((one) => [one.points.map((point) => point[0] / 1e3), one.points.map((point) => point[1])]));
    const values = shown.flatMap((one) => one.points.map((point) => point[1])), isWide = Math.min(...values) > 0 && Math.max(...values) > 50 * Math.min(...values);
    const axis = { font: '11px ' + ink('font'), stroke: ink('soft'), grid: { stroke: ink('line'), width: 1 }, ticks: { show: false } };
    const [first, end] = [data[0][0], data[0][data[0].length - 1]], margin = Math.max(30, 0.03 * (end - first));
    const span = (plot, from, to) => (from > first - margin && to < end + margin && to - from < end - first ? [from, to] : [first - margin, end + margin]);
    this.plot = new uPlot({
      width: this.container.clientWidth || 300, height: kPlotHeight, legend: { show: false }, padding: [8, 8, 0, 0], cursor: { y: false, drag: { x: true, y: false } },
      scales: { x: { range: span }, y: isWide ? { distr: 3 } : { range: (plot, from, to) => [Math.min(0, 1.1 * from), 1.1 * to || 1] } },
      axes: [{ ...axis, space: 76, size: 26, values: timesOf }, { ...axis, size: 46, ...(isWide ? { filter: (plot, splits) => splits.map((one) => (Number.isInteger(Math.log10(one)) ? one : null)) } : {}) }],
      series: [{}, ...shown.map((one, i) => ({ stroke: ink(`series-${i + 1}`), width: 1.5, spanGaps: true, points: { show: true, size: 6, fill: ink(`series-${i + 1}`) } }))],
    }, data, this.container);
  }
}
