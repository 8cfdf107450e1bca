'use strict';
(function () {
  const body = document.querySelector('table.cases > tbody');
  const rows = Array.from(body.rows);
  const filter = document.getElementById('filter');
  const shown = document.getElementById('shown');
  const tiles = Array.from(document.querySelectorAll('.counts button'));
  let kind = 'all';
  document.documentElement.classList.add('scripted');

  function refresh() {
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    for (const row of rows) {
      const text = row.dataset.text;
      const wanted = (kind === 'all' || row.classList.contains(kind)) && words.every(word => text.includes(word));
      row.hidden = !wanted;
      count += wanted ? 1 : 0;
    }
    for (const tile of tiles) tile.setAttribute('aria-pressed', String(tile.dataset.kind === kind));
    shown.textContent = count === rows.length ? 'all ' + count + ' cases' : count + ' of ' + rows.length + ' cases';
  }

  function choose(name) {
    kind = kind === name ? 'all' : name;
    refresh();
  }

  // Numbers by size, what has none last, other texts by their letters; equal ones stay in the suite's order.
  function sort(header) {
    const column = header.cellIndex;
    const was = header.getAttribute('aria-sort');
    for (const other of header.parentNode.cells) other.removeAttribute('aria-sort');
    const natural = (a, b) => a.dataset.index - b.dataset.index;
    let order = natural;
    if (was !== 'descending') {
      const sign = was === 'ascending' ? -1 : 1;
      header.setAttribute('aria-sort', sign > 0 ? 'ascending' : 'descending');
      const value = row => row.cells[column].dataset.value;
      const number = header.classList.contains('number');
      order = (a, b) => {
        const x = value(a), y = value(b);
        if (x === '' || y === '') return (x === '') - (y === '') || natural(a, b);
        return sign * (number ? x - y : x.localeCompare(y)) || natural(a, b);
      };
    }
    for (const row of rows.sort(order)) body.append(row);
  }

  function step(by) {
    const seen = rows.filter(row => !row.hidden);
    const now = seen.findIndex(row => row.contains(document.activeElement));
    const next = seen[now < 0 ? (by > 0 ? 0 : seen.length - 1) : Math.min(Math.max(now + by, 0), seen.length - 1)];
    if (!next) return;
    next.querySelector('summary').focus();
    next.scrollIntoView({block: 'nearest'});
  }

  for (const header of document.querySelectorAll('table.cases > thead button'))
    header.addEventListener('click', () => sort(header.closest('th')));
  for (const tile of tiles) tile.addEventListener('click', () => choose(tile.dataset.kind));
  filter.addEventListener('input', refresh);
  body.addEventListener('click', event => {
    if (event.target.tagName !== 'IMG') return;
    for (const image of event.target.closest('.pictures').querySelectorAll('img')) image.classList.toggle('large');
  });
  document.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target === filter) {
      if (event.key === 'Escape') { filter.value = ''; filter.blur(); refresh(); }
      if (event.key === 'Enter' || event.key === 'ArrowDown') { event.preventDefault(); step(1); }
      return;
    }
    const act = {'/': () => filter.focus(), j: () => step(1), k: () => step(-1), m: () => choose('missed'),
                 c: () => choose('changed'), a: () => { kind = 'all'; refresh(); }}[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
  // A link to a case shows it, whatever the filter.
  window.addEventListener('hashchange', () => {
    const row = document.getElementById(location.hash.slice(1));
    if (row && row.hidden) { kind = 'all'; filter.value = ''; refresh(); row.scrollIntoView(); }
  });
  window.addEventListener('beforeprint', () => {
    for (const row of rows) if (row.classList.contains('missed')) row.querySelector('details').open = true;
  });
  refresh();
})();
