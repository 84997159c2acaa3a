// Map of a run: cells, track, stations, findings, water, robots. Coordinates in `map`, m, x to the right, y up.
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
const rgb = (color) => {
  const context = document.createElement('canvas').getContext('2d');
  context.fillStyle = color;
  return [1, 3, 5].map((at) => parseInt(context.fillStyle.slice(at, at + 2), 16));
};
const kSigmas = 2.448;  // half axes of the 95 % ellipse of a two-dimensional normal distribution

/// Map image with occupied and free cells in the page's colors; unknown cells are transparent.
async function colorize(url) {
  const image = new Image();
  image.src = url;
  await image.decode();
  const canvas = Object.assign(document.createElement('canvas'), { width: image.naturalWidth, height: image.naturalHeight });
  const context = canvas.getContext('2d');
  context.drawImage(image, 0, 0);
  const pixels = context.getImageData(0, 0, canvas.width, canvas.height), wall = rgb(ink('wall')), free = rgb(ink('free'));
  for (let i = 0; i < pixels.data.length; i += 4) {
    const gray = pixels.data[i], color = gray < 100 ? wall : free;
    pixels.data.set(color, i);
    pixels.data[i + 3] = gray < 100 || gray > 230 ? 255 : 0;
  }
  context.putImageData(pixels, 0, 0);
  return canvas;
}

/// Half axes (square roots of the eigenvalues) of [[a, b], [b, c]] and the angle of the long one.
function axes(a, b, c) {
  const middle = (a + c) / 2, half = Math.hypot((a - c) / 2, b);
  return { long: Math.sqrt(Math.max(0, middle + half)), short: Math.sqrt(Math.max(0, middle - half)), angle: 0.5 * Math.atan2(2 * b, a - c) };
}

