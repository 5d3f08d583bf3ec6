// SPDX-License-Identifier: BSD-3-Clause
// Plays the trajectory: a button, a slider, a strip of verdicts with the clearance as a curve below
// it, and what is known of the place shown.
const kSpeeds = [0.25, 0.5, 1, 2, 4];
// Seconds that the whole takes at speed 1: so many a configuration, within limits.
const kSecondsEach = 0.5;
const play_seconds = trajectory
    ? Math.min(40, Math.max(3, kSecondsEach * Math.max(trajectory.last, 1))) : 0;
const greatest_clearance = trajectory
    ? trajectory.clearance.filter(Number.isFinite).reduce((a, b) => Math.max(a, b), 0) : 0;

const player = {playing: false, before: 0, slider: null, moves_robot: false};

// Where the slider moves the robot, what touches there is shown; a joint moved by hand hides it.
function go_to(at) {
  const place = Math.min(trajectory.last, Math.max(0, at));
  show_place(place, configuration_at(place), point_near(place));
}
function go_to_point(point) {
  set_playing(false);
  const positions = point.positions ? floats_of(point.positions)
                                    : shown_configuration(Math.round(point.at));
  show_place(point.at, positions, point);
}
function show_place(at, positions, point) {
  place_on_trajectory = at;
  player.moves_robot = true;
  set_configuration(positions);
  player.moves_robot = false;
  player.slider.set_value(at);
  const contacts = point ? contacts_of(point) : [];
  show_contacts(contacts);
  const letter = worst_verdict(at, at);
  panel_part("place").textContent = line_text(at);
  panel_part("verdict").textContent = kVerdicts[letter];
  panel_part("verdict").className = `verdict ${letter}`;
  panel_part("clearance").textContent = clearance_text(Math.round(at));
  list_contacts(point ? `Contacts, ${point_text(point)}` : "Contacts", contacts, "none");
  draw_track();
}

function list_contacts(heading, contacts, otherwise) {
  panel_part("contact-heading").textContent = heading;
  panel_part("contact-list").replaceChildren(
      ...contacts.map(({depth, names, place}) =>
          depth_button(depth, names, () => approach(place, 0.6 * scene_size))),
      ...(contacts.length ? [] : [node("p", {className: "note"}, otherwise)]));
}

function clearance_text(k) {
  const value = trajectory.clearance[k];
  if (!Number.isFinite(value)) {
    return trajectory.skipped ? "proved free: no clearance is known" : "nothing is tested";
  }
  const [a, b] = [trajectory.nearest[2 * k], trajectory.nearest[2 * k + 1]];
  const pair = a < 0 || b < 0 ? ""
      : `, ${plain_name(trajectory.bodies[a])} – ${plain_name(trajectory.bodies[b])}`;
  return `clearance ≥ ${lower_distance_text(value)} in line ${trajectory.lines[k]}${pair}`;
}

function set_playing(is_playing) {
  player.playing = is_playing;
  player.before = performance.now();
  const play = panel_part("play");
  play.textContent = is_playing ? "❚❚" : "▶";
  play.setAttribute("aria-label", is_playing ? "Pause" : "Play");
}
function toggle_playing() {
  if (!trajectory) return;
  set_playing(!player.playing);
  if (player.playing && place_on_trajectory >= trajectory.last) go_to(0);
  if (player.playing) requestAnimationFrame(play_on);
}
function play_on(now) {
  if (!player.playing) return;
  const seconds = Math.max(0, now - player.before) / 1000;
  player.before = now;
  const speed = Number(panel_part("speed").value);
  go_to(place_on_trajectory + seconds * speed * Math.max(trajectory.last, 1) / play_seconds);
  if (place_on_trajectory >= trajectory.last) {
    set_playing(false);
  } else {
    requestAnimationFrame(play_on);
  }
}

function jump(direction) {
  const point = trajectory && next_point(place_on_trajectory, direction);
  if (point) go_to_point(point);
}

const track_canvas = panel_part("track");
const kStripHeight = 9;

// The track is a second slider: whoever presses on it goes there.
function hear_track() {
  const go = (event) => {
    if (!(event.buttons & 1)) return;
    set_playing(false);
    const box = track_canvas.getBoundingClientRect();
    go_to(trajectory.last * (event.clientX - box.left) / box.width);
  };
  track_canvas.addEventListener("pointerdown", (event) => {
    track_canvas.setPointerCapture(event.pointerId);
    go(event);
  });
  track_canvas.addEventListener("pointermove", go);
}

function draw_strip(paint, width, height) {
  const place_of = (x) => trajectory.last * x / Math.max(width - 1, 1);
  const colours = {f: "free", u: "unknown", l: "unknown", c: "leak-deep"};
  for (const letter of Object.keys(colours)) colours[letter] = colour_text(colours[letter]);
  for (let x = 0; x < width; ++x) {
    paint.fillStyle = colours[worst_verdict(place_of(x), place_of(x + 1))];
    paint.fillRect(x, 0, 1, height);
  }
}

