// SPDX-License-Identifier: BSD-3-Clause
// What the page carries, how its numbers are read, and how they are written for people.
const scene_data = JSON.parse(document.getElementById("scene").textContent);
const robot_data = scene_data.robot || null;

function decode(text) {
  return Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
}

function node(tag, properties, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties || {})) {
    if (name in made) {
      made[name] = value;
    } else {
      made.setAttribute(name, value);
    }
  }
  made.append(...children);
  return made;
}

const short_name = (path) => path.slice(path.lastIndexOf("/") + 1);

// Three digits that count, without an exponent where that is readable.
function length_text(value) {
  const size = Math.abs(value);
  if (size === 0) return "0";
  if (size >= 1e6 || size < 1e-4) return value.toExponential(2);
  return String(Number(value.toPrecision(3)));
}
// The same, rounded toward zero: for a lower bound.
function lower_length_text(value) {
  if (!(Math.abs(value) > 0)) return length_text(value);
  const step = 10 ** (Math.floor(Math.log10(Math.abs(value))) - 2);
  return length_text(Number((Math.trunc(value / step) * step).toPrecision(3)));
}
// Robots are in metres, which are coarse for what is shown of them; other files name no unit.
const distance_text =
    (value) => robot_data ? `${length_text(value * 1000)} mm` : length_text(value);
const lower_distance_text = (value) =>
    robot_data ? `${lower_length_text(value * 1000)} mm` : lower_length_text(value);
const count_text = (count, thing) =>
    `${count.toLocaleString("en-US")} ${thing}${count === 1 ? "" : "s"}`;

// 1, 2 or 5 times a power of ten, at most `limit`.
function round_length(limit) {
  const power = 10 ** Math.floor(Math.log10(limit));
  return power * (limit >= 5 * power ? 5 : limit >= 2 * power ? 2 : 1);
}

// What stands after # in the address: how a page is opened in another state than the usual.
const address_options = new URLSearchParams(location.hash.slice(1));
