// Draws the plots and zooms the map of a report. The data are next to each figure; nothing is fetched.
'use strict';
(() => {
  const style = getComputedStyle(document.documentElement);
  const color = (ink) => style.getPropertyValue('--' + ink).trim();
  const axisFont = '12px ' + style.getPropertyValue('--font');
  const kLaneHeight = 20, kAxisHeight = 44, kPlotHeight = 210, kPaperWidth = 688, kPaperMapHeight = 620;

  // ---- Plots ----

  const axis = (more) => ({ font: axisFont, stroke: color('soft'), grid: { stroke: color('line'), width: 1 }, ticks: { show: false }, ...more });
  const timeAxis = (data) => axis({ label: data.label, labelFont: axisFont, labelSize: 16, size: 26, space: 60 });

  /// Range of a logarithmic axis, at most five decades, because errors may begin at zero.
  function decades(plot, least, greatest) {
    const to = Math.ceil(Math.log10(greatest || 1)), from = Math.max(Math.floor(Math.log10(least || 1e-3)), to - 5);
    return [10 ** from, 10 ** to];
  }
  const powersOfTen = (plot, index, from, to) => {
    const powers = [];
    for (let power = Math.round(Math.log10(from)); power <= Math.log10(to) + 1e-6; ++power) powers.push(10 ** power);
    return powers;
  };
  const short = (value) => String(+value.toPrecision(3));

  /// Draws spans and marks of the run below the curves.
  function drawEvents(plot, data) {
    const { ctx, bbox } = plot, x = (value) => plot.valToPos(value, 'x', true);
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.fillStyle = color('alarm') + '1c';
    for (const span of data.spans) ctx.fillRect(x(span.from), bbox.top, Math.max(x(span.to) - x(span.from), uPlot.pxRatio), bbox.height);
    for (const mark of data.marks || []) {
      ctx.fillStyle = color(mark.ink) + '80';
      ctx.fillRect(x(mark.x) - uPlot.pxRatio / 2, bbox.top, uPlot.pxRatio, bbox.height);
    }
    ctx.restore();
  }

  /// Index of the curve's sample nearest to the cursor; curves have their own stamps.
  function nearestSample(plot, series, index) {
    const x = plot.data[0], y = plot.data[series];
    let before = index, after = index;
    while (before > 0 && y[before] == null) --before;
    while (after < y.length - 1 && y[after] == null) ++after;
    if (y[before] == null) return after;
    if (y[after] == null) return before;
    return x[index] - x[before] < x[after] - x[index] ? before : after;
  }

  function showValues(plot, figure) {
    figure.querySelectorAll('.key').forEach((key, i) => {
      const index = plot.cursor.idxs && plot.cursor.idxs[i + 1], value = index == null ? null : plot.data[i + 1][index];
      key.dataset.value = value == null ? '' : value.toPrecision(3);
    });
  }

  const cursor = { sync: { key: 'report', scales: ['x', null] }, drag: { x: true, y: false }, y: false };

  function linePlot(figure, data) {
    const positive = (y) => (data.log && y <= 0 ? null : y);
    const curves = data.curves.map((curve) => [curve.x, curve.y.map(positive)]);
    const range = data.log ? decades : (plot, least, greatest) => [Math.min(0, 1.08 * least), data.max || 1.08 * greatest || 1];
    return new uPlot({
      width: 300, height: kPlotHeight, legend: { show: false }, padding: [8, 10, 0, 0],
      scales: { x: { time: false, range: (plot, from, to) => [from ?? data.begin ?? 0, to ?? data.end] }, y: { distr: data.log ? 3 : 1, range } },
      axes: [timeAxis(data), axis({ size: 54, space: 32, splits: data.log ? powersOfTen : undefined, filter: (plot, splits) => splits, values: (plot, splits) => splits.map(short) })],
      series: [{}, ...data.curves.map((curve) => ({
        stroke: color(curve.ink), width: curve.dashed ? 1.25 : 1.5, dash: curve.dashed ? [4, 4] : undefined, spanGaps: true, points: { show: false },
      }))],
      cursor: { ...cursor, dataIdx: nearestSample },
      hooks: { drawClear: [(plot) => drawEvents(plot, data)], setCursor: [(plot) => showValues(plot, figure)] },
    }, uPlot.join([[[data.begin ?? 0, data.end], [null, null]], ...curves]).filter((_, i) => i !== 1), figure.querySelector('.drawing'));
  }

  function drawLanes(plot, data) {
    const { ctx } = plot, px = uPlot.pxRatio;
    drawEvents(plot, data);
    data.lanes.forEach((lane, i) => lane.marks.forEach((mark) => {
      const x = plot.valToPos(mark.x, 'x', true), y = plot.valToPos(i, 'y', true);
      if (x < plot.bbox.left - px || x > plot.bbox.left + plot.bbox.width + px) return;
      ctx.fillStyle = color(mark.ink === 'event' ? 'text' : mark.ink);
      ctx.fillRect(x - 1.5 * px, y - 6 * px, 3 * px, 12 * px);
    }));
  }

  /// Text at the cursor: the event of its lane, else the span.
  function eventAt(plot, data) {
    const { left, top } = plot.cursor;
    if (left == null || left < 0) return '';
    const lane = data.lanes[Math.round(plot.posToVal(top, 'y'))];
    const away = (mark) => Math.abs(plot.valToPos(mark.x, 'x') - left);
    const nearest = lane && lane.marks.reduce((a, b) => (a && away(a) <= away(b) ? a : b), null);
    if (nearest && away(nearest) < 8) return nearest.x.toFixed(1) + ' s: ' + nearest.text;
    const at = plot.posToVal(left, 'x'), span = data.spans.find((one) => at >= one.from && at <= one.to);
    return span ? span.text : '';
  }

  function lanePlot(figure, data) {
    const num = data.lanes.length, longest = Math.max(...data.lanes.map((lane) => lane.name.length));
    const plot = new uPlot({
      width: 300, height: num * kLaneHeight + kAxisHeight, legend: { show: false }, padding: [2, 10, 0, 0],
      scales: { x: { time: false, range: (plot, from, to) => [from ?? 0, to ?? data.end] }, y: { range: [-0.5, num - 0.5], dir: -1 } },
      axes: [timeAxis(data), axis({ size: 14 + 6.6 * longest, splits: () => data.lanes.map((_, i) => i), values: () => data.lanes.map((lane) => lane.name) })],
      series: [{}, { paths: () => null, points: { show: false } }],
      cursor: { ...cursor, points: { show: false } },
      hooks: { drawClear: [(plot) => drawLanes(plot, data)], setCursor: [(plot) => { figure.querySelector('output').textContent = eventAt(plot, data); }] },
    }, [[0, data.end], [null, null]], figure.querySelector('.drawing'));
    return plot;
  }

  const plots = [...document.querySelectorAll('.plot')].map((figure) => {
    const data = JSON.parse(figure.querySelector('script').textContent);
    return { figure, plot: figure.classList.contains('lanes') ? lanePlot(figure, data) : linePlot(figure, data) };
  });
  const fit = (width) => plots.forEach(({ figure, plot }) => plot.setSize({ width: width || figure.clientWidth, height: plot.height }));

  // ---- Map ----

  function zoomableMap(view) {
    const svg = view.querySelector('svg'), whole = svg.viewBox.baseVal;
    const [width, height] = [whole.width, whole.height];
    let shown = { x: 0, y: 0, width, height };  // m
    const scaleBar = view.appendChild(Object.assign(document.createElement('div'), { className: 'scale-bar' }));

    const metersPerPixel = () => Math.max(shown.width / svg.clientWidth, shown.height / svg.clientHeight);
    function show() {
      const px = metersPerPixel();
      if (!Number.isFinite(px)) return;
      svg.setAttribute('viewBox', [shown.x, shown.y, shown.width, shown.height].map((value) => value.toFixed(3)).join(' '));
      svg.style.setProperty('--px', px);
      svg.classList.toggle('zoomed', shown.width < 0.99 * width);
      const power = 10 ** Math.floor(Math.log10(110 * px)), length = [5, 2, 1].map((one) => one * power).find((one) => one <= 110 * px);
      declutter();
      scaleBar.style.width = length / px + 'px';
      scaleBar.textContent = length + ' m';
    }
    /// Hides labels that overlap an earlier one; alarms have priority.
    function declutter() {
      const taken = [];
      for (const label of [...svg.querySelectorAll('.alarm text'), ...svg.querySelectorAll('.event text')]) {
        const box = label.getBoundingClientRect();
        const isFree = taken.every((one) => box.right < one.left || box.left > one.right || box.bottom < one.top || box.top > one.bottom);
        label.style.visibility = isFree ? 'visible' : 'hidden';
        if (isFree) taken.push(box);
      }
    }
    /// Zooms about a point of the window: the map position under it stays fixed.
    function zoom(factor, clientX, clientY) {
      const box = svg.getBoundingClientRect(), px = metersPerPixel();
      const fx = clientX - box.left - box.width / 2, fy = clientY - box.top - box.height / 2;
      const px2 = Math.min(px / factor, Math.max(width / svg.clientWidth, height / svg.clientHeight));
      const center = { x: shown.x + shown.width / 2 + fx * (px - px2), y: shown.y + shown.height / 2 + fy * (px - px2) };
      const share = px2 / px;
      shown = { width: shown.width * share, height: shown.height * share };
      move(center.x, center.y);
    }
    function move(centerX, centerY) {
      shown.x = Math.min(Math.max(centerX, 0), width) - shown.width / 2;
      shown.y = Math.min(Math.max(centerY, 0), height) - shown.height / 2;
      if (shown.width >= 0.99 * width) shown = { x: 0, y: 0, width, height };
      show();
    }
    const zoomMiddle = (factor) => {
      const box = svg.getBoundingClientRect();
      zoom(factor, box.left + box.width / 2, box.top + box.height / 2);
    };

    const controls = view.appendChild(Object.assign(document.createElement('div'), { className: 'controls' }));
    const steps = [['+', 'Zoom in', () => zoomMiddle(2)], ['\u2212', 'Zoom out', () => zoomMiddle(0.5)], ['\u2922', 'Whole map', () => zoomMiddle(0)]];
    for (const [sign, title, act] of steps) {
      const button = controls.appendChild(Object.assign(document.createElement('button'), { type: 'button', textContent: sign, title }));
      button.addEventListener('click', act);
    }

    svg.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && !svg.classList.contains('zoomed')) return;  // scrolls the page
      event.preventDefault();
      zoom(Math.exp(-0.002 * event.deltaY), event.clientX, event.clientY);
    }, { passive: false });
    svg.addEventListener('dblclick', (event) => zoom(2, event.clientX, event.clientY));

    const pointers = new Map();
    svg.addEventListener('pointerdown', (event) => {
      pointers.set(event.pointerId, event);
      svg.setPointerCapture(event.pointerId);
    });
    for (const end of ['pointerup', 'pointercancel']) svg.addEventListener(end, (event) => pointers.delete(event.pointerId));
    svg.addEventListener('pointermove', (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const other = [...pointers.values()].find((one) => one.pointerId !== event.pointerId);
      if (other) {
        const apart = (one) => Math.hypot(one.clientX - other.clientX, one.clientY - other.clientY);
        zoom(apart(event) / apart(before), (event.clientX + other.clientX) / 2, (event.clientY + other.clientY) / 2);
      } else if (svg.classList.contains('zoomed')) {
        const px = metersPerPixel();
        move(shown.x + shown.width / 2 - px * (event.clientX - before.clientX), shown.y + shown.height / 2 - px * (event.clientY - before.clientY));
      }
      pointers.set(event.pointerId, event);
    });
    return (paper) => {
      Object.assign(view.style, paper ? { width: kPaperWidth + 'px', minHeight: 0, maxHeight: kPaperMapHeight + 'px' } : { width: '', minHeight: '', maxHeight: '' });
      show();
    };
  }

  const maps = [...document.querySelectorAll('.view')].map(zoomableMap);

  // ---- Page size on screen and on paper ----

  const layOut = (paper) => {
    fit(paper && kPaperWidth);
    maps.forEach((layOutMap) => layOutMap(paper));
  };
  layOut(false);
  addEventListener('resize', () => layOut(false));
  let opened = [];
  addEventListener('beforeprint', () => {
    opened = [...document.querySelectorAll('details:not([open])')];
    opened.forEach((details) => { details.open = true; });
    layOut(true);
  });
  addEventListener('afterprint', () => {
    opened.forEach((details) => { details.open = false; });
    layOut(false);
  });
})();
