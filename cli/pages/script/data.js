// SPDX-License-Identifier: BSD-3-Clause
// What the page carries, how its numbers are read and written for people, and its colours.
const scene_data = JSON.parse(document.getElementById("scene").textContent);
const robot_data = scene_data.robot || null;

// What stands after # in the address: how a page is opened in another state than the usual.
const address_options = new URLSearchParams(location.hash.slice(1));

const bytes_of = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
const floats_of = (text) => new Float32Array(bytes_of(text));
const integers_of = (text) => new Int32Array(bytes_of(text));

const panel_part = (id) => document.getElementById(id);

function node(tag, properties, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name in made) {
      made[name] = value;
    } else {
      made.setAttribute(name, value);
    }
  }
  made.append(...children);
  return made;
}
const span = (className, ...children) => node("span", {className}, ...children);
const button = (label, onclick, properties = {}) =>
    node("button", {type: "button", onclick, ...properties}, ...[label].flat());
const show_pressed = (made, is_pressed) => made.setAttribute("aria-pressed", String(is_pressed));

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
const distance_text = (value, to_text = length_text) =>
    robot_data ? `${to_text(value * 1000)} mm` : to_text(value);
const lower_distance_text = (value) => distance_text(value, lower_length_text);
const number_text = (number) => number.toLocaleString("en-US");
const count_text = (count, thing) => `${number_text(count)} ${thing}${count === 1 ? "" : "s"}`;

// 1, 2 or 5 times a power of ten, at most `limit`.
function round_length(limit) {
  const power = 10 ** Math.floor(Math.log10(limit));
  return power * (limit >= 5 * power ? 5 : limit >= 2 * power ? 2 : 1);
}

// Colours are those of the style sheet, also of what is drawn.
const root = document.documentElement;
const dark_preferred = matchMedia("(prefers-color-scheme: dark)");
let chosen_theme = address_options.get("theme");
const theme_listeners = [];

const theme_name = () => chosen_theme || (dark_preferred.matches ? "dark" : "light");
const colour_text = (name) => getComputedStyle(root).getPropertyValue(`--${name}`).trim();
// As the shaders take it: no conversion between colour spaces is made anywhere.
const colour = (name) => new THREE.Color(colour_text(name));

function apply_theme() {
  root.dataset.theme = theme_name();
  for (const listener of theme_listeners) listener();
}
function switch_theme() {
  chosen_theme = theme_name() === "dark" ? "light" : "dark";
  apply_theme();
}
dark_preferred.addEventListener("change", apply_theme);
