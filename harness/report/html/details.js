// The details of the selected vector. results.js calls attest.showDetails().
'use strict';
(() => {
  const {element, addPlots, removePlots} = attest;

  const copyButton = (text) =>
    element(
      'button',
      {
        type: 'button',
        onclick: (event) => {
          const button = event.currentTarget;
          const done = () => {
            button.textContent = 'Copied';
          };
          const selected = () => {
            getSelection().selectAllChildren(button.parentElement.querySelector('code'));
            if (document.execCommand('copy')) done();
          };
          if (navigator.clipboard) navigator.clipboard.writeText(text).then(done, selected);
          else selected();
        },
      },
      'Copy'
    );

  const command = (title, text) =>
    text
      ? [
          element('h3', {}, title),
          element('div', {className: 'command'}, element('code', {}, text), copyButton(text)),
        ]
      : [];

  const finding = (row) => {
    const list = element('dl', {className: 'finding'});
    const add = (name, ...value) =>
      list.append(element('dt', {}, name), element('dd', {}, ...value));
    if (row.why) add('it tests', row.why);
    if (row.reason) add('reason', row.reason);
    if (row.signal) {
      add('first deviation', `tick ${row.tick}, timestamp ${row.time} us`);
      add('signal', element('strong', {className: 'value'}, row.signal));
      add('got', element('span', {className: 'value'}, row.got));
      add('want', element('span', {className: 'value'}, row.want));
      if (row.distance) add('difference', row.distance);
      add(
        'stage',
        element('strong', {}, row.stage),
        ': look here first. No output of an earlier stage deviates up to this tick.'
      );
    }
    if (row.worst) add('worst', row.worst);
    if (row.deviating)
      add('deviating', `${row.deviating} of ${row.ticks} ${row.isFlight ? 'rows' : 'ticks'}`);
    if (row.headroom) add('smallest headroom', `${row.headroom} in ${row.tightest}`);
    if (!row.deviating && Number(row.ticks) > 0) add('ticks', row.ticks);
    return list;
  };

  const withoutPlots = (row) => {
    if (!row.signal) return [];
    const count = attest.plottedVectors().length;
    return [
      element('h3', {}, 'Plots'),
      element(
        'p',
        {},
        `This page has plots of ${count} failing vectors: the first of each group and ` +
          'rate, as far as space allows. This command makes a page with the plots of this vector:'
      ),
      ...command('', `${row.reproduce} --html vector.html`).slice(1),
    ];
  };

  // `row`: an entry of the list; null empties the details.
  attest.showDetails = (place, row) => {
    removePlots();
    if (!row) return place.replaceChildren();
    const plotted = attest.plotsOf(row.id);
    const plots = element('div');
    place.replaceChildren(
      element(
        'header',
        {},
        element('span', {className: `badge is-${row.verdict}`}, `${row.symbol} ${row.verdict}`),
        element('h2', {tabIndex: -1}, row.id)
      ),
      finding(row),
      plots,
      ...(plotted ? [] : withoutPlots(row)),
      ...command('Reproduce', row.reproduce),
      ...command('Fly it, and write its trace and a page with plots and bounds', row.fly)
    );
    if (plotted) addPlots(plots, row, plotted);
  };
})();
