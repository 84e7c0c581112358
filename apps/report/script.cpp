// The script of every report: tabs, numbers on hover, lines that light up, sorting, CSV.
#include "apps/report/style.h"

namespace delray::apps::report::internal {

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

  // Lines of a chart are pointed at by themselves or by their names below it.
  all('figure.chart').forEach(figure => {
    const parts = all('g.series, button.key', figure);
    const light = (name, on) => {
      figure.classList.toggle('lit', on);
      parts.forEach(part => part.classList.toggle('on', on && part.dataset.name === name));
    };
    parts.forEach(part => {
      const {name} = part.dataset;
      part.addEventListener('pointerenter', () => light(name, true));
      part.addEventListener('pointerleave', () => light(name, false));
      part.addEventListener('focusin', () => light(name, true));
      part.addEventListener('focusout', () => light(name, false));
      part.addEventListener('click', () => choose(name));
    });
  });

  // A line that is chosen stays in colour, in all charts.
  const choose = name => {
    const same = all('g.series, button.key').filter(part => part.dataset.name === name);
    const on = !same[0].classList.contains('chosen');
    same.forEach(part => {
      part.classList.toggle('chosen', on);
      if (part.tagName === 'BUTTON') part.setAttribute('aria-pressed', on);
    });
    all('figure.chart').forEach(place_names);
  };
  // Names at the ends of lines, moved apart as the page did it for those that it shows itself.
  const place_names = figure => {
    const names = all('g.series:not(.weak) .name, g.series.chosen .name', figure);
    names.sort((a, b) => a.dataset.y - b.dataset.y);
    const height = figure.querySelector('.plot svg').height.baseVal.value, gap = 15;
    const ends = {};
    names.forEach(name => (ends[name.getAttribute('x')] ||= []).push(name));
    Object.values(ends).forEach(column => {
      const y = column.map(name => +name.dataset.y);
      for (let i = 1; i < y.length; ++i) y[i] = Math.max(y[i], y[i - 1] + gap);
      for (let i = y.length - 1, most = height; i >= 0; --i, most = y[i + 1] - gap)
        y[i] = Math.min(y[i], most);
      column.forEach((name, i) => name.setAttribute('y', y[i]));
    });
  };

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
