// SPDX-License-Identifier: BSD-3-Clause
// A trajectory and what the check of it found; nothing is checked anew here. A place on it is a
// number: k at the k-th configuration shown, between two of them on the motion from one to the other.
const trajectory_data = scene_data.trajectory || null;
const trajectory = trajectory_data && {
  ...trajectory_data,
  lines: new Int32Array(decode(trajectory_data.lines)),
  positions: new Float32Array(decode(trajectory_data.positions)),
  clearance: new Float32Array(decode(trajectory_data.clearance)),
  nearest: new Int32Array(decode(trajectory_data.nearest)),
  points: trajectory_data.points.map(([at, line, to_line, fraction, configuration, contacts]) => ({
    at, line, to_line, fraction, contacts, configuration_text: configuration,
  })),
  last: trajectory_data.shown - 1,
};
let place_on_trajectory = 0;

const kVerdictNames = {f: "free", c: "collision", u: "not proved", l: "outside limits"};
const kVerdictRank = {f: 0, u: 1, l: 2, c: 3};
const verdict_colour = (letter) =>
    letter === "c" ? theme().leak : letter === "f" ? theme().free : theme().unknown;

// The numbers of the k-th configuration.
function shown_configuration(k) {
  const width = variable_joints.length;
  return trajectory.positions.subarray(k * width, (k + 1) * width);
}

// Straight in the numbers, continuous joints by the shorter way where that was checked.
function configuration_at(at) {
  const k = Math.min(Math.floor(at), Math.max(trajectory.last - 1, 0));
  const from = shown_configuration(k);
  const to = shown_configuration(Math.min(k + 1, trajectory.last));
  return variable_joints.map((joint, i) => {
    let step = to[i] - from[i];
    if (trajectory.shortest && joint.type === "continuous") {
      step -= 2 * Math.PI * Math.round(step / (2 * Math.PI));
    }
    return from[i] + (at - k) * step;
  });
}

// The verdict that holds at a place: of the motion it is on, or of the nearest configuration.
function verdict_at(at) {
  const cells = trajectory.verdicts.length;
  const cell = trajectory.motions ? Math.floor(at) : Math.round(at);
  return trajectory.verdicts[Math.max(0, Math.min(cell, cells - 1))];
}

// Contacts are known where the check computed them: at configurations, and where motions first touch.
// Of these the one nearest to a place, with what touches there; null if that is a free configuration.
function point_near(at) {
  let best = null;
  for (const point of trajectory.points) {
    if (!best || Math.abs(point.at - at) < Math.abs(best.at - at)) best = point;
  }
  if (!best) return null;
  return Math.abs(best.at - at) <= Math.abs(Math.round(at) - at) + 1e-6 ? best : null;
}

function next_point(at, direction) {
  const ahead = trajectory.points.filter((point) => direction * (point.at - at) > 1e-6);
  return direction > 0 ? ahead[0] : ahead[ahead.length - 1];
}

function point_configuration(point) {
  if (!point.configuration_text) return Array.from(shown_configuration(Math.round(point.at)));
  return Array.from(new Float32Array(decode(point.configuration_text)));
}

// Where on the file, for a person.
function line_text(at) {
  const k = Math.min(Math.floor(at), trajectory.last);
  const share = at - k;
  if (share < 1e-6 || k >= trajectory.last) return `line ${trajectory.lines[k]}`;
  return `line ${trajectory.lines[k]} → ${trajectory.lines[k + 1]}, ${Math.round(100 * share)} %`;
}
function point_text(point) {
  if (point.to_line === 0) return `line ${point.line}`;
  return `line ${point.line} → ${point.to_line}, ${length_text(100 * point.fraction)} %`;
}

// The contacts of a point, the deepest first.
const kContactWidth = 12;
function contacts_of(point) {
  const numbers = new Float32Array(decode(point.contacts));
  const contacts = [];
  for (let i = 0; i < numbers.length; i += kContactWidth) {
    contacts.push({
      names: [numbers[i], numbers[i + 1]].map((index) => trajectory.bodies[index]),
      depth: numbers[i + 2],
      place: new THREE.Vector3().fromArray(numbers, i + 3),
      spheres: [numbers.slice(i + 6, i + 9), numbers.slice(i + 9, i + 12)],
    });
  }
  return contacts;
}
