// SPDX-License-Identifier: BSD-3-Clause
// Colours of what is drawn. Those of the panel are in the style sheet.
const kThemes = {
  light: {ground: "#f3f5f8", grid: "#cdd3dc", mesh: "#a9b0bb", obstacle: "#c4b295",
          edge: "#4d5563", outline: "#10141b",
          leak: "#d40a26", leak_shallow: "#ffd24a", free: "#2f9e5b", unknown: "#d98a1a",
          curve_fill: "rgba(47, 111, 214, 0.16)", external: "#c98a1b", lines: ["#d23a4b", "#2c9a4b", "#2f6fd6"],
          spheres: ["#3b82d6", "#2f9e6b", "#8a5bd0", "#d9822b", "#1a9db0", "#b0588f"]},
  dark: {ground: "#12151a", grid: "#2b313b", mesh: "#8b94a3", obstacle: "#8d7c61",
         edge: "#0c0e12", outline: "#f4f6fa",
         leak: "#ff2a40", leak_shallow: "#ffd75e", free: "#3fae6c", unknown: "#e8a23c",
         curve_fill: "rgba(106, 162, 255, 0.2)", external: "#e0a63a", lines: ["#ff6b78", "#56c776", "#6aa2ff"],
         spheres: ["#4f97ec", "#3fb783", "#a57ce8", "#ec9a48", "#31b6c9", "#cf79b0"]},
};

const dark_preferred = matchMedia("(prefers-color-scheme: dark)");
let chosen_theme = kThemes[address_options.get("theme")] ? address_options.get("theme") : null;
const theme_listeners = [];

const theme_name = () => chosen_theme || (dark_preferred.matches ? "dark" : "light");
const theme = () => kThemes[theme_name()];

// As the shaders take it: no conversion between colour spaces is made anywhere.
const colour = (text) => new THREE.Color(text);

function apply_theme() {
  document.documentElement.dataset.theme = theme_name();
  for (const listener of theme_listeners) listener();
}
function switch_theme() {
  chosen_theme = theme_name() === "dark" ? "light" : "dark";
  apply_theme();
}
dark_preferred.addEventListener("change", apply_theme);
