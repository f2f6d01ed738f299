// Makes the matrix clickable and replaces the table of results by a list that can be searched. The
// list creates elements only for visible rows, so that thousands of results open at once.
'use strict';
(() => {
  const element = attest.element;
  const rowHeight = 28; // as in results.css
  const table = document.getElementById('results');
  const columns = [...table.tHead.rows[0].cells].map((cell) => cell.dataset.name);
  const verdicts = [...document.querySelectorAll('#verdicts span')].map((span) => span.dataset);
  const symbols = Object.fromEntries(verdicts.map(({verdict, symbol}) => [verdict, symbol]));
  const failing = new Set(verdicts.filter(({fails}) => fails).map(({verdict}) => verdict));

  const whys = JSON.parse(document.getElementById('whys').textContent); // by case

  const readRow = (tableRow) => {
    const row = {};
    let i = 0;
    for (const cell of tableRow.cells) row[columns[i++]] = cell.textContent.trim();
    row.symbol = symbols[row.verdict];
    row.id = `${row.group}/${row.name}@${row.configuration}`;
    row.rate = row.configuration.match(/^.*?hz/)[0];
    row.isFlight = row.configuration !== row.rate;
    row.why = whys[`${row.group}/${row.name}`] ?? '';
    return row;
  };
  const rows = Array.from(table.tBodies[0].rows, readRow);
  const textOf = (row) =>
    (row.searched ??= [row.id, row.verdict, row.signal, row.stage, row.reason]
      .join(' ')
      .toLowerCase());

  const chosen = {words: [], verdicts: new Set(), group: '', rate: ''};
  let shown = rows;
  let selected = null;

  // chosen.group is "profile/group", or a profile for all its groups.
  const isInGroup = (row) =>
    !chosen.group || row.group === chosen.group || row.group.startsWith(`${chosen.group}/`);
  const matches = (row) =>
    isInGroup(row) &&
    (!chosen.rate || row.rate === chosen.rate) &&
    (chosen.verdicts.size === 0 || chosen.verdicts.has(row.verdict)) &&
    chosen.words.every((word) => textOf(row).includes(word));

  // The tools above the list.
  const search = element('input', {
    type: 'search',
    placeholder: 'Search (press /)',
    'aria-label': 'Search results by name, verdict, signal, stage or reason',
  });
  const option = (value, text) => element('option', {value}, text);
  const distinct = (of) => [...new Set(rows.map(of))];
  const selector = (name, values, all) =>
    element(
      'select',
      {'aria-label': name},
      option('', all),
      ...values.map((value) => option(value, value))
    );
  const hertz = (rate) => {
    const [above, below] = rate.replace('hz', '').split('-').pop().split('_').map(Number);
    return above / (below || 1);
  };
  const groups = selector(
    'Group',
    distinct((row) => row.group),
    'all groups'
  );
  for (const profile of distinct((row) => row.group.split('/')[0]))
    groups.append(option(profile, `all of ${profile}`));
  const rates = selector(
    'Rate',
    distinct((row) => row.rate).sort((a, b) => hertz(a) - hertz(b)),
    'all rates'
  );
  const count = element('span', {className: 'hint', role: 'status'});
  const clear = element('button', {type: 'button'}, 'Show all');
  const chips = Object.keys(symbols).flatMap((verdict) => {
    const number = rows.filter((row) => row.verdict === verdict).length;
    if (number === 0) return [];
    const chip = element(
      'button',
      {type: 'button', className: `is-${verdict}`, 'aria-pressed': 'false'},
      `${symbols[verdict]} ${verdict} ${number}`
    );
    chip.addEventListener('click', () => {
      if (!chosen.verdicts.delete(verdict)) chosen.verdicts.add(verdict);
      update();
    });
    return [{verdict, chip}];
  });

  // The list.
  const space = element('div', {className: 'space'});
  const list = element(
    'div',
    {className: 'list', tabIndex: 0, role: 'listbox', 'aria-label': 'Results'},
    space
  );

  const noteOf = (row) =>
    row.stage ||
    row.reason ||
    (row.headroom ? `headroom ${Number(row.headroom).toPrecision(3)}` : '');
  const rowElement = (row, i) => {
    const made = element(
      'div',
      {
        className: 'row',
        role: 'option',
        id: `row-${i}`,
        title: row.id,
        'aria-selected': String(row === selected),
        'aria-setsize': shown.length,
        'aria-posinset': i + 1,
      },
      element(
        'span',
        {className: `is-${row.verdict}`},
        element('span', {className: 'symbol'}, row.symbol),
        element('span', {className: 'name-of-verdict'}, ` ${row.verdict}`)
      ),
      element('span', {}, element('span', {className: 'group'}, `${row.group}/`), row.name),
      element('span', {}, row.configuration),
      element('span', {className: 'note'}, noteOf(row))
    );
    made.style.top = `${i * rowHeight}px`;
    made.addEventListener('click', () => select(row));
    return made;
  };

  const renderRows = (all) => {
    const begin = all ? 0 : Math.max(0, Math.floor(list.scrollTop / rowHeight) - 10);
    const end = all
      ? Math.min(shown.length, 300)
      : begin + Math.ceil(list.clientHeight / rowHeight) + 20;
    const made = shown.slice(begin, end).map((row, i) => rowElement(row, begin + i));
    if (shown.length === 0) made.push(element('p', {className: 'none'}, 'No result matches.'));
    if (all && shown.length > end)
      made.push(element('p', {className: 'none'}, `and ${shown.length - end} more`));
    space.style.height = `${Math.max(shown.length, 2) * rowHeight}px`;
    space.replaceChildren(...made);
    const position = shown.indexOf(selected);
    const isRendered = position >= begin && position < end;
    if (isRendered) list.setAttribute('aria-activedescendant', `row-${position}`);
    else list.removeAttribute('aria-activedescendant');
  };

  // Each cell of a matrix with a verdict selects results: of a group, or of all groups in the last
  // row; at a rate, or at all rates in the last column.
  for (const matrix of document.querySelectorAll('.matrix')) {
    const profile = matrix.caption.textContent.split(':')[0];
    const rates = [...matrix.tHead.rows[0].cells].map((cell) => cell.textContent);
    const matrixRows = [...matrix.tBodies[0].rows];
    for (const cell of matrix.querySelectorAll('td[class*="v-"]')) {
      const group = cell.parentElement.cells[0].textContent;
      const isTotal = cell.parentElement === matrixRows.at(-1);
      const rate = cell.cellIndex === rates.length - 1 ? '' : rates[cell.cellIndex];
      cell.dataset.group = isTotal ? profile : `${profile}/${group}`;
      cell.dataset.rate = rate && `${rate.replace('/', '_').replace(':', '-')}hz`;
      cell.dataset.verdict = cell.className.match(/v-(\S+)/)[1];
    }
  }

  const markCells = () => {
    for (const cell of document.querySelectorAll('.matrix td[data-group]')) {
      const isChosen = chosen.group === cell.dataset.group && chosen.rate === cell.dataset.rate;
      cell.classList.toggle('is-chosen', isChosen);
    }
  };

  function update() {
    shown = rows.filter(matches);
    for (const {verdict, chip} of chips)
      chip.setAttribute('aria-pressed', String(chosen.verdicts.has(verdict)));
    groups.value = chosen.group;
    rates.value = chosen.rate;
    count.textContent = `${shown.length} of ${rows.length}`;
    list.scrollTop = 0;
    list.style.height = shown.length < 18 ? `${Math.max(shown.length, 2) * rowHeight + 2}px` : '';
    markCells();
    renderRows();
  }

  const scrollTo = (position) => {
    const top = position * rowHeight;
    if (top < list.scrollTop) list.scrollTop = top;
    const lowest = top + rowHeight - list.clientHeight;
    if (lowest > list.scrollTop) list.scrollTop = lowest;
  };

  const details = document.getElementById('details');
  let pending = 0;
  function select(row, isQuick) {
    selected = row;
    scrollTo(shown.indexOf(row));
    renderRows();
    clearTimeout(pending);
    // While an arrow key is held down, only the last vector is drawn.
    pending = setTimeout(
      () => {
        attest.showDetails(details, row);
        details.scrollTop = 0;
        history.replaceState(null, '', `#${encodeURI(row.id)}`);
      },
      isQuick ? 120 : 0
    );
  }

  const move = (steps) => {
    if (shown.length === 0) return;
    const from = shown.indexOf(selected);
    const to = from < 0 ? 0 : Math.min(shown.length - 1, Math.max(0, from + steps));
    select(shown[to], true);
  };

  const focusDetails = () => {
    if (!selected) return;
    setTimeout(() => {
      details.querySelector('h2')?.focus();
      details.scrollIntoView({block: 'nearest'});
    }, 130);
  };

  const page = () => Math.max(1, Math.floor(list.clientHeight / rowHeight) - 1);
  const keys = {
    ArrowDown: () => move(1),
    ArrowUp: () => move(-1),
    PageDown: () => move(page()),
    PageUp: () => move(-page()),
    Home: () => move(-rows.length),
    End: () => move(rows.length),
    Enter: focusDetails,
  };
  list.addEventListener('keydown', (event) => {
    if (!Object.hasOwn(keys, event.key)) return;
    event.preventDefault();
    keys[event.key]();
  });
  list.addEventListener('scroll', () => renderRows());

  search.addEventListener('input', () => {
    chosen.words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    update();
  });
  search.addEventListener('keydown', (event) => {
    if (event.key !== 'ArrowDown' && event.key !== 'Enter') return;
    event.preventDefault();
    list.focus();
    move(0);
  });
  addEventListener('keydown', (event) => {
    const isTyping = event.target instanceof Element && event.target.closest('input, select');
    if (event.key !== '/' || isTyping || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    search.focus();
  });
  groups.addEventListener('change', () => {
    chosen.group = groups.value;
    update();
  });
  rates.addEventListener('change', () => {
    chosen.rate = rates.value;
    update();
  });
  clear.addEventListener('click', () => {
    chosen.verdicts.clear();
    Object.assign(chosen, {words: [], group: '', rate: ''});
    search.value = '';
    update();
  });

  // The stage in which most failing vectors differ first.
  const commonStage = () => {
    const counts = new Map();
    for (const {stage} of rows) if (stage) counts.set(stage, (counts.get(stage) ?? 0) + 1);
    return [...counts].sort((a, b) => b[1] - a[1])[0]?.[0];
  };
  const usualStage = commonStage();

  // Among the shown rows, a failure with plots, if there is one: of the case that the report names,
  // or else of the usual stage.
  const isOfFirstCase = (row) => `${row.group}/${row.name}` === table.dataset.first;
  const firstToShow = () => {
    const failed = shown.filter((row) => failing.has(row.verdict));
    const plotted = failed.filter((row) => attest.plotsOf(row.id));
    return (
      plotted.find(isOfFirstCase) ??
      plotted.find((row) => row.stage === usualStage) ??
      plotted[0] ??
      failed.find(isOfFirstCase) ??
      failed[0]
    );
  };

  const makeClickable = (cell) => {
    const {group, rate, verdict} = cell.dataset;
    const place = rate ? `${group} at ${rate}` : group;
    const button = element(
      'button',
      {
        type: 'button',
        'aria-label': `${place}: ${cell.textContent.trim()}, worst verdict ${verdict}`,
      },
      ...cell.childNodes
    );
    button.addEventListener('click', () => {
      chosen.verdicts = new Set(
        failing.has(verdict) ? chips.map((c) => c.verdict).filter((v) => failing.has(v)) : []
      );
      Object.assign(chosen, {group, rate, words: []});
      search.value = '';
      update();
      const row = firstToShow();
      if (row) select(row);
      if (innerWidth < 1250) list.scrollIntoView({block: 'nearest'});
    });
    cell.replaceChildren(button);
  };

  // Paper has no scroll bar: the first rows are printed.
  addEventListener('beforeprint', () => renderRows(true));
  addEventListener('afterprint', () => renderRows());
  addEventListener('resize', () => renderRows());

  // Several profiles share the place of one matrix.
  const matrices = [...document.querySelectorAll('.matrix')]
    .filter((matrix) => matrix.querySelector('[data-group]'))
    .map((matrix) => matrix.parentElement);
  const profileOf = (place) => place.querySelector('caption').textContent.split(':')[0];
  const showMatrix = (chosenOne) => {
    for (const place of matrices) place.hidden = place !== chosenOne;
    for (const [i, tab] of tabs.entries())
      tab.setAttribute('aria-pressed', String(matrices[i] === chosenOne));
  };
  const tabs = matrices.map((place) => {
    const tab = element('button', {type: 'button'}, profileOf(place));
    tab.addEventListener('click', () => showMatrix(place));
    return tab;
  });
  if (matrices.length > 1) {
    matrices[0].before(
      element('div', {className: 'tools', role: 'group', 'aria-label': 'Profile'}, ...tabs)
    );
    showMatrix(matrices[0]);
  }

  document.querySelectorAll('.matrix td[data-group]').forEach(makeClickable);
  table.before(
    element('div', {className: 'tools'}, search, groups, rates, count, clear),
    element(
      'div',
      {className: 'tools', role: 'group', 'aria-label': 'Verdicts to show'},
      ...chips.map((c) => c.chip)
    ),
    list,
    element(
      'p',
      {className: 'hint'},
      'Keys: / searches, arrow keys select, Enter goes to the details.'
    )
  );

  const named = rows.find((row) => `#${encodeURI(row.id)}` === location.hash);
  if (!named && rows.some((row) => failing.has(row.verdict))) {
    chosen.verdicts = new Set(chips.map((c) => c.verdict).filter((v) => failing.has(v)));
  }
  update();
  const first = named ?? firstToShow();
  if (first) select(first);
})();
