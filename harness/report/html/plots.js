// The plots of a document. The animation moves and follows the cursor through `attest.plotGroups`.
'use strict';
(() => {
  const {element, floats, colour, nearest, shown, styledAxes} = attest;
  const content = JSON.parse(document.getElementById('plots').textContent);
  const palette = ['expected', 'got', 'broken', 'pass', 'quiet', 'text'];
  const patterns = {solid: null, dashed: [7, 3], dotted: [2, 3]};

  const isOfPoints = (shape) => shape === 'points' || shape === 'scatter';

  // The seventh series has the first colour again, so its line is dashed.
  const styleOf = ({colour: number, pattern}) => ({
    colour: colour(palette[number % palette.length]),
    pattern: pattern === 'solid' && number >= palette.length ? [7, 3] : patterns[pattern],
    width: pattern === 'solid' ? 2 : 1.5,
  });

  const decoded = (plot) => {
    const grids = plot.grids.map(floats);
    const series = plot.series.map((one, i) => ({
      id: `series ${i}`,
      name: one.name,
      x: grids[one.grid],
      y: floats(one.y),
      style: styleOf(one),
    }));
    const band = plot.band && {
      name: plot.band.name,
      x: grids[plot.band.grid],
      low: floats(plot.band.low),
      high: floats(plot.band.high),
    };
    return {...plot, series, band};
  };

  const extent = (values) =>
    values.reduce(([low, high], y) => [Math.min(low, y), Math.max(high, y)], [Infinity, -Infinity]);

  // The bounds that the y axis includes. A bound farther away than the extent of the values would
  // make these small: it is a text at the edge.
  const nearBounds = ({series, bounds, least_span}) => {
    const [low, high] = extent(series.flatMap(({y}) => [...y]).filter(Number.isFinite));
    const reach = Math.max(high - low, least_span);
    return bounds.filter(({level}) => low - reach <= level && level <= high + reach);
  };

  // dygraphs needs the same x for all series. null: the series has no sample at this x, and its
  // line goes on. The bounds are series, too, so that the y axis includes them at each zoom.
  const rowsOf = (plot) => {
    const {series, band, logarithmic_x} = plot;
    const lines = series.map(({x, y}) => ({x, y}));
    for (const {first, last, level} of nearBounds(plot)) {
      const {x} = series[0];
      lines.push({x, y: x.map((at) => (first <= at && at <= last ? level : NaN))});
    }
    if (band) lines.push({x: band.x, y: band.low}, {x: band.x, y: band.high});
    const all = new Set(lines.map(({x}) => x));
    const xs = all.size === 1 ? lines[0].x : [...new Set([...all].flat())].sort((a, b) => a - b);
    const next = lines.map(() => 0);
    const rows = xs.map((at, row) => [
      at,
      ...lines.map(({x, y}, i) => {
        if (all.size === 1) return Number.isFinite(y[row]) ? y[row] : NaN;
        if (x[next[i]] !== at) return null;
        while (x[next[i] + 1] === at) ++next[i];
        const value = y[next[i]++];
        return Number.isFinite(value) ? value : NaN;
      }),
    ]);
    return logarithmic_x ? rows.filter(([x]) => x > 0) : rows;
  };

  // toDomXCoord() ignores a logarithmic x.
  const placeOf = (plot, x) => {
    const {x: left, w: width} = plot.getArea();
    return left + plot.toPercentXCoord(x) * width;
  };

  const drawBand = (context, plot, {x, low, high}) => {
    context.fillStyle = colour('expected');
    context.globalAlpha = 0.18;
    context.beginPath();
    x.forEach((at, i) => context.lineTo(placeOf(plot, at), plot.toDomYCoord(high[i])));
    for (let i = x.length - 1; i >= 0; --i) {
      context.lineTo(placeOf(plot, x[i]), plot.toDomYCoord(low[i]));
    }
    context.fill();
    context.globalAlpha = 1;
  };

  const drawMark = (context, area, plot, {x, text, quiet}, row) => {
    const at = Math.round(placeOf(plot, x)) + 0.5;
    if (at < area.x || at > area.x + area.w) return;
    context.strokeStyle = context.fillStyle = colour(quiet ? 'quiet' : 'fail');
    context.lineWidth = 1;
    context.setLineDash([4, 3]);
    context.beginPath();
    context.moveTo(at, area.y);
    context.lineTo(at, area.y + area.h);
    context.stroke();
    context.setLineDash([]);
    context.font = '12px sans-serif';
    const isRight = at + context.measureText(text).width + 6 > area.x + area.w;
    context.textAlign = isRight ? 'right' : 'left';
    context.fillText(text, at + (isRight ? -4 : 4), area.y + 12 + 14 * row);
  };

  // The ends of the line point to the forbidden side. `used` has the places of the texts so far.
  const drawBound = (context, area, plot, bound, used) => {
    const begin = Math.max(placeOf(plot, bound.first), area.x);
    const end = Math.min(placeOf(plot, bound.last), area.x + area.w);
    if (begin > end) return;
    const bottom = area.y + area.h;
    const exact = Math.round(plot.toDomYCoord(bound.level)) + 0.5;
    const level = Math.min(Math.max(exact, area.y), bottom);
    const up = bound.upper ? -1 : 1;
    context.strokeStyle = context.fillStyle = colour(bound.missed ? 'fail' : 'quiet');
    context.lineWidth = bound.missed ? 1.5 : 1;
    if (level === exact) {
      context.beginPath();
      context.moveTo(begin, level + 7 * up);
      context.lineTo(begin, level);
      context.lineTo(end, level);
      context.lineTo(end, level + 7 * up);
      context.stroke();
    }
    const arrow = exact < area.y ? ' \u2191' : exact > bottom ? ' \u2193' : '';
    context.font = '12px sans-serif';
    context.textAlign = 'right';
    const text = bound.text && bound.text + arrow;
    const width = context.measureText(text).width;
    const right = Math.min(Math.max(end - 4, area.x + width + 4), area.x + area.w - 4);
    // The text is on the forbidden side of the line, if there is room.
    const hasRoom = bound.upper ? level - 10 >= area.y + 12 : level + 19 <= bottom - 4;
    let y = bound.upper === hasRoom ? level - 10 : level + 19;
    const isUsed = () =>
      used.some((one) => Math.abs(one.y - y) < 13 && one.right > right - width && one.left < right);
    const away = y < area.y + area.h / 2 ? 1 : -1;
    while (text && isUsed()) y += 13 * away;
    used.push({left: right - width, right, y});
    context.fillText(text, right, y);
  };

  const underlay = ({band, marks, bounds}) => (context, area, plot) => {
    context.save();
    context.beginPath();
    context.rect(area.x, area.y, area.w, area.h);
    context.clip();
    if (band) drawBand(context, plot, band);
    marks.forEach((mark, row) => drawMark(context, area, plot, mark, row % 4));
    const used = [];
    for (const bound of bounds) drawBound(context, area, plot, bound, used);
    context.restore();
  };

  const drawBars = ({x, y, style}) => (event) => {
    const {drawingContext: context, dygraph: plot, plotArea: area} = event;
    const bottom = area.y + area.h;
    context.fillStyle = context.strokeStyle = style.colour;
    context.lineWidth = style.width;
    context.setLineDash(style.pattern || []);
    for (let i = 0; i + 1 < x.length; ++i) {
      if (!(y[i] > 0)) continue;
      const left = placeOf(plot, x[i]);
      const top = plot.toDomYCoord(y[i]);
      const width = placeOf(plot, x[i + 1]) - left;
      context.globalAlpha = 0.25;
      context.fillRect(left, top, width, bottom - top);
      context.globalAlpha = 1;
      context.strokeRect(left, top, width, bottom - top);
    }
    context.setLineDash([]);
  };

  // A circle, a square, a triangle and a cross.
  const symbols = [
    (context, x, y) => context.arc(x, y, 4, 0, 7),
    (context, x, y) => context.rect(x - 3.5, y - 3.5, 7, 7),
    (context, x, y) => {
      context.moveTo(x - 4.5, y + 4);
      context.lineTo(x + 4.5, y + 4);
      context.lineTo(x, y - 4.5);
      context.closePath();
    },
    (context, x, y) => {
      context.moveTo(x - 4, y - 4);
      context.lineTo(x + 4, y + 4);
      context.moveTo(x + 4, y - 4);
      context.lineTo(x - 4, y + 4);
    },
  ];

  const drawPoints = ({style}, i) => ({drawingContext: context, points}) => {
    context.strokeStyle = style.colour;
    context.lineWidth = 1.75;
    for (const {canvasx, canvasy} of points) {
      if (!Number.isFinite(canvasy)) continue;
      context.beginPath();
      symbols[i % symbols.length](context, canvasx, canvasy);
      context.stroke();
    }
  };

  // The dots are translucent, so that dense places look darker.
  const drawDots = ({style}) => ({drawingContext: context, points}) => {
    context.fillStyle = style.colour;
    context.globalAlpha = 0.45;
    for (const {canvasx, canvasy} of points) {
      if (!Number.isFinite(canvasy)) continue;
      context.beginPath();
      context.arc(canvasx, canvasy, 2, 0, 7);
      context.fill();
    }
    context.globalAlpha = 1;
  };

  const seriesOptions = ({shape}, series, i) => {
    const {colour: color, pattern, width} = series.style;
    const options = {color, strokePattern: pattern, strokeWidth: width};
    if (shape === 'bars') return {...options, plotter: drawBars(series)};
    if (shape === 'scatter' && i === 0) return {...options, plotter: drawDots(series)};
    if (isOfPoints(shape)) return {...options, plotter: drawPoints(series, i)};
    return options;
  };

  // null: that of dygraphs. With this range of a logarithmic axis, the lowest bar would have no
  // height; and it would magnify values that hardly differ.
  const valueRange = (plot) => {
    const {shape, logarithmic_y, series, least_span} = plot;
    const values = series.flatMap(({y}) => [...y]).filter(Number.isFinite);
    values.push(...nearBounds(plot).map(({level}) => level));
    if (shape === 'bars' && logarithmic_y) {
      const [low, high] = extent(values.filter((value) => value > 0));
      return low <= high ? [low / 2, high * 2] : null;
    }
    const [low, high] = extent(values);
    if (!(high - low < least_span)) return null;
    const middle = (low + high) / 2;
    return [middle - least_span / 2, middle + least_span / 2];
  };

  const optionsOf = (plot, xLabel) => {
    const options = styledAxes();
    options.axes.x.logscale = plot.logarithmic_x;
    const hidden = nearBounds(plot).map((_, i) => `bound ${i}`);
    if (plot.band) hidden.push('low', 'high');
    const isLong = plot.series.some(({x}) => x.length > 60);
    return {
      ...options,
      labels: ['x', ...plot.series.map(({id}) => id), ...hidden],
      series: Object.fromEntries([
        ...plot.series.map((series, i) => [series.id, seriesOptions(plot, series, i)]),
        ...hidden.map((id) => [id, {color: 'rgba(0,0,0,0)'}]),
      ]),
      connectSeparatedPoints: plot.shape === 'line' || plot.shape === 'steps',
      stepPlot: plot.shape === 'steps',
      drawPoints: plot.shape === 'line' && !isLong,
      pointSize: 2.5,
      includeZero: (plot.shape === 'bars' || plot.shape === 'points') && !plot.logarithmic_y,
      yRangePad: plot.marks.length > 0 ? 20 : options.yRangePad, // for the text of the first mark
      xRangePad: plot.logarithmic_x ? 0 : options.xRangePad, // the padding may reach below 0
      valueRange: valueRange(plot),
      logscale: plot.logarithmic_y,
      underlayCallback: underlay(plot),
      ...(xLabel ? {xlabel: xLabel, xLabelHeight: 16} : {}),
    };
  };

  const keyOf = ({style}, shape) => {
    const key = element('span', {className: 'key'});
    key.style.borderColor = style.colour;
    const isDotted = style.pattern === patterns.dotted;
    key.style.borderTopStyle = isDotted ? 'dotted' : style.pattern ? 'dashed' : 'solid';
    if (shape === 'bars') key.style.borderTopWidth = '0.6em';
    return key;
  };

  const symbolKey = ({style}, i, shape) => {
    const isDot = shape === 'scatter' && i === 0;
    const symbol = isDot ? '\u25cf' : ['\u25cb', '\u25a1', '\u25b3', '\u2715'][i % 4];
    const key = element('span', {}, symbol);
    key.style.color = style.colour;
    return key;
  };

  // A button for each series, which hides or shows the series. It also has the value at the cursor.
  const legendOf = (plot, toggle) => {
    const values = plot.series.map(() => element('span', {className: 'at-cursor'}));
    const buttons = plot.series.map((series, i) => {
      const key = isOfPoints(plot.shape)
        ? symbolKey(series, i, plot.shape)
        : keyOf(series, plot.shape);
      const button = element('button', {type: 'button'}, key, `${series.name} `, values[i]);
      button.setAttribute('aria-pressed', 'true');
      button.addEventListener('click', () => {
        const isShown = button.getAttribute('aria-pressed') !== 'true';
        button.setAttribute('aria-pressed', String(isShown));
        toggle(i, isShown);
      });
      return button;
    });
    const band = element('span', {className: 'key allowed'});
    const place = element('span');
    const names = plot.band ? [element('span', {}, band, plot.band.name)] : [];
    const line = element('p', {className: 'reading legend-of-plot'}, ...buttons, ...names, place);
    const read = (x) => {
      plot.series.forEach((series, i) => {
        const at = nearest(series.x, x);
        const value = series.y[at];
        const isGap = isOfPoints(plot.shape) && Number.isNaN(value);
        values[i].textContent = isGap ? '-' : shown(value, 5);
      });
      place.textContent = `at ${shown(x)}`;
    };
    return {line, read};
  };

  // Adds the elements of a plot. Its draw() must be called when the page has all elements, because
  // dygraphs takes the width that the box has then: a box that is alone in its row is wider.
  const addPlot = (place, data, xLabel, group) => {
    const plot = decoded(data);
    const unit = plot.unit ? ` [${plot.unit}]` : '';
    const box = element('div', {
      className: 'values',
      role: 'img',
      tabIndex: 0,
      'aria-label': `${plot.title}${unit}. The arrow keys move the cursor.`,
    });
    let drawn;
    const {line, read} = legendOf(plot, (i, isShown) => drawn.setVisibility(i, isShown));
    const title = element('h3', {}, plot.title + unit, ' ', element('small', {}, plot.note));
    place.append(element('div', {className: 'plot'}, title, line, box));
    const rows = rowsOf(plot);
    const draw = () => {
      drawn = new Dygraph(box, rows, {
        ...optionsOf(plot, xLabel),
        ...(rows.length === 1 ? {dateWindow: [rows[0][0] * 0.5, rows[0][0] * 2]} : {}),
        highlightCallback: (_, x) => group.moveTo(x),
      });
      return drawn;
    };
    const xs = rows.map(([x]) => x);
    box.addEventListener('keydown', (event) => {
      const at = nearest(xs, group.cursor ?? xs[0]);
      const to = {ArrowLeft: at - 1, ArrowRight: at + 1, Home: 0, End: xs.length - 1}[event.key];
      if (to === undefined) return;
      event.preventDefault();
      group.moveTo(xs[Math.min(Math.max(to, 0), xs.length - 1)]);
    });
    return {
      draw,
      read,
      select: (x) => drawn.setSelection(nearest(xs, x)),
      destroy: () => drawn.destroy(),
    };
  };

  // The plots of a group have one cursor.
  class Group {
    constructor(data) {
      this.data = data;
      this.cursor = null;
      this.plots = [];
      this.onCursor = () => {}; // called when the user moves the cursor
      this.place = element('div', {className: 'group'});
    }

    // Replaces the elements of the group.
    lay() {
      for (const plot of this.plots.splice(0)) plot.destroy();
      this.place.replaceChildren();
      this.data.plots.forEach((plot, i, all) => {
        const xLabel = all.length <= 4 || i === all.length - 1 ? this.data.x_label : '';
        this.plots.push(addPlot(this.place, plot, xLabel, this));
      });
    }

    draw() {
      const drawn = this.plots.map((plot) => plot.draw());
      if (drawn.length > 1) Dygraph.synchronize(drawn, {range: false, selection: false});
      if (this.cursor !== null) this.show(this.cursor);
    }

    show(x) {
      this.cursor = x;
      for (const plot of this.plots) {
        plot.read(x);
        plot.select(x);
      }
    }

    moveTo(x) {
      this.show(x);
      this.onCursor(x);
    }
  }

  const groups = content.groups.map((group) => new Group(group));
  const place = document.getElementById('plots-of-page');
  for (const group of groups) {
    if (group.data.title) place.append(element('h2', {}, group.data.title));
    place.append(group.place);
  }
  if (place) {
    const hint =
      'Drag in a plot to zoom, shift-drag to pan, double-click for the whole range. ' +
      'A click on a name hides the line.';
    place.prepend(element('p', {className: 'hint'}, hint));
  }
  const drawAll = () => {
    for (const group of groups) group.lay();
    for (const group of groups) group.draw();
  };
  drawAll();
  attest.onColoursChanged(drawAll);
  attest.drawPlots = drawAll;
  attest.plotGroups = groups;
  attest.replay = content.replay;
})();
