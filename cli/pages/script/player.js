// SPDX-License-Identifier: BSD-3-Clause
// Plays the trajectory: a button, a slider, and what is known of the place shown.
const kSpeeds = [0.25, 0.5, 1, 2, 4];
// Seconds that the whole takes at speed 1: so many a configuration, within limits.
const kSecondsEach = 0.5;
const play_seconds = trajectory
    ? Math.min(40, Math.max(3, kSecondsEach * Math.max(trajectory.last, 1))) : 0;

const player = {playing: false, speed: 1, before: 0, slider: null, moves_robot: false};

// Where the slider moves the robot, what touches there is shown; a joint moved by hand hides it.
function go_to(at) {
  show_place(at, configuration_at(at), point_near(at));
}
function go_to_point(point) {
  stop_playing();
  show_place(point.at, point_configuration(point), point);
}
function show_place(at, positions, point) {
  place_on_trajectory = at;
  player.moves_robot = true;
  set_configuration(positions);
  player.moves_robot = false;
  player.slider.set_value(at);
  const contacts = point ? contacts_of(point) : [];
  show_contacts(contacts);
  tell_place(point, contacts);
  draw_track();
}

function tell_place(point, contacts) {
  const letter = verdict_at(place_on_trajectory);
  panel_part("place").textContent = line_text(place_on_trajectory);
  const verdict = panel_part("verdict");
  verdict.textContent = kVerdictNames[letter];
  verdict.className = `verdict ${letter}`;
  const k = Math.min(Math.max(Math.round(place_on_trajectory), 0), trajectory.last);
  panel_part("clearance").textContent = clearance_text(k);
  panel_part("contact-heading").textContent = point
      ? `Contacts, ${point_text(point)}` : "Contacts";
  panel_part("contact-list").replaceChildren(...contacts.map((contact) => {
    const button = node("button", {type: "button", className: "leak"},
                        node("span", {className: "depth"}, distance_text(contact.depth)),
                        node("span", {className: "title"},
                             contact.names.map(plain_name).join(" – ")));
    button.addEventListener("click", () => approach(contact.place, 0.6 * scene_size));
    return button;
  }), ...(contacts.length ? [] : [node("p", {className: "note"}, "none")]));
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

function stop_playing() {
  player.playing = false;
  tell_playing();
}
function toggle_playing() {
  if (!trajectory) return;
  player.playing = !player.playing;
  if (player.playing && place_on_trajectory >= trajectory.last) go_to(0);
  player.before = performance.now();
  tell_playing();
  if (player.playing) requestAnimationFrame(play_on);
}
function play_on(now) {
  if (!player.playing) return;
  const seconds = Math.max(0, now - player.before) / 1000;
  player.before = now;
  const step = seconds * player.speed * Math.max(trajectory.last, 1) / play_seconds;
  go_to(Math.min(trajectory.last, place_on_trajectory + step));
  if (place_on_trajectory >= trajectory.last) {
    stop_playing();
  } else {
    requestAnimationFrame(play_on);
  }
}
function tell_playing() {
  const button = panel_part("play");
  button.textContent = player.playing ? "❚❚" : "▶";
  button.setAttribute("aria-label", player.playing ? "Pause" : "Play");
}

function jump(direction) {
  const point = trajectory && next_point(place_on_trajectory, direction);
  if (point) go_to_point(point);
}

// The track is a second slider: whoever presses on it goes there.
function hear_track() {
  const go = (event) => {
    if (!(event.buttons & 1)) return;
    stop_playing();
    const box = track_canvas.getBoundingClientRect();
    go_to(trajectory.last * Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)));
  };
  track_canvas.addEventListener("pointerdown", (event) => {
    track_canvas.setPointerCapture(event.pointerId);
    go(event);
  });
  track_canvas.addEventListener("pointermove", go);
}

function tell_summary() {
  const counts = {f: 0, u: 0, l: 0, c: 0};
  for (const letter of trajectory.verdicts) ++counts[letter];
  const what = trajectory.shown < trajectory.configurations ? "steps"
      : trajectory.motions ? "motions" : "configurations";
  const finite = Array.from(trajectory.clearance).filter(Number.isFinite);
  const parts = [`${trajectory.verdict}: ${trajectory.verdicts.length.toLocaleString("en-US")} ${what}`];
  if (counts.c) parts.push(`${counts.c.toLocaleString("en-US")} with contacts`);
  if (counts.u) parts.push(`${counts.u.toLocaleString("en-US")} not proved`);
  if (counts.l) parts.push(`${counts.l.toLocaleString("en-US")} outside the joint limits`);
  if (finite.length) {
    const least = lower_distance_text(finite.reduce((a, b) => Math.min(a, b)));
    parts.push(`spheres at least ${least} apart in each configuration shown` +
               (trajectory.skipped ? " (but for links proved free of each other)" : ""));
  }
  if (trajectory.shown < trajectory.configurations) {
    parts.push(`${trajectory.shown.toLocaleString("en-US")} of ` +
               `${trajectory.configurations.toLocaleString("en-US")} configurations are shown`);
  }
  panel_part("summary").textContent = parts.join(", ");
  panel_part("scale-note").textContent = greatest_clearance > 0
      ? `curve: how far the spheres are apart at least, to ${distance_text(greatest_clearance)}` +
        (trajectory.skipped ? "; without links that are proved free of each other there" : "") : "";
}

function add_player() {
  for (const id of ["player", "contacts"]) panel_part(id).hidden = !trajectory;
  if (!trajectory) return;
  document.body.classList.add("playable");
  player.slider = slider("place on the trajectory", 0, trajectory.last, "any", 0, (at) => {
    stop_playing();
    go_to(at);
  });
  panel_part("play-slider").append(player.slider);
  panel_part("play").addEventListener("click", toggle_playing);
  panel_part("next").addEventListener("click", () => jump(1));
  panel_part("previous").addEventListener("click", () => jump(-1));
  for (const id of ["next", "previous"]) panel_part(id).hidden = trajectory.points.length === 0;
  for (const speed of kSpeeds) {
    panel_part("speed").append(node("option", {value: speed, selected: speed === 1}, `${speed} ×`));
  }
  panel_part("speed").addEventListener("change", () => {
    player.speed = Number(panel_part("speed").value);
  });
  hear_track();
  tell_summary();
  pose_listeners.push(() => {
    if (player.moves_robot || shown_contacts.length === 0) return;
    show_contacts([]);
    panel_part("contact-heading").textContent = "Contacts";
    panel_part("contact-list").replaceChildren(
        node("p", {className: "note"}, "joints were moved by hand: not checked"));
  });
  theme_listeners.push(draw_track);
  window.addEventListener("resize", draw_track);
  // As in #at=2.5, and #contact=1 for the first place with contacts.
  const point = trajectory.points[Number(address_options.get("contact")) - 1];
  if (point) {
    go_to_point(point);
  } else {
    go_to(Math.min(trajectory.last, Math.max(0, Number(address_options.get("at")) || 0)));
  }
}
