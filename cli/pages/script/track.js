// SPDX-License-Identifier: BSD-3-Clause
// The trajectory as a strip of verdicts, and below it the clearance as a curve.
const kStripHeight = 9;
const track_canvas = document.getElementById("track");

// Pixels of the drawing area that stand for places on the trajectory.
const place_of_pixel = (x, width) => trajectory.last * x / Math.max(width - 1, 1);

// The worst verdict between two places.
function worst_verdict(from, to) {
  const cells = trajectory.verdicts;
  const shift = trajectory.motions ? 0 : 0.5;
  const first = Math.max(0, Math.floor(from + shift));
  const last = Math.min(cells.length - 1, Math.max(first, Math.ceil(to + shift) - 1));
  let worst = "f";
  for (let k = Math.min(first, cells.length - 1); k <= last; ++k) {
    if (kVerdictRank[cells[k]] > kVerdictRank[worst]) worst = cells[k];
  }
  return worst;
}

function draw_strip(paint, width, ratio) {
  const letter_of = (x) => worst_verdict(place_of_pixel(x, width), place_of_pixel(x + 1, width));
  let run = 0;
  let letter = letter_of(0);
  for (let x = 1; x <= width; ++x) {
    const next = x < width ? letter_of(x) : null;
    if (next === letter) continue;
    paint.fillStyle = verdict_colour(letter);
    paint.fillRect(run, 0, x - run, kStripHeight * ratio);
    run = x;
    letter = next;
  }
}

// The smallest clearance that falls on each pixel; between configurations a line joins them.
function clearance_points(width) {
  const values = trajectory.clearance;
  const points = [];
  for (let k = 0; k < values.length; ++k) {
    if (!Number.isFinite(values[k])) continue;
    const x = trajectory.last > 0 ? k / trajectory.last * (width - 1) : 0;
    const before = points[points.length - 1];
    if (before && Math.floor(before.x) === Math.floor(x)) {
      before.value = Math.min(before.value, values[k]);
    } else {
      points.push({x, value: values[k]});
    }
  }
  return points;
}
const greatest_clearance = trajectory
    ? trajectory.clearance.reduce((most, value) => Number.isFinite(value) ? Math.max(most, value) : most, 0)
    : 0;

function draw_curve(paint, width, top, height) {
  const points = clearance_points(width);
  if (points.length === 0) return;
  const y_of = (value) => top + height - 1 - (height - 3) * value / (greatest_clearance || 1);
  paint.beginPath();
  paint.moveTo(points[0].x, top + height);
  for (const {x, value} of points) paint.lineTo(x, y_of(value));
  paint.lineTo(points[points.length - 1].x, top + height);
  paint.fillStyle = theme().curve_fill;
  paint.fill();
  paint.beginPath();
  points.forEach(({x, value}, i) => i ? paint.lineTo(x, y_of(value)) : paint.moveTo(x, y_of(value)));
  paint.strokeStyle = theme().lines[2];
  paint.stroke();
}

function draw_track() {
  const ratio = Math.min(devicePixelRatio || 1, 2);
  const box = track_canvas.getBoundingClientRect();
  const [width, height] = [Math.max(1, Math.round(box.width * ratio)), Math.round(box.height * ratio)];
  if (track_canvas.width !== width || track_canvas.height !== height) {
    Object.assign(track_canvas, {width, height});
  }
  const paint = track_canvas.getContext("2d");
  paint.clearRect(0, 0, width, height);
  paint.lineWidth = 1.5 * ratio;
  draw_strip(paint, width, ratio);
  const top = (kStripHeight + 3) * ratio;
  draw_curve(paint, width, top, height - top);
  const x = trajectory.last > 0 ? place_on_trajectory / trajectory.last * (width - 1) : 0;
  paint.fillStyle = theme().outline;
  paint.fillRect(Math.round(x - 0.75 * ratio), 0, Math.ceil(1.5 * ratio), height);
}
