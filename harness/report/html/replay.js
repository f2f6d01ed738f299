// The animation of a flight: the attitude at the time of the slider or of the cursor in a plot.
'use strict';
(() => {
  const place = document.querySelector('.replay');
  if (!place) return;
  const {element, floats, colour, nearest} = attest;

  // Quaternions rotate from the body (forward, right, down) to the world (north, east, down).
  const rotated = ([w, x, y, z], [a, b, c]) => {
    const t = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
    return [
      a + w * t[0] + y * t[2] - z * t[1],
      b + w * t[1] + z * t[0] - x * t[2],
      c + w * t[2] + x * t[1] - y * t[0],
    ];
  };

  // An oblique view from behind, from the right and from above.
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

  const vehicles = attest.replay.map(({name, time, attitude, setpoint}) => ({
    name,
    times: floats(time),
    attitude: attitude.map(floats),
    setpoint: setpoint.map(floats),
  }));
  const times = vehicles.map((vehicle) => vehicle.times).sort((a, b) => b.at(-1) - a.at(-1))[0];

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

  // `quiet` is for the setpoint. The second vehicle has one colour and thin lines.
  const quiet = {front: 'quiet', back: 'quiet', up: 'quiet', width: 1.5, pattern: [5, 4]};
  const solid = [
    {front: 'got', back: 'expected', up: 'pass', width: 3, pattern: []},
    {front: 'broken', back: 'broken', up: 'broken', width: 1.5, pattern: []},
  ];

  const draw = (time) => {
    const context = canvas.getContext('2d');
    context.setTransform(2, 0, 0, 2, 0, 0);
    context.clearRect(0, 0, size, size);
    vehicles.forEach((vehicle, i) => {
      const frame = nearest(vehicle.times, time);
      const at = (four) => four.map((values) => values[frame]);
      const hasSetpoint = i === 0 && Math.hypot(...at(vehicle.setpoint)) > 0.5;
      if (hasSetpoint) drawVehicle(context, size, at(vehicle.setpoint), quiet);
      drawVehicle(context, size, at(vehicle.attitude), solid[i % solid.length]);
    });
    clock.textContent = `${time.toFixed(3)} s`;
  };

  const plots = attest.plotGroups[0];
  const showTime = (time) => {
    slider.value = nearest(times, time);
    draw(time);
    plots?.show(time);
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
      const time = Math.min(from + (performance.now() - begin) / 1000, times.at(-1));
      showTime(time);
      if (time >= times.at(-1)) stop();
    }, 33);
  });
  slider.addEventListener('input', () => showTime(times[Number(slider.value)]));
  if (plots) {
    plots.onCursor = (time) => {
      stop();
      slider.value = nearest(times, time);
      draw(time);
    };
  }

  const second = vehicles[1] ? ` ${vehicles[1].name} is purple.` : '';
  place.append(
    canvas,
    element('p', {className: 'tools'}, play, slider, clock),
    element(
      'p',
      {className: 'hint'},
      `The vehicle is seen from behind. Its front arms are orange, its setpoint is dashed.${second}`
    )
  );
  showTime(times[0]);
  attest.onColoursChanged(() => {
    attest.drawPlots();
    draw(times[Number(slider.value)]);
  });
})();
