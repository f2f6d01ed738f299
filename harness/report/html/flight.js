// The page of one flight: plots of its signals, and a replay of the attitude at the time to which
// the slider or the pointer in a plot points.
'use strict';
(() => {
  const content = document.getElementById('flight').textContent;
  if (!content) return; // the port failed before the first tick
  const {element, floats, colour, nearest, shown, styledAxes} = attest;
  const flight = JSON.parse(content);
  const names = ['expected', 'got', 'broken', 'pass', 'quiet', 'link', 'fail', 'allowed'];
  const patterns = [null, [6, 3], [2, 2]];

  // A setpoint has the colour of the signal that should follow it, and a dashed line.
  const styleOf = (series, i, count) => {
    const isPair = count === 6;
    return {
      colour: colour(names[isPair ? i % 3 : i % names.length]),
      pattern: isPair ? patterns[i < 3 ? 0 : 1] : patterns[Math.floor(i / names.length)],
      width: isPair && i < 3 ? 2 : 1.5,
    };
  };

  // Quaternions rotate from the body (forward, right, down) to the world (north, east, down).
  const rotated = ([w, x, y, z], [a, b, c]) => {
    const t = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
    return [
      a + w * t[0] + y * t[2] - z * t[1],
      b + w * t[1] + z * t[0] - x * t[2],
      c + w * t[2] + x * t[1] - y * t[0],
    ];
  };

  // Seen from behind, from the left and from above.
  const projected = ([north, east, down], size) => {
    const scale = size * 0.36;
    return [size / 2 + scale * (east + 0.35 * north), size / 2 + scale * (down - 0.35 * north)];
  };

  const arms = [
    [0.7, 0.7, 0],
    [-0.7, -0.7, 0],
    [0.7, -0.7, 0],
    [-0.7, 0.7, 0],
  ];

  const drawVehicle = (context, size, q, style) => {
    const place = (point) => projected(rotated(q, point), size);
    const line = (from, to, name, width) => {
      context.strokeStyle = colour(name);
      context.lineWidth = width;
      context.beginPath();
      context.moveTo(...place(from));
      context.lineTo(...place(to));
      context.stroke();
    };
    context.setLineDash(style.pattern);
    for (const arm of arms) {
      const name = arm[0] > 0 ? style.front : style.back;
      line([0, 0, 0], arm, name, style.width);
      context.beginPath();
      for (let i = 0; i <= 24; ++i) {
        const angle = (i * Math.PI) / 12;
        const rim = [arm[0] + 0.25 * Math.cos(angle), arm[1] + 0.25 * Math.sin(angle), 0];
        context.lineTo(...place(rim));
      }
      context.stroke();
    }
    line([0, 0, 0], [0, 0, -0.8], style.up, style.width);
    context.setLineDash([]);
  };

  const quaternionsOf = (four) => four.map(floats);
  const times = floats(flight.replay.time);
  const attitude = quaternionsOf(flight.replay.attitude);
  const setpoint = quaternionsOf(flight.replay.setpoint);

  const size = 300;
  const canvas = element('canvas', {
    width: 2 * size,
    height: 2 * size,
    role: 'img',
    'aria-label': 'The attitude of the vehicle, seen from behind, and dashed its setpoint',
  });
  const slider = element('input', {
    type: 'range',
    min: 0,
    max: times.length - 1,
    value: 0,
    'aria-label': 'Time in the flight',
  });
  const clock = element('output', {className: 'reading'});
  const play = element('button', {type: 'button'}, 'Play');

  const draw = (frame) => {
    const context = canvas.getContext('2d');
    context.setTransform(2, 0, 0, 2, 0, 0);
    context.clearRect(0, 0, size, size);
    const at = (four) => four.map((values) => values[frame]);
    const quiet = {front: 'quiet', back: 'quiet', up: 'quiet', width: 1.5, pattern: [5, 4]};
    const solid = {front: 'got', back: 'expected', up: 'pass', width: 3, pattern: []};
    if (Math.hypot(...at(setpoint)) > 0.5) drawVehicle(context, size, at(setpoint), quiet);
    drawVehicle(context, size, at(attitude), solid);
    clock.textContent = `${times[frame].toFixed(3)} s`;
  };

  const plots = [];
  const readings = [];
  const showTime = (time) => {
    for (const reading of readings) reading(time);
    for (const {plot, times: drawn} of plots) plot.setSelection(nearest(drawn, time));
  };
  const showFrame = (frame) => {
    slider.value = frame;
    draw(frame);
    showTime(times[frame]);
  };

  let timer = 0;
  const stop = () => {
    clearInterval(timer);
    timer = 0;
    play.textContent = 'Play';
  };
  play.addEventListener('click', () => {
    if (timer) return stop();
    const begin = performance.now();
    const from = Number(slider.value) >= times.length - 1 ? 0 : times[Number(slider.value)];
    play.textContent = 'Stop';
    timer = setInterval(() => {
      const frame = nearest(times, from + (performance.now() - begin) / 1000);
      showFrame(frame);
      if (frame >= times.length - 1) stop();
    }, 33);
  });
  slider.addEventListener('input', () => showFrame(Number(slider.value)));

  const addPlot = (place, data) => {
    const time = floats(data.time);
    const series = data.series.map(({name, values}, i) => ({
      name,
      values: floats(values),
      style: styleOf(name, i, data.series.length),
    }));
    const line = element('p', {className: 'reading'});
    const box = element('div', {className: 'values', role: 'img', 'aria-label': data.title});
    const unit = data.unit ? ` [${data.unit}]` : '';
    place.append(
      element('div', {className: 'plot'}, element('h3', {}, data.title + unit), line, box)
    );
    const read = (at) => {
      const i = nearest(time, at);
      line.replaceChildren(
        ...series.flatMap(({name, values, style}) => {
          const mark = element('span', {className: 'key'});
          mark.style.borderColor = style.colour;
          mark.style.borderTopStyle = style.pattern ? 'dashed' : 'solid';
          return [element('span', {}, mark, `${name} ${shown(values[i])}`), '\u2003'];
        })
      );
    };
    readings.push(read);
    const rows = time.map((t, i) => [t, ...series.map(({values}) => values[i])]);
    plots.push({
      times: time,
      plot: new Dygraph(box, rows, {
        ...styledAxes(),
        labels: ['time', ...series.map(({name}) => name)],
        colors: series.map(({style}) => style.colour),
        series: Object.fromEntries(
          series.map(({name, style}) => [
            name,
            {strokePattern: style.pattern, strokeWidth: style.width},
          ])
        ),
        stepPlot: data.title.startsWith('Saturation'),
        highlightCallback: (_, t) => {
          stop();
          showFrame(nearest(times, t));
        },
      }),
    });
  };

  const drawPlots = () => {
    for (const {plot} of plots.splice(0)) plot.destroy();
    readings.length = 0;
    const place = document.getElementById('flight-plots');
    place.replaceChildren();
    for (const data of flight.plots) addPlot(place, data);
    Dygraph.synchronize(
      plots.map(({plot}) => plot),
      {range: false, selection: false}
    );
    showFrame(Number(slider.value));
  };

  document
    .querySelector('.replay')
    .append(
      canvas,
      element('p', {className: 'tools'}, play, slider, clock),
      element(
        'p',
        {className: 'hint'},
        'The vehicle is seen from behind. Its front arms are orange, its setpoint is dashed. ' +
          'Drag in a plot to zoom, double-click for the whole flight.'
      )
    );
  drawPlots();
  attest.onColoursChanged(drawPlots);
})();
