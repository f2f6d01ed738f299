// The object `attest`, with the functions that the scripts of all pages share.
'use strict';
const attest = {};

(() => {
  const styles = () => getComputedStyle(document.documentElement);
  const colour = (name) => styles().getPropertyValue(`--${name}`).trim();

  // Texts become text nodes, so a text of a port is never read as HTML.
  attest.element = (tag, properties = {}, ...children) => {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(properties)) {
      if (name.startsWith('aria-') || name === 'role') made.setAttribute(name, value);
      else made[name] = value;
    }
    made.append(...children.filter((child) => child !== null));
    return made;
  };

  const floats = (text) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    return Array.from({length: bytes.length / 4}, (_, i) => view.getFloat32(4 * i, true));
  };

  const shown = (value, digits = 8) => {
    if (value === null || value === undefined) return '';
    if (!Number.isFinite(value)) return String(value).replace('Infinity', 'inf').toLowerCase();
    return Number(value.toPrecision(digits)).toString();
  };

  const styledAxes = () => ({
    legend: 'never',
    gridLineColor: colour('line'),
    axisLineColor: colour('line'),
    axisLabelWidth: 62,
    xRangePad: 4,
    yRangePad: 6,
    labelsKMB: false,
    digitsAfterDecimal: 6,
    axes: {
      x: {axisLabelFormatter: (t) => shown(t), pixelsPerLabel: 70},
      y: {axisLabelFormatter: (v) => shown(v), pixelsPerLabel: 22},
    },
  });

  // The index of the time nearest to `time`, because plots may be drawn at different ticks.
  const nearest = (times, time) => {
    let low = 0,
      high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle;
      else high = middle;
    }
    return times[high] - time < time - times[low] ? high : low;
  };

  // Sets the function that draws all plots again when the colours have changed.
  let redraw = () => {};
  const onColoursChanged = (draw) => {
    redraw = draw;
  };
  Object.assign(attest, {floats, colour, nearest, shown, styledAxes, onColoursChanged});

  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => redraw());
  addEventListener('beforeprint', () => {
    document.documentElement.classList.add('printing');
    redraw();
  });
  addEventListener('afterprint', () => {
    document.documentElement.classList.remove('printing');
    redraw();
  });
})();
