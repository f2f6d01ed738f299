// The plots of a vector's signals.
'use strict';
(() => {
  const {element, floats, colour, nearest, shown, styledAxes, onColoursChanged} = attest;

  let allPlots = null; // by the ids of vectors
  attest.plotsOf = (id) => {
    if (!allPlots) allPlots = JSON.parse(document.getElementById('plots').textContent || '{}');
    return Object.hasOwn(allPlots, id) ? allPlots[id] : null;
  };
  attest.plottedVectors = () => (attest.plotsOf(''), Object.keys(allPlots));

  const decoded = (signal) => {
    const curves = {};
    for (const name of ['tick', 'time', 'got', 'want']) curves[name] = floats(signal[name]);
    if (typeof signal.allowed === 'string') curves.allowed = floats(signal.allowed);
    else if (typeof signal.allowed === 'number')
      curves.allowed = curves.tick.map(() => signal.allowed);
    return curves;
  };

  // dygraphs leaves gaps where a value is NaN. Infinity would spoil the axis.
  const drawable = (value) => (Number.isFinite(value) ? value : NaN);
  const band = (middle, half) => [
    drawable(middle - half),
    drawable(middle),
    drawable(middle + half),
  ];

  const isFlag = (curves) => [...curves.got, ...curves.want].every((v) => v === 0 || v === 1);

  // The line at the first deviation, and crosses where the port's value is not finite.
  const marks = (curves, marked) => (context, area, plot) => {
    if (marked !== null) {
      const x = Math.round(plot.toDomXCoord(marked)) + 0.5;
      context.strokeStyle = colour('fail');
      context.lineWidth = 1;
      context.setLineDash([4, 3]);
      context.beginPath();
      context.moveTo(x, area.y);
      context.lineTo(x, area.y + area.h);
      context.stroke();
      context.setLineDash([]);
    }
    context.fillStyle = colour('broken');
    context.font = 'bold 12px sans-serif';
    curves.got.forEach((value, i) => {
      const isHole = !Number.isFinite(value) && Number.isFinite(curves.want[i]);
      if (isHole) context.fillText('\u00d7', plot.toDomXCoord(curves.time[i]) - 4, area.y + 11);
    });
  };

  const commonOptions = (curves, marked) => ({
    ...styledAxes(),
    customBars: true,
    stepPlot: isFlag(curves),
    drawPoints: curves.tick.length <= 150,
    pointSize: 2,
    fillAlpha: 0.25,
    underlayCallback: marks(curves, marked),
  });

  const valuePlot = (place, curves, marked) => {
    const allowed = curves.allowed || curves.tick.map(() => 0);
    const rows = curves.time.map((time, i) => [
      time,
      band(curves.want[i], allowed[i]),
      band(curves.got[i], 0),
    ]);
    return new Dygraph(place, rows, {
      ...commonOptions(curves, marked),
      labels: ['time', 'want', 'got'],
      colors: [colour('expected'), colour('got')],
      series: {want: {strokeWidth: 3}, got: {strokeWidth: 1.5, strokePattern: [6, 3]}},
    });
  };

  const deviationPlot = (place, curves, marked) => {
    const rows = curves.time.map((time, i) => {
      const allowed = curves.allowed ? curves.allowed[i] : 0;
      return [time, band(0, allowed), band(curves.got[i] - curves.want[i], 0)];
    });
    return new Dygraph(place, rows, {
      ...commonOptions(curves, marked),
      labels: ['time', 'allowed', 'difference'],
      colors: [colour('allowed'), colour('got')],
      series: {allowed: {strokeWidth: 1}, difference: {strokeWidth: 1.5}},
      xlabel: 'difference (got - want), over time from the first tick [s]',
      xLabelHeight: 16,
    });
  };

  const key = (name, text) =>
    element('span', {}, element('span', {className: `key ${name}`}), text);

  // The values at the cursor, in place of the legend of dygraphs.
  const reading = (curves, i) => {
    if (i < 0) {
      const parts = [key('want', 'want'), '\u2003'];
      if (curves.allowed) parts.push(key('allowed', 'tolerance'), '\u2003');
      return [...parts, key('got', 'got')];
    }
    const parts = [
      `tick ${curves.tick[i]}, ${shown(curves.time[i])} s\u2003`,
      key('want', `want ${shown(curves.want[i])}`),
      '\u2003',
      key('got', `got ${shown(curves.got[i])}`),
      '\u2003',
      `difference ${shown(curves.got[i] - curves.want[i])}`,
    ];
    if (curves.allowed) parts.push(`, allowed ${shown(curves.allowed[i])}`);
    return parts;
  };

  // Adds the elements of a signal. draw() must be called when the page has all elements, because
  // dygraphs takes the width that they have then.
  const addSignal = (place, signal, ticks, marked) => {
    const curves = decoded(signal);
    const line = element('p', {className: 'reading'});
    const values = element('div', {
      className: 'values',
      role: 'img',
      'aria-label': `${signal.name}: got and want over time`,
    });
    const deviation = element('div', {
      className: 'deviation',
      role: 'img',
      'aria-label': `${signal.name}: difference (got - want) over time`,
    });
    const count =
      signal.deviating > 0
        ? `${signal.deviating} of ${ticks} ticks deviate, from tick ${signal.first_tick} on`
        : 'agrees with the reference at all ticks';
    const drawn =
      curves.tick.length < ticks
        ? `; ${curves.tick.length} ticks are drawn, with the smallest and largest values`
        : '';
    place.append(
      element(
        'div',
        {className: 'plot'},
        element(
          'h3',
          {},
          signal.name.replace(/^out\//, ''),
          ' ',
          element('small', {}, `${signal.stage}: ${count}${drawn}`)
        ),
        line,
        values,
        deviation
      )
    );
    line.replaceChildren(...reading(curves, -1));
    const draw = () => [
      valuePlot(values, curves, marked),
      deviationPlot(deviation, curves, marked),
    ];
    const follow = (time) => {
      const i = time === null ? -1 : nearest(curves.time, time);
      line.replaceChildren(...reading(curves, i));
    };
    return {draw, follow, curves};
  };

  let drawnPlots = [];
  const removePlots = () => {
    for (const plot of drawnPlots) plot.destroy();
    drawnPlots = [];
    onColoursChanged(() => {});
  };

  const synchronise = (signals) => {
    if (drawnPlots.length > 1) Dygraph.synchronize(drawnPlots, {range: false});
    for (const plot of drawnPlots) {
      const before = plot.getFunctionOption('highlightCallback');
      plot.updateOptions(
        {
          highlightCallback: (...args) => {
            if (before) before(...args);
            for (const signal of signals) signal.follow(args[1]);
          },
          unhighlightCallback: () => {
            for (const plotted of drawnPlots) plotted.clearSelection();
            for (const signal of signals) signal.follow(null);
          },
        },
        true
      );
    }
  };

  const zoomTo = (range) => {
    for (const plot of drawnPlots) plot.updateOptions({dateWindow: range});
  };

  const zoomButtons = (signals, marked) => {
    const times = signals[0].curves.time;
    const end = times[times.length - 1];
    const near = () => {
      const at = times.findIndex((time) => time >= marked);
      const step = times.length > 1 ? (end - times[0]) / (times.length - 1) : 1;
      zoomTo([
        Math.max(times[0], times[Math.max(0, at)] - 12 * step),
        Math.min(end, marked + 24 * step),
      ]);
    };
    return element(
      'p',
      {className: 'tools'},
      element('button', {type: 'button', onclick: near}, 'Zoom to the first deviation'),
      element('button', {type: 'button', onclick: () => zoomTo(null)}, 'Whole trace'),
      element(
        'span',
        {className: 'hint'},
        'Drag to zoom, shift-drag to pan, double-click for the whole trace.'
      )
    );
  };

  const addPlots = (place, row, plotted) => {
    removePlots();
    place.replaceChildren();
    const first = plotted.signals[0];
    const ticks = floats(first.tick);
    const at = ticks.indexOf(Number(row.tick));
    const marked = at < 0 ? null : floats(first.time)[at];
    const tools = element('div');
    place.append(tools);
    if (!plotted.repeated) {
      place.append(
        element(
          'p',
          {className: 'error'},
          'For these plots the port ran once more, and it gave other outputs than before.'
        )
      );
    }
    const signals = plotted.signals.map((signal) =>
      addSignal(place, signal, plotted.ticks, marked)
    );
    if (marked !== null) tools.append(zoomButtons(signals, marked));
    if (plotted.hidden > 0) {
      place.append(
        element(
          'p',
          {className: 'hint'},
          `${plotted.hidden} more signals deviate and are not plotted.`
        )
      );
    }
    drawnPlots = signals.flatMap((signal) => signal.draw());
    synchronise(signals);
    onColoursChanged(() => addPlots(place, row, plotted));
  };

  Object.assign(attest, {addPlots, removePlots});
})();