// The smallest clearance that falls on each pixel; between configurations a line joins them.
function draw_curve(paint, width, top, height) {
  const lowest = new Map();
  trajectory.clearance.forEach((value, k) => {
    const x = Math.floor(k / Math.max(trajectory.last, 1) * (width - 1));
    const least = lowest.has(x) ? lowest.get(x) : value;
    if (Number.isFinite(value)) lowest.set(x, Math.min(value, least));
  });
  if (lowest.size === 0) return;
  const y_of = (value) => top + height - 1 - (height - 3) * value / (greatest_clearance || 1);
  const places = [...lowest].map(([x, value]) => [x, y_of(value)]);
  const curve = new Path2D();
  for (const [x, y] of places) curve.lineTo(x, y);
  const area = new Path2D(curve);
  area.lineTo(places[places.length - 1][0], top + height);
  area.lineTo(places[0][0], top + height);
  paint.fillStyle = colour_text("curve-fill");
  paint.fill(area);
  paint.strokeStyle = colour_text("accent");
  paint.stroke(curve);
}

function draw_track() {
  const ratio = Math.min(devicePixelRatio || 1, 2);
  const box = track_canvas.getBoundingClientRect();
  const width = Math.max(1, Math.round(box.width * ratio));
  const height = Math.round(box.height * ratio);
  Object.assign(track_canvas, {width, height});  // clears it
  const paint = track_canvas.getContext("2d");
  paint.lineWidth = 1.5 * ratio;
  draw_strip(paint, width, kStripHeight * ratio);
  const top = (kStripHeight + 3) * ratio;
  draw_curve(paint, width, top, height - top);
  const x = place_on_trajectory / Math.max(trajectory.last, 1) * (width - 1);
  paint.fillStyle = colour_text("outline");
  paint.fillRect(Math.round(x - 0.75 * ratio), 0, Math.ceil(1.5 * ratio), height);
}

function tell_summary() {
  const {verdicts, shown, configurations, clearance, skipped} = trajectory;
  const what = shown < configurations ? "steps" : trajectory.motions ? "motions" : "configurations";
  const parts = [`${trajectory.verdict}: ${number_text(verdicts.length)} ${what}`];
  const notes = {c: "with contacts", u: "not proved", l: "outside the joint limits"};
  for (const [letter, note] of Object.entries(notes)) {
    const count = verdicts.split(letter).length - 1;
    if (count) parts.push(`${number_text(count)} ${note}`);
  }
  const finite = clearance.filter(Number.isFinite);
  if (finite.length) {
    const least = lower_distance_text(finite.reduce((a, b) => Math.min(a, b)));
    parts.push(`spheres at least ${least} apart in each configuration shown` +
               (skipped ? " (but for links proved free of each other)" : ""));
  }
  if (shown < configurations) {
    parts.push(`${number_text(shown)} of ${number_text(configurations)} configurations are shown`);
  }
  panel_part("summary").textContent = parts.join(", ");
  panel_part("scale-note").textContent = greatest_clearance > 0
      ? `curve: how far the spheres are apart at least, to ${distance_text(greatest_clearance)}` +
        (skipped ? "; without links that are proved free of each other there" : "") : "";
}

function add_player() {
  for (const id of ["player", "contacts"]) panel_part(id).hidden = !trajectory;
  if (!trajectory) return;
  document.body.classList.add("playable");
  player.slider = slider("place on the trajectory", 0, trajectory.last, "any", 0, (at) => {
    set_playing(false);
    go_to(at);
  });
  panel_part("play-slider").append(player.slider);
  panel_part("play").addEventListener("click", toggle_playing);
  for (const [id, direction] of [["next", 1], ["previous", -1]]) {
    panel_part(id).hidden = trajectory.points.length === 0;
    panel_part(id).addEventListener("click", () => jump(direction));
  }
  panel_part("speed").append(...kSpeeds.map(
      (speed) => node("option", {value: speed, selected: speed === 1}, `${speed} ×`)));
  hear_track();
  tell_summary();
  pose_listeners.push(() => {
    if (player.moves_robot || shown_contacts.length === 0) return;
    show_contacts([]);
    list_contacts("Contacts", [], "joints were moved by hand: not checked");
  });
  theme_listeners.push(draw_track);
  window.addEventListener("resize", draw_track);
  // As in #at=2.5, and #contact=1 for the first place with contacts.
  const point = trajectory.points[Number(address_options.get("contact")) - 1];
  if (point) {
    go_to_point(point);
  } else {
    go_to(Number(address_options.get("at")) || 0);
  }
}