export class MapView {
  constructor(section) {
    this.view = section.querySelector('.view');
    this.canvas = section.querySelector('canvas');
    this.scale = section.querySelector('.scale');
    this.empty = section.querySelector('.view .empty');
    this.details = null;
    this.water = [];
    this.robots = [];
    this.cells = null;
    this.shown = null;  // {x, y, meters per pixel}; null: the whole map
    const [nearer, farther, whole] = section.querySelectorAll('.zoom button');
    nearer.addEventListener('click', () => this.zoom(0.6));
    farther.addEventListener('click', () => this.zoom(1 / 0.6));
    whole.addEventListener('click', () => { this.shown = null; this.draw(); });
    this.canvas.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && !this.shown) return;  // scrolls the page
      event.preventDefault();
      this.zoom(Math.exp(0.002 * event.deltaY), event.offsetX, event.offsetY);
    }, { passive: false });
    this.drag();
    new ResizeObserver(() => this.draw()).observe(this.view);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { this.mapUrl = null; this.load(); });
  }

  /// `details` of /api/run, the `water` results of /api/water of this run, and the robots to draw, the selected one
  /// first.
  show(details, water, robots) {
    if (!this.details || !details || this.details.run !== details.run) this.shown = null;
    Object.assign(this, { details, water, robots });
    this.load();
  }

  async load() {
    const map = this.details && this.details.map, url = map ? '/api/maps/' + map.seq : null;
    if (url !== this.mapUrl) {
      this.mapUrl = url;
      const cells = url && await colorize(url).catch(() => null);
      if (url !== this.mapUrl) return;
      this.cells = cells;
      this.cellsMap = map;
    }
    this.draw();
  }

  drag() {
    let before = null;
    this.canvas.addEventListener('pointerdown', (event) => { before = event; this.canvas.setPointerCapture(event.pointerId); });
    for (const end of ['pointerup', 'pointercancel']) this.canvas.addEventListener(end, () => { before = null; });
    this.canvas.addEventListener('pointermove', (event) => {
      if (!before || !this.shown) return;
      this.shown.x -= (event.clientX - before.clientX) * this.shown.px;
      this.shown.y += (event.clientY - before.clientY) * this.shown.px;
      before = event;
      this.draw();
    });
  }

  zoom(factor, x = this.view.clientWidth / 2, y = this.view.clientHeight / 2) {
    const from = this.currentView(), whole = this.whole();
    const px = Math.min(Math.max(from.px * factor, 0.002), whole.px * 1.5);
    const dx = x - this.view.clientWidth / 2, dy = this.view.clientHeight / 2 - y;
    this.shown = { x: from.x + dx * (from.px - px), y: from.y + dy * (from.px - px), px };
    if (px >= whole.px) this.shown = null;
    this.canvas.style.touchAction = this.shown ? 'none' : 'pan-y';
    this.draw();
  }

  currentView() { return this.shown || this.whole(); }

  /// View of all drawn objects with a margin.
  whole() {
    const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    const add = ([x, y]) => { low[0] = Math.min(low[0], x); low[1] = Math.min(low[1], y); high[0] = Math.max(high[0], x); high[1] = Math.max(high[1], y); };
    const { details } = this, map = details && details.map;
    if (map) [map.origin_m, [map.origin_m[0] + map.width * map.resolution_m, map.origin_m[1] + map.height * map.resolution_m]].forEach(add);
    if (details) [...details.track, ...details.stations.map((one) => one.position_m), ...details.findings.map((one) => [one.x, one.y])].forEach(add);
    for (const one of this.water) if (one.data.found) add(one.data.position_m);
    for (const robot of this.robots) if (robot.x != null) add([robot.x, robot.y]);
    if (low[0] > high[0]) return { x: 0, y: 0, px: 0.05 };
    const px = Math.max((high[0] - low[0]) / Math.max(1, this.view.clientWidth - 48), (high[1] - low[1]) / Math.max(1, this.view.clientHeight - 48), 0.01);
    return { x: (low[0] + high[0]) / 2, y: (low[1] + high[1]) / 2, px };
  }

  draw() {
    const width = this.view.clientWidth, height = this.view.clientHeight, ratio = devicePixelRatio || 1;
    Object.assign(this.canvas, { width: width * ratio, height: height * ratio });
    const context = this.canvas.getContext('2d'), at = this.currentView();
    context.scale(ratio, ratio);
    const to = ([x, y]) => [width / 2 + (x - at.x) / at.px, height / 2 - (y - at.y) / at.px];
    this.empty.textContent = this.details ? '' : 'No robots yet.';
    if (!this.details) return this.drawScale(at.px);
    this.drawCells(context, to, at.px);
    this.drawTrack(context, to);
    this.labels = [];
    for (const one of this.water) if (one.data.found) this.drawWater(context, to, at.px, one.data);
    for (const one of this.details.stations) this.drawStation(context, to(one.position_m), one.name);
    for (const one of [...this.details.findings].reverse()) this.drawFinding(context, to([one.x, one.y]), one);
    for (const robot of [...this.robots].reverse()) if (robot.x != null) this.drawRobot(context, to, robot, robot === this.robots[0]);
    this.drawScale(at.px);
  }

  drawCells(context, to, px) {
    const map = this.cellsMap;
    if (!this.cells || !map) return;
    const [left, top] = to([map.origin_m[0], map.origin_m[1] + map.height * map.resolution_m]);
    context.imageSmoothingEnabled = map.resolution_m < px;
    context.imageSmoothingQuality = 'high';
    context.drawImage(this.cells, left, top, map.width * map.resolution_m / px, map.height * map.resolution_m / px);
  }

  drawTrack(context, to) {
    context.beginPath();
    this.details.track.forEach((point, i) => context[i ? 'lineTo' : 'moveTo'](...to(point)));
    Object.assign(context, { strokeStyle: ink('track'), lineWidth: 1.75, lineJoin: 'round' });
    context.stroke();
  }

  drawWater(context, to, px, water) {
    const [x, y] = to(water.position_m), [row, other] = water.covariance_m2, spread = axes(row[0], row[1], other[1]);
    context.fillStyle = ink('water') + '30';
    context.strokeStyle = ink('water');
    context.beginPath();
    context.arc(x, y, Math.max(2, water.radius_m / px), 0, 2 * Math.PI);
    context.fill();
    context.lineWidth = 1.5;
    context.stroke();
    context.setLineDash([5, 4]);
    context.beginPath();
    context.ellipse(x, y, Math.max(3, kSigmas * spread.long / px), Math.max(3, kSigmas * spread.short / px), -spread.angle, 0, 2 * Math.PI);
    context.stroke();
    context.setLineDash([]);
    this.label(context, x, y, 'water', ink('water'));
  }

  drawStation(context, [x, y], name) {
    Object.assign(context, { fillStyle: ink('card'), strokeStyle: ink('soft'), lineWidth: 2 });
    context.beginPath();
    context.arc(x, y, 4.5, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
    this.label(context, x, y, name, ink('soft'));
  }

  drawFinding(context, [x, y], finding) {
    context.fillStyle = ink(finding.level);
    context.globalAlpha = finding.acknowledged_ms == null ? 1 : 0.55;
    context.beginPath();
    [[0, -8], [7.5, 5], [-7.5, 5]].forEach(([dx, dy], i) => context[i ? 'lineTo' : 'moveTo'](x + dx, y + dy));
    context.closePath();
    context.fill();
    Object.assign(context, { strokeStyle: ink('card'), lineWidth: 1.5 });
    context.stroke();
    context.globalAlpha = 1;
    if (finding.level !== 'notice') this.label(context, x, y, finding.subject || finding.kind, ink(finding.level));
  }

  drawRobot(context, to, robot, isChosen) {
    const [x, y] = to([robot.x, robot.y]);
    context.save();
    context.translate(x, y);
    context.rotate(-robot.yaw);
    context.globalAlpha = isChosen ? 1 : 0.5;
    Object.assign(context, { fillStyle: ink(isChosen ? 'accent' : 'soft'), strokeStyle: ink('card'), lineWidth: 2 });
    context.beginPath();
    [[11, 0], [-7, 7], [-3.5, 0], [-7, -7]].forEach((point, i) => context[i ? 'lineTo' : 'moveTo'](...point));
    context.closePath();
    context.stroke();
    context.fill();
    context.restore();
    this.label(context, x, y, robot.robot, ink(isChosen ? 'accent' : 'soft'));
  }

  /// Draws a label unless it overlaps an earlier one.
  label(context, x, y, text, color) {
    context.font = '600 11px ' + ink('font');
    const short = text.length > 24 ? text.slice(0, 23) + '\u2026' : text, width = context.measureText(short).width;
    const left = x + 10 + width > this.view.clientWidth ? x - 10 - width : x + 10;
    const box = [left, y - 7, left + width, y + 7];
    if (this.labels.some((one) => box[0] < one[2] && box[2] > one[0] && box[1] < one[3] && box[3] > one[1])) return;
    this.labels.push(box);
    Object.assign(context, { lineWidth: 3, strokeStyle: ink('free'), fillStyle: color, lineJoin: 'round' });
    context.strokeText(short, left, y + 4);
    context.fillText(short, left, y + 4);
  }

  drawScale(px) {
    const max = 110 * px, power = 10 ** Math.floor(Math.log10(max)), length = [5, 2, 1].map((step) => step * power).find((one) => one <= max);
    this.scale.textContent = length >= 1 ? length + ' m' : length * 100 + ' cm';
    this.scale.style.width = length / px + 'px';
  }
}
