// The page's half of the connection: frames in, cameras out.
#include "apps/view/page.h"

namespace delray::apps::view::internal {

const char* const kConnection = R"js(
let socket = null, retry = 500, shown = 0, number = 0, isMoving = false, isChanged = false, quiet = 0;
let lastFile = null, lastHeader = null;
const own = new Map();  // options of this page alone, as it has set them
const recent = [];      // times of frames that move, of the last second
let moved = 0;          // how many there were in all
const drawn = canvas.getContext('2d');

const say = message => {
  if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
};

let noteTimer = 0;
const note = (text, good = false) => {
  const box = element('note');
  box.textContent = text;
  box.className = text ? 'shown' + (good ? ' good' : '') : '';
  clearTimeout(noteTimer);
  noteTimer = setTimeout(() => { box.className = ''; }, good ? 3000 : 9000);
};
const wait = (text, done = 0, total = 0) => {
  element('waiting').classList.toggle('hidden', !text);
  if (!text) return;
  element('waitingtext').textContent = text;
  const bar = element('progress');
  if (total > 0) { bar.max = total; bar.value = Math.min(done, total); } else bar.removeAttribute('value');
};

// What goes on beside a picture is told below it, and what there is no picture without, in the middle.
const tellProgress = m => {
  if (!lastHeader || !m.text) wait(m.text, m.done, m.total);
  element('loading').textContent = !m.text ? '' :
    m.text + (m.total > 0 ? ' ' + Math.floor(100 * Math.min(1, m.done / m.total)) + ' %' : ' \u2026');
};

const size = () => {
  const dense = window.devicePixelRatio || 1, side = x => Math.max(1, Math.min(8192, Math.round(x * dense)));
  return {width: side(canvas.clientWidth), height: side(canvas.clientHeight)};
};

const sendCamera = () => {
  if (!camera) return;
  say({type: 'camera', number: ++number, moving: isMoving, eye: camera.eye, at: camera.at, up: camera.up,
       fov: camera.fov, height: camera.height, clip: clipped()});
};
// At most once for each picture that the screen shows.
const changed = () => {
  drawOverlay();
  showCut();
  if (isChanged) return;
  isChanged = true;
  requestAnimationFrame(() => { isChanged = false; sendCamera(); });
};
// A gesture goes on, or has ended: only then better pictures are worth while.
const moving = () => { isMoving = true; clearTimeout(quiet); };
const rested = (after = 0) => {
  clearTimeout(quiet);
  quiet = setTimeout(() => { isMoving = false; sendCamera(); }, after);
};
const movedOnce = () => { moving(); changed(); rested(160); };

const watch = () => say({type: 'watch', visible: !document.hidden, figures: element('ranks').getAttribute('aria-pressed') === 'true'});

const tellNumbers = () => {
  if (!lastHeader) return;
  const h = lastHeader, now = performance.now();
  while (recent.length && now - recent[0] > 1000) recent.shift();
  const parts = [h.width + ' \u00d7 ' + h.height];
  if (h.stage === 'moving') parts.push(recent.length + ' frames/s');
  else if (h.samples) parts.push(Math.round(h.samples) + (h.samples === 1 ? ' sample' : ' samples') + (h.complete ? '' : ', growing'));
  parts.push((1000 * h.render_seconds).toFixed(h.render_seconds < 0.1 ? 1 : 0) + ' ms');
  element('numbers').textContent = parts.join(' \u00b7 ');
};

const takeFrame = async bytes => {
  const view = new DataView(bytes), length = view.getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  const file = new Blob([new Uint8Array(bytes, 4 + length)], {type: header.type});
  const bitmap = await createImageBitmap(file);
  say({type: 'seen', frame: header.frame});
  if (header.frame < shown) return bitmap.close();
  shown = header.frame;
  if (canvas.width !== header.width || canvas.height !== header.height) {
    canvas.width = header.width;
    canvas.height = header.height;
  } else drawn.clearRect(0, 0, canvas.width, canvas.height);
  drawn.drawImage(bitmap, 0, 0);
  bitmap.close();
  if (header.stage === 'moving') {
    ++moved;
    recent.push(performance.now());
  }
  lastHeader = header;
  lastFile = header.complete ? file : null;
  wait('');
  tellNumbers();
  document.body.dataset.stage = header.stage;
  document.body.dataset.complete = header.complete;
  document.body.dataset.frame = header.frame;
};

const handlers = {
  scene: m => {
    // Of points there are some before all are there, and others may be in the middle of them.
    const by = scene && camera ? sub(scene.origin, m.origin) : [0, 0, 0];
    scene = m;
    element('loading').textContent = '';
    if (length(by) > 0) {
      const asPlaced = isAsPlaced();
      shift(by);
      if (asPlaced) placed = {...camera};
      if (cutAt) cutAt = add(cutAt, by);
      picks = [];
      showFacts();
      changed();
    }
    element('name').textContent = m.name.replace(/^.*\//, '');
    document.title = m.name.replace(/^.*\//, '') + ' \u2013 delray view';
    const count = n => n.toLocaleString('en').replace(/,/g, '\u202f');
    element('name').title = [m.triangles && count(m.triangles) + ' triangles', m.points && count(m.points) + ' points',
      m.instances > 1 && count(m.instances) + ' instances'].filter(Boolean).join(', ');
    element('views').replaceChildren(new Option('View', ''), ...m.views.map(v => new Option(v, v)));
    if (!lastHeader) wait('Rendering');
  },
  // A page that comes back keeps its camera where it was moved, and so does one where only some of
  // the scene was there before.
  camera: m => {
    if (camera && !awaitsView && !isAsPlaced()) return sendCamera();
    awaitsView = false;
    camera = {eye: m.eye, at: m.at, up: m.up, fov: m.fov, height: m.height};
    placed = {...camera};
    if (m.clip > 0) cutAt = add(camera.eye, times(axes().forward, m.clip));
    else if (cutAt) changed();
    showCut();
    drawOverlay();
  },
  panel: m => showPanel(m),
  pick: m => showPick(m),
  figures: m => showFigures(m),
  command: m => copied(m.text),
  progress: m => tellProgress(m),
  error: m => { note(m.text); if (lastHeader) wait(''); },
};
let awaitsView = true, placed = null;  // placed: the camera as the server has placed it
const isAsPlaced = () => JSON.stringify(camera) === JSON.stringify(placed);

const connect = () => {
  socket = new WebSocket('ws://' + location.host + '/socket' + location.search);
  socket.binaryType = 'arraybuffer';
  socket.onopen = () => {
    retry = 500;
    shown = 0;
    document.body.dataset.connected = true;
    if (!lastHeader) wait('Waiting for the scene');
    say({type: 'hello', ...size(), options: Object.fromEntries(own)});
    watch();
    sendCamera();
  };
  socket.onmessage = event => {
    if (typeof event.data !== 'string') return takeFrame(event.data);
    const message = JSON.parse(event.data), handle = handlers[message.type];
    if (handle) handle(message);
  };
  socket.onclose = event => {
    delete document.body.dataset.connected;
    wait(event.reason ? 'Disconnected: ' + event.reason : lastHeader || retry > 500 ?
      'Disconnected; trying again. A server that was started anew has printed a new address.' : 'Connecting');
    setTimeout(connect, retry);
    retry = Math.min(retry * 1.6, 5000);
  };
};
)js";

}  // namespace delray::apps::view::internal
