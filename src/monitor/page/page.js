// Polls the server for changes once per second and updates the page. Data from robots are inserted as text, never as
// markup.
import { MapView } from '/map.js';
import { showGas, showLining, showWater } from '/site.js';
import { $, clock, dayAndClock, make, plural, simulated, humanize } from '/format.js';

const kPeriod_ms = 1000, kTimeout_ms = 15000, kHistoryRows = 25;
const state = { revision: 0, robots: new Map(), findings: new Map(), chosen: null, run: '', onlyOpen: true, skew_ms: 0, water: [], details: null, wanted: null, missed: new Set() };

function age(ms) {
  const seconds = Math.max(0, Math.round((Date.now() + state.skew_ms - ms) / 1000));
  if (seconds < 60) return `${seconds} s ago`;
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min ago`;
  return seconds < 86400 ? `${Math.floor(seconds / 3600)} h ago` : `${Math.floor(seconds / 86400)} d ago`;
}
const ageOf = (ms) => { const element = make('span', { textContent: age(ms) }); element.dataset.ms = ms; return element; };

async function ask(path, parameters = {}) {
  const answer = await fetch(path + '?' + new URLSearchParams(parameters), { signal: AbortSignal.timeout(10000) });
  if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
  return answer.json();
}

const kMaxPages = 100;

/// Requests all pages of a response. `next(page)` returns the parameters of the following page, or null.
async function askAll(path, parameters, next, merge) {
  const all = await ask(path, parameters);
  for (let i = 1, more = next(all); more && i < kMaxPages; ++i) {
    const page = await ask(path, { ...parameters, ...more });
    merge(all, page);
    more = next(page);
  }
  return all;
}

const askRobots = () => askAll('/api/robots', {}, (page) => (page.more ? { after: page.robots[page.robots.length - 1].robot } : null), (all, page) => all.robots.push(...page.robots));

const askRun = (robot, run) => askAll('/api/run', { robot, run }, (page) => (page.next_station == null ? null : { run: page.run, station: page.next_station }),
  (all, page) => all.stations.push(...page.stations));

const askLining = (world) => askAll('/api/lining', { world }, (page) => (page.next == null ? null : { after: page.next }), (all, page) => {
  for (const scan of page.scans) {  // a long scan continues on the next page
    const last = all.scans[all.scans.length - 1];
    if (last && last.seq === scan.seq) last.data.cells.push(...scan.data.cells);
    else all.scans.push(scan);
  }
  all.lines.push(...page.lines);
  all.rings.push(...page.rings);
});

/// Runs a refresh and repeats it after the next response of the server if it fails.
const attempt = (refresh) => { refresh().catch(() => state.missed.add(refresh)); };

// ---- Robots ----

const kStates = { started: ['running', 'notice'], finished: ['finished', 'good'], failed: ['failed', 'warning'], interrupted: ['interrupted', 'warning'] };

function stateOf(robot) {
  const isTimedOut = robot.state === 'started' && Date.now() + state.skew_ms - robot.received_ms > kTimeout_ms;
  return isTimedOut ? ['no data', 'warning'] : kStates[robot.state] || [robot.state, 'none'];
}

function showRobots() {
  const list = [...state.robots.values()].sort((a, b) => a.world.localeCompare(b.world) || a.robot.localeCompare(b.robot, undefined, { numeric: true }));
  $('#robot-count').textContent = list.length ? String(list.length) : '';
  $('.robots').replaceChildren(...list.map((robot) => {
    const [word, tone] = stateOf(robot);
    const button = make('button', { type: 'button', onclick: () => choose(robot.robot) }, make('b', { textContent: robot.robot }), make('span', { className: 'state ' + tone, textContent: word }),
      make('span', { className: 'faint' }, `${robot.world}${robot.at ? ', at ' + humanize(robot.at) : ''} \u00b7 ${simulated(robot.time_s)} simulated \u00b7 `, ageOf(robot.received_ms)),
      ...(robot.message && robot.state !== 'finished' ? [make('span', { className: 'faint', textContent: robot.message })] : []));
    button.setAttribute('aria-pressed', robot.robot === state.chosen);
    return make('li', {}, button);
  }), ...(list.length ? [] : [make('li', { className: 'calm-note', textContent: 'No robots yet.' })]));
}

function choose(name) {
  if (state.chosen === name) return;
  Object.assign(state, { chosen: name, run: '', details: null });
  showRobots();
  attempt(refreshRun);
  attempt(refreshWorld);
}

// ---- Alarms ----

function showAlarms() {
  const all = [...state.findings.values()].sort((a, b) => b.number - a.number);
  const shown = all.filter((one) => !state.onlyOpen || one.acknowledged_ms == null).slice(0, 200);
  $('.alarms').replaceChildren(...shown.map(alarmRow), ...(shown.length ? [] : [make('li', { className: 'calm-note', textContent: state.onlyOpen ? 'No open alarms.' : 'No alarms.' })]));
  for (const button of document.querySelectorAll('.choice button')) button.setAttribute('aria-pressed', String(state.onlyOpen === (button.dataset.open === '1')));
}

function alarmRow(one) {
  const isDone = one.acknowledged_ms != null;
  const row = make('li', { className: one.level + (isDone ? ' done' : '') }, make('span', { className: 'level', textContent: one.level }));
  row.dataset.number = one.number;
  if (!isDone) row.append(make('button', { type: 'button', textContent: 'Acknowledge', onclick: () => openDialog(one) }));
  row.append(make('p', { className: 'text', textContent: one.text || humanize(one.kind) }), make('p', { className: 'faint' }, `${one.robot} \u00b7 ${one.world} \u00b7 `, ageOf(one.received_ms)));
  if (isDone) row.append(make('p', { className: 'faint', textContent: `Acknowledged by ${one.who}, ${dayAndClock(one.acknowledged_ms)}${one.note ? ': ' + one.note : ''}` }));
  return row;
}

function showCount(open) {
  const levels = ['alarm', 'warning'].filter((level) => open[level] > 0);
  $('#count').replaceChildren(...(levels.length ? levels.map((level) => make('b', { className: level, textContent: plural(open[level], level) })) : [make('span', { className: 'calm', textContent: 'no open alarms' })]));
  const sum = open.alarm + open.warning;
  document.title = (sum ? `(${sum}) ` : '') + 'Patrol';
}

const dialog = $('#acknowledge');
let asked = null;

function openDialog(finding) {
  asked = finding;
  $('.finding', dialog).textContent = finding.text;
  $('.error', dialog).textContent = '';
  $('[name=note]', dialog).value = '';
  $('[name=who]', dialog).value = sessionStorage.getItem('who') || '';
  needToken(!sessionStorage.getItem('token'));
  dialog.showModal();
}

function needToken(isNeeded) {
  for (const element of dialog.querySelectorAll('.token')) element.hidden = !isNeeded;
  $('[name=token]', dialog).required = isNeeded;
}

$('[value=cancel]', dialog).addEventListener('click', () => dialog.close());
$('form', dialog).addEventListener('submit', async (event) => {
  event.preventDefault();
  const who = $('[name=who]', dialog).value.trim(), note = $('[name=note]', dialog).value.replace(/\s+/g, ' ').trim();
  const token = sessionStorage.getItem('token') || $('[name=token]', dialog).value.trim();
  try {
    const answer = await fetch(`/api/alarms/${asked.number}/acknowledge`, { method: 'POST', headers: { Authorization: 'Bearer ' + token, 'Content-Type': 'application/json' }, body: JSON.stringify({ who, note }) });
    if (answer.status === 401) {
      sessionStorage.removeItem('token');
      needToken(true);
      $('.error', dialog).textContent = 'Invalid token.';
      return;
    }
    if (!answer.ok && answer.status !== 409) throw new Error((await answer.json()).error);
    sessionStorage.setItem('token', token);
    sessionStorage.setItem('who', who);
    dialog.close();
    await poll();
  } catch (error) {
    $('.error', dialog).textContent = error.message || 'Server not responding.';
  }
});

// ---- Run of the selected robot, and its world ----

const map = new MapView($('#map'));

async function refreshRun() {
  const { chosen, run } = state;
  if (!chosen) return map.show(null, [], []);
  const details = await askRun(chosen, run);
  if (chosen !== state.chosen || run !== state.run) return;
  state.details = details;
  $('#run').replaceChildren(...details.runs.map((one, i) => make('option', { value: i === 0 ? '' : one.run, textContent: `${dayAndClock(one.first_ms)}  ${one.run}`, selected: one.run === details.run })));
  showMap();
}

function showMap() {
  const { details } = state, robot = state.robots.get(state.chosen);
  if (!details || !robot) return;
  // Robots of one scenario have the same start pose, so their maps have a common origin.
  const isLive = robot.run === details.run;
  const others = [...state.robots.values()].filter((one) => one !== robot && one.world === robot.world && one.scenario === robot.scenario);
  map.show(details, state.water.filter((one) => one.run === details.run), isLive ? [robot, ...others] : []);
  const keys = [['track', '', 'track'], ['accent', 'dot', 'robot'], ['soft', 'ring', 'station']];
  if (details.findings.length) keys.push(['alarm', 'dot', 'finding']);
  if (state.water.some((one) => one.run === details.run && one.data.found)) keys.push(['water', 'ring', 'water: size, and 95 % ellipse of its center (dashed)']);
  $('.legend').replaceChildren(...keys.map(([ink, shape, word]) => {
    const key = make('span', { className: shape, textContent: word });
    key.style.setProperty('--ink', `var(--${ink})`);
    return key;
  }));
}

async function refreshWorld() {
  const robot = state.robots.get(state.chosen), world = robot ? robot.world : '';
  $('#site').textContent = world ? 'Site: ' + world : '';
  const [lining, water, gas] = await Promise.all([askLining(world), ask('/api/water', { world }), ask('/api/gas', { world })]);
  const now = state.robots.get(state.chosen);
  if ((now ? now.world : '') !== world) return;
  state.water = water.water;
  showLining(lining);
  showWater(water.water);
  showGas(gas.gas);
  showMap();
}

$('#run').addEventListener('change', (event) => {
  state.run = event.target.value;
  attempt(refreshRun);
});

// ---- History ----

const pages = [0];  // `before` of each page up to this one

function summary({ kind, data }) {
  if (kind === 'event') return data.text || humanize(data.kind);
  if (kind === 'status') return `${kStates[data.state] ? kStates[data.state][0] : data.state}${data.message ? ': ' + data.message : ''}`;
  if (kind === 'lining') return data.registered ? `Lining at ${humanize(data.station)}: ${plural(sizeOf(data.findings), 'ring')} moved` : `Lining at ${humanize(data.station)}: registration failed`;
  if (kind === 'water') return data.found ? `Water ${data.distance_m == null ? '?' : data.distance_m.toFixed(1)} m from the antenna` : `No water at ${humanize(data.station)}`;
  if (kind === 'pose') return `x ${data.x.toFixed(2)} m, y ${data.y.toFixed(2)} m, heading ${(data.yaw * 180 / Math.PI).toFixed(0)}\u00b0`;
  return kind === 'map' ? `${data.width} x ${data.height} cells of ${data.resolution_m} m` : '';
}
const sizeOf = (list) => (Array.isArray(list) ? list.length : list);  // the server sends only the length of long lists

async function refreshHistory() {
  const wanted = { robot: $('#history-robot').value, kind: $('#history-kind').value, before: pages[pages.length - 1], limit: kHistoryRows };
  state.wanted = wanted;
  const { results, more } = await ask('/api/history', wanted);
  if (state.wanted !== wanted) return;  // another page was requested meanwhile
  $('#history tbody').replaceChildren(...results.map((one) => make('tr', {}, make('td', { textContent: dayAndClock(one.received_ms) }), make('td', { textContent: one.robot }),
    make('td', { textContent: simulated(one.time_s), title: 'time of run ' + one.run }), make('td', { textContent: one.kind === 'event' ? humanize(one.data.kind) : one.kind }), make('td', { textContent: summary(one) }))));
  $('#newer').disabled = pages.length === 1;
  $('#older').disabled = !more;
  $('#older').onclick = () => { pages.push(results[results.length - 1].seq); attempt(refreshHistory); };
}
$('#newer').addEventListener('click', () => { pages.pop(); attempt(refreshHistory); });
for (const id of ['#history-robot', '#history-kind']) $(id).addEventListener('change', () => { pages.length = 1; attempt(refreshHistory); });

function showHistoryRobots() {
  const select = $('#history-robot'), names = [...state.robots.keys()].sort((a, b) => a.localeCompare(b, undefined, { numeric: true }));
  if (select.options.length === names.length + 1) return;
  const before = select.value;
  select.replaceChildren(make('option', { value: '', textContent: 'all robots' }), ...names.map((name) => make('option', { value: name, textContent: name })));
  select.value = before;
}

// ---- Changes ----

function showLive(isOn) {
  const live = $('#live');
  if (isOn) state.lastResponse_ms = Date.now();
  live.className = isOn ? 'on' : 'off';
  live.textContent = isOn ? 'live' : `no response since ${state.lastResponse_ms ? clock(state.lastResponse_ms) : 'the start'}`;
}

async function poll() {
  const news = await ask('/api/changes', { since: state.revision });
  if (news.more_robots) news.robots = (await askRobots()).robots;
  showLive(true);
  const missed = [...state.missed];
  state.missed.clear();
  missed.forEach(attempt);
  if (news.revision < state.revision) return location.reload();  // the server has another database
  const isFirst = state.revision === 0;
  Object.assign(state, { revision: news.revision, skew_ms: news.now_ms - Date.now() });
  const before = state.robots.get(state.chosen), marked = news.robots.filter((robot) => (state.robots.get(robot.robot) || { mark_revision: -1 }).mark_revision !== robot.mark_revision);
  for (const robot of news.robots) state.robots.set(robot.robot, robot);
  for (const finding of news.findings) state.findings.set(finding.number, finding);
  showCount(news.open);
  if (news.findings.length || isFirst) showAlarms();
  if (!state.chosen && state.robots.size) choose([...state.robots.values()].reduce((a, b) => (b.received_ms > a.received_ms ? b : a)).robot);
  const robot = state.robots.get(state.chosen);
  if (news.robots.length || isFirst) {
    showRobots();
    showHistoryRobots();
  }
  if (marked.length && pages.length === 1) attempt(refreshHistory);
  if (robot && before && before.run !== robot.run) state.run = '';
  if (marked.some((one) => robot && one.world === robot.world)) attempt(refreshWorld);
  if (marked.includes(robot) || (before && robot.run !== before.run) || news.findings.some((one) => one.robot === state.chosen)) attempt(refreshRun);
  else if (news.robots.includes(robot)) followTrack(robot);
  if (isFirst) attempt(refreshHistory);
  if (isFirst && !robot) attempt(refreshWorld);
}

/// Extends the track by new poses between two responses of /api/run.
function followTrack(robot) {
  const { details } = state;
  if (!details || robot.x == null || details.run !== robot.run) return;
  const track = details.track, end = track[track.length - 1];
  if (!end || Math.hypot(end[0] - robot.x, end[1] - robot.y) > 0.05) track.push([robot.x, robot.y]);
  showMap();
}

for (const button of document.querySelectorAll('.choice button')) {
  button.addEventListener('click', () => {
    state.onlyOpen = button.dataset.open === '1';
    showAlarms();
  });
}

async function live() {
  try {
    await poll();
  } catch {
    showLive(false);
  }
  setTimeout(live, kPeriod_ms);
}
setInterval(() => {
  for (const element of document.querySelectorAll('[data-ms]')) element.textContent = age(Number(element.dataset.ms));
  if ([...state.robots.values()].some((robot) => robot.state === 'started')) showRobots();
}, 5000);
live();
