// Findings at a site: lining, water ahead, gas.
import { HeatMap, TimePlot } from '/plots.js';
import { $, dayAndClock, make, mm, plural, humanize } from '/format.js';

const kLines = 12;
const heat = new HeatMap($('#lining .wide'));
const ringPlot = new TimePlot($('#rings'), $('#lining .keys'));
const gasPlot = new TimePlot($('#gas-plot'), $('#gas .keys'));

/// Groups points [key, ms, value] into one curve per key.
function curvesOf(points, name) {
  const curves = new Map();
  for (const [key, ms, value] of points) {
    if (!curves.has(key)) curves.set(key, { name: name(key), points: [] });
    curves.get(key).points.push([ms, value]);
  }
  return [...curves.values()];
}
const last = (curve) => curve.points[curve.points.length - 1][1];

export function showLining({ scans, lines, rings }) {
  const section = $('#lining'), isEmpty = !scans.length;
  $('.content', section).hidden = isEmpty;
  $(':scope > .empty', section).textContent = isEmpty ? 'No lining scans at this site.' : '';
  $('#lining-when').textContent = isEmpty ? '' : `${plural(scans.length, 'station')}, newest scan ${dayAndClock(scans[0].made_ms)}`;
  if (isEmpty) return;
  heat.show(scans);
  ringPlot.show(curvesOf(rings.map(([ring, ms, inward_m]) => [ring, ms, 1e3 * inward_m]), (ring) => 'ring ' + ring).sort((a, b) => last(b) - last(a)));
  const sorted = [...lines].sort((a, b) => Math.abs(b.change_m) - Math.abs(a.change_m));
  const body = $('#lines tbody'), row = (line) => make('tr', {}, make('td', { className: 'number', textContent: line.ring }), make('td', { textContent: line.name }),
    make('td', { className: 'number', textContent: `${mm(line.change_m)} \u00b1 ${mm(line.std_m)}` }), make('td', { className: 'number', textContent: line.before_m == null ? '' : mm(line.before_m) }));
  body.replaceChildren(...sorted.slice(0, kLines).map(row));
  if (sorted.length > kLines) {
    const more = make('button', { type: 'button', textContent: `All ${sorted.length}`, onclick: () => body.replaceChildren(...sorted.map(row)) });
    const cell = make('td', {}, more);
    cell.colSpan = 4;
    body.append(make('tr', {}, cell));
  }
}

export function showWater(list) {
  const section = $('#water');
  $('.empty', section).textContent = list.length ? '' : 'No TEM soundings at this site.';
  $('#water-when').textContent = list.length ? dayAndClock(list[0].made_ms) : '';
  $('.content', section).replaceChildren(...list.slice(0, 3).map(({ data, robot }) => {
    const facts = [['Station', humanize(data.station)], ['By', `${robot}, ${plural(data.soundings, 'sounding')}`]];
    if (data.found) {
      const [near, far] = data.distance_interval_m, [thin, thick] = data.radius_interval_m;
      const side = data.azimuth_deg >= 0 ? 'left' : 'right', height = data.elevation_deg >= 0 ? 'up' : 'down';
      facts.unshift(['Distance', `${near.toFixed(1)} \u2026 ${far.toFixed(1)} m from the antenna`], ['Direction', `${Math.abs(data.azimuth_deg).toFixed(0)}\u00b0 to the ${side}, ${Math.abs(data.elevation_deg).toFixed(0)}\u00b0 ${height}`],
        ['Radius', `${data.radius_m == null ? '?' : data.radius_m.toFixed(1)} m (${thin.toFixed(1)} \u2026 ${thick.toFixed(1)} m)`]);
    }
    if (data.evidence != null) facts.push(['Evidence', `${data.evidence.toFixed(1)} (log Bayes factor, water vs. no water)`]);
    if (data.antenna_error_deg != null) facts.push(['Antenna', `${data.antenna_error_deg.toFixed(2)}\u00b0 RMS error`]);
    const word = data.found ? `Water, ${data.distance_m == null ? '?' : data.distance_m.toFixed(1)} m ahead` : 'No water found';
    return make('article', {}, make('p', { className: 'word ' + (data.found ? data.level : 'good'), textContent: word }),
      make('dl', {}, ...facts.flatMap(([name, value]) => [make('dt', { textContent: name }), make('dd', { textContent: value })])));
  }));
}

export function showGas(points) {
  $('#gas .empty').textContent = points.length ? '' : 'No gas measurements at this site.';
  gasPlot.show(curvesOf(points, humanize).sort((a, b) => last(b) - last(a)));
  $('#gas-plot').hidden = !points.length;
}
