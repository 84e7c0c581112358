#include "apps/report/internal/style.h"

namespace delray::apps::report::internal {

// The colours of series can be told apart with any colour vision (Okabe and Ito 2008), darker on
// white.
const char* const kStyle = R"css(
:root{color-scheme:light dark;--paper:#fff;--ink:#1c2126;--soft:#5c6670;--line:#dfe3e8;
--panel:#f5f7f9;--accent:#0067b0;--warn:#9a4a00;
--c0:#005a9c;--c1:#c75100;--c2:#00856a;--c3:#a8477d;--c4:#4fabe0;--c5:#a87c00;--c6:#4b4b9e;--c7:#4a4f55}
@media (prefers-color-scheme:dark){:root{--paper:#14181c;--ink:#e6eaee;--soft:#9aa5b0;--line:#2d343b;
--panel:#1c2227;--accent:#5cb3f0;--warn:#f0a35c;
--c0:#86c8fa;--c1:#f08a4b;--c2:#3cc9a7;--c3:#e08fbd;--c4:#2f86dd;--c5:#e6c04d;--c6:#a3a3f0;--c7:#b8bec4}}
*{box-sizing:border-box}
body{margin:0 auto;max-width:76rem;padding:1.2rem 1.4rem 3rem;background:var(--paper);color:var(--ink);
font:16px/1.5 system-ui,"Segoe UI","Liberation Sans",sans-serif}
h1{font-size:1.5rem;line-height:1.25;margin:.2rem 0 .8rem}
h2{font-size:1.15rem;margin:1.2rem 0 .6rem}
h3{font-size:1rem;margin:1.2rem 0 .4rem}
p{max-width:46rem}
.answer{border-left:4px solid var(--accent);background:var(--panel);padding:.6rem 1rem;margin-bottom:1rem}
.answer p{margin:.3rem 0}
.answer .table{max-height:none}
.answer th{background:var(--panel)}
.answer th,.answer td{padding:.2rem .5rem}
.answer strong{font-weight:650}
.unfinished{color:var(--warn);font-weight:600}
nav{display:flex;flex-wrap:wrap;gap:.3rem;border-bottom:1px solid var(--line);position:sticky;top:0;
background:var(--paper);padding-top:.3rem;z-index:1}
nav button{font:inherit;color:inherit;background:none;border:0;border-bottom:3px solid transparent;
padding:.4rem .8rem;cursor:pointer}
nav button[aria-selected=true]{border-color:var(--accent);font-weight:600}
#csv{margin-left:auto;border:1px solid var(--line);border-radius:4px;margin-bottom:.3rem}
button:focus-visible,[tabindex]:focus-visible{outline:2px solid var(--accent);outline-offset:1px}
section.hidden{display:none}
section>h2{position:absolute;left:-99rem}
.beside{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(20rem,100%),1fr));gap:1rem}
.pairs{grid-template-columns:repeat(auto-fit,minmax(min(29rem,100%),1fr))}
.beside figure{margin:.4rem 0}
figure{margin:1rem 0;padding:0}
figcaption{font-weight:600;font-size:.95rem;margin-bottom:.3rem}
figure svg{display:block;width:100%;height:auto}
.chart{max-width:52rem}
.pairs text{font-size:15px}.pairs text.tick{font-size:14px}
.picture img{max-width:100%;height:auto;border:1px solid var(--line);
background:repeating-conic-gradient(var(--panel) 0 25%,var(--line) 0 50%) 0 0/16px 16px}
.picture figcaption{font-weight:400;color:var(--soft)}
text{fill:var(--ink);font-size:12px}
text.tick{fill:var(--soft);font-size:11px}
.grid{stroke:var(--line)}
.frame{fill:none;stroke:var(--line)}
.line,.spread{pointer-events:none}
.line{fill:none;stroke-width:2}
.spread{fill:none;stroke-width:1.5;opacity:.5}
.predicted .line,.key.predicted .line{stroke-dasharray:2 4}
.predicted .point{fill:var(--paper)}
.point{stroke-width:1.5}
.d1 .line,.key.d1 .line{stroke-dasharray:7 3}
.d2 .line,.key.d2 .line{stroke-dasharray:7 2 2 2}
.c0{stroke:var(--c0);fill:var(--c0)}.c1{stroke:var(--c1);fill:var(--c1)}
.c2{stroke:var(--c2);fill:var(--c2)}.c3{stroke:var(--c3);fill:var(--c3)}
.c4{stroke:var(--c4);fill:var(--c4)}.c5{stroke:var(--c5);fill:var(--c5)}
.c6{stroke:var(--c6);fill:var(--c6)}.c7{stroke:var(--c7);fill:var(--c7)}
.series .line,.series .spread,.key .line{fill:none}
.series.off{display:none}
.series.dim{opacity:.15}
.bar{fill:var(--c4)}.bar.emphasised{fill:var(--c1)}
text.value{paint-order:stroke;stroke:var(--paper);stroke-width:4px;stroke-linejoin:round}
.mark{stroke:var(--ink);stroke-width:1.5;stroke-dasharray:5 3}
.cell{fill:var(--c0)}
.span{stroke:none}
.span.idle{fill:var(--line);background:var(--line)}
.backdrop{position:absolute}
.overlay rect{shape-rendering:crispEdges}.overlay svg{border:1px solid var(--line)}
.above{fill:#e66100;background:#e66100}.below{fill:#1a6fdf;background:#1a6fdf}
.amount{fill:#c01030}.group{fill-opacity:.6}
.overlay rect:hover{stroke:#fff;stroke-width:3}
.border{fill:none;stroke:#000;stroke-width:1.5;stroke-opacity:.75;pointer-events:none}
.legend i:not(.span){display:inline-block;width:.9em;height:.9em;margin-right:.4em;vertical-align:-.1em;
border:1px solid var(--line)}
i.span{display:inline-block;width:.9em;height:.9em;margin-right:.4em;vertical-align:-.1em}
i.c0{background:var(--c0)}i.c1{background:var(--c1)}i.c2{background:var(--c2)}i.c3{background:var(--c3)}
i.c4{background:var(--c4)}i.c5{background:var(--c5)}i.c6{background:var(--c6)}i.c7{background:var(--c7)}
.legend{display:flex;flex-wrap:wrap;gap:.1rem .9rem;margin-top:.3rem;font-size:.85rem}
.key{font:inherit;color:var(--ink);background:none;border:0;padding:.1rem .2rem;cursor:pointer;stroke:none}
.key svg{display:inline-block;width:24px;height:8px;margin-right:.4rem}
.key.c0 .line{stroke:var(--c0)}.key.c1 .line{stroke:var(--c1)}.key.c2 .line{stroke:var(--c2)}
.key.c3 .line{stroke:var(--c3)}.key.c4 .line{stroke:var(--c4)}.key.c5 .line{stroke:var(--c5)}
.key.c6 .line{stroke:var(--c6)}.key.c7 .line{stroke:var(--c7)}
.key[aria-pressed=false]{opacity:.4;text-decoration:line-through}
.source{font-weight:400;font-size:.72rem;color:var(--soft);border:1px solid var(--line);border-radius:3px;
padding:0 .25rem;margin-left:.35rem;white-space:nowrap}
.table{overflow-x:auto;max-height:34rem;overflow-y:auto}
table{border-collapse:collapse;font-size:.88rem}
th,td{padding:.2rem .7rem;border-bottom:1px solid var(--line);text-align:left;white-space:nowrap}
th{position:sticky;top:0;background:var(--paper);cursor:pointer;vertical-align:bottom}
th .source{display:table;margin:.1rem 0 0}
.number{text-align:right;font-variant-numeric:tabular-nums}
th.number .source{margin-left:auto}
tr.emphasised{background:var(--panel);font-weight:600}
footer{margin-top:2rem;border-top:1px solid var(--line);font-size:.88rem}
dl{display:grid;grid-template-columns:max-content 1fr;gap:.15rem 1rem}
dt{color:var(--soft)}dd{margin:0;overflow-wrap:anywhere}
#tip{position:fixed;display:none;pointer-events:none;background:var(--ink);color:var(--paper);
font-size:.82rem;padding:.25rem .5rem;border-radius:4px;max-width:24rem;z-index:2}
@media(max-width:40rem){.chart text{font-size:17px}.chart text.tick{font-size:16px}
.timeline text,.timeline text.tick{font-size:20px}}
@media print{html{font-size:12.5px}body{padding:0;font-size:1rem}nav,#tip{display:none}section.hidden{display:block}section>h2{position:static}
h2,h3,figcaption{break-after:avoid}.legend,.overlay,.picture,.cell{print-color-adjust:exact}
.table{max-height:none;overflow:visible}figure,tr{break-inside:avoid}
.beside{display:block}.beside figure{display:inline-block;width:32%;margin:.2rem 0;vertical-align:top}
.pairs figure,.beside figure:first-child:nth-last-child(2),
.beside figure:first-child:nth-last-child(2)~figure{width:49%}
.pairs text,.pairs text.tick{font-size:18px}
table{font-size:.65rem}th,td{padding:.1rem .25rem}th{white-space:normal}
.answer table{font-size:.8rem}.answer th,.answer td{padding:.1rem .3rem}
.table .source{font-size:.55rem;padding:0 .1rem}}
)css";

const char* const kScript = R"js(
'use strict';
(() => {
  const all = (what, where = document) => [...where.querySelectorAll(what)];
  const data = JSON.parse(document.getElementById('data').textContent);

  const tabs = all('[role=tab]');
  const show = tab => tabs.forEach(t => {
    t.setAttribute('aria-selected', t === tab);
    document.getElementById(t.getAttribute('aria-controls')).classList.toggle('hidden', t !== tab);
  });
  tabs.forEach((tab, i) => {
    tab.addEventListener('click', () => show(tab));
    tab.addEventListener('keydown', e => {
      const step = {ArrowRight: 1, ArrowLeft: -1}[e.key];
      if (!step) return;
      const next = tabs[(i + step + tabs.length) % tabs.length];
      next.focus();
      show(next);
    });
  });

  // A link may name a tab: page.html#one-run.
  const linked = tabs.find(tab =>
    '#' + tab.textContent.toLowerCase().replace(/ /g, '-') === location.hash);
  if (linked) show(linked);

  // Numbers on hover, at once and in the page's own style.
  const tip = document.getElementById('tip');
  all('svg title').forEach(title => {
    const mark = title.parentNode;
    mark.dataset.tip = title.textContent;
    mark.setAttribute('aria-label', title.textContent);
    title.remove();
  });
  const put = (text, x, y) => {
    tip.textContent = text;
    tip.style.display = 'block';
    tip.style.left = Math.max(4, Math.min(x + 12, innerWidth - tip.offsetWidth - 4)) + 'px';
    tip.style.top = (y + tip.offsetHeight + 20 > innerHeight ? y - tip.offsetHeight - 8 : y + 14) + 'px';
  };
  const hide = () => { tip.style.display = 'none'; };
  document.addEventListener('pointermove', e => {
    const mark = e.target.closest && e.target.closest('[data-tip]');
    if (mark) put(mark.dataset.tip, e.clientX, e.clientY); else hide();
  });
  document.addEventListener('focusin', e => {
    if (!e.target.dataset || !e.target.dataset.tip) return;
    const box = e.target.getBoundingClientRect();
    put(e.target.dataset.tip, box.right, box.top);
  });
  document.addEventListener('focusout', hide);

  all('figure.chart').forEach(figure => all('button.key', figure).forEach(key => {
    const series = all('g.series', figure);
    const own = series.find(g => g.dataset.series === key.dataset.series);
    key.addEventListener('click', () => {
      const on = key.getAttribute('aria-pressed') !== 'true';
      key.setAttribute('aria-pressed', on);
      if (own) own.classList.toggle('off', !on);
    });
    const dim = on => series.forEach(g => g.classList.toggle('dim', on && g !== own));
    key.addEventListener('pointerenter', () => dim(true));
    key.addEventListener('pointerleave', () => dim(false));
  }));

  all('table.sortable').forEach(table => all('th', table).forEach((head, column) => {
    const sort = () => {
      const down = head.dataset.sorted === 'up';
      all('th', table).forEach(h => delete h.dataset.sorted);
      head.dataset.sorted = down ? 'down' : 'up';
      const value = row => {
        const text = row.cells[column].textContent, number = parseFloat(text);
        return head.classList.contains('number') ? (isNaN(number) ? Infinity : number) : text;
      };
      const rows = [...table.tBodies[0].rows];
      rows.sort((a, b) => {
        const x = value(a), y = value(b);
        return (x < y ? -1 : x > y ? 1 : 0) * (down ? -1 : 1);
      });
      table.tBodies[0].append(...rows);
    };
    head.addEventListener('click', sort);
    head.addEventListener('keydown', e => { if (e.key === 'Enter') sort(); });
  }));

  // Members of objects become columns; elements of lists are named by their first text.
  const flatten = (value, name, into) => {
    if (Array.isArray(value)) {
      value.forEach((element, i) => {
        const key = element && typeof element === 'object' && Object.keys(element)
          .find(k => typeof element[k] === 'string');
        if (!key) return flatten(element, name + '.' + i, into);
        const {[key]: label, ...rest} = element;
        flatten(rest, name + '.' + label, into);
      });
    } else if (value && typeof value === 'object') {
      Object.entries(value).forEach(([k, v]) => flatten(v, name ? name + '.' + k : k, into));
    } else {
      into[name] = value;
    }
    return into;
  };
  const csv = () => {
    const rows = (data.rows || []).map(row => flatten(row, '', {}));
    const columns = [...new Set(rows.flatMap(row => Object.keys(row)))];
    const cell = v => v === null || v === undefined ? '' :
      /[",\n]/.test(v) ? '"' + String(v).replace(/"/g, '""') + '"' : String(v);
    return [columns, ...rows.map(row => columns.map(c => row[c]))]
      .map(line => line.map(cell).join(',')).join('\n') + '\n';
  };
  document.getElementById('csv').addEventListener('click', () => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([csv()], {type: 'text/csv'}));
    link.download = (data.schema || 'report').replace(/\/.*/, '').replace(/\./g, '-') + '.csv';
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
})();
)js";

}  // namespace delray::apps::report::internal
