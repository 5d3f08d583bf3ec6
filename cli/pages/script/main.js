// SPDX-License-Identifier: BSD-3-Clause
// Starts, draws when something has changed, and hands keys on.
const context = canvas.getContext("webgl2", {antialias: true, alpha: false, stencil: true});
const renderer = context ? new THREE.WebGLRenderer({canvas, context, antialias: true}) : null;

let drawing = false;
function redraw() {
  if (!drawing && renderer) requestAnimationFrame(draw);
  drawing = true;
}
// After a change of what is shown, and not only of where it is seen from.
function refresh() {
  apply_items();
  apply_cut();
  redraw();
}

function draw() {
  drawing = false;
  const ratio = Math.min(devicePixelRatio || 1, 2);
  const size = renderer.getSize(new THREE.Vector2());
  if (renderer.getPixelRatio() !== ratio || size.x !== innerWidth || size.y !== innerHeight) {
    renderer.setPixelRatio(ratio);
    renderer.setSize(innerWidth, innerHeight, false);
  }
  renderer.getDrawingBufferSize(shared_uniforms.viewport.value);
  controls.update();  // asks for another frame while the camera still glides
  fit_view();
  place_clipping_planes();
  camera.updateMatrixWorld(true);
  place_cut();
  draw_panes();
  place_pane_titles();
  place_axes();
  place_scale();
  place_label();
  place_contact_labels();
  root.dataset.drawn = String(renderer.info.render.calls);
}

const kKeys = {
  ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0),
  ArrowUp: () => turn(0, -0.1), ArrowDown: () => turn(0, 0.1),
  "+": () => zoom(0.9), "=": () => zoom(0.9), "-": () => zoom(1.1),
  0: () => look_from("home"), 1: () => look_from("front"), 2: () => look_from("right"),
  3: () => look_from("top"), p: fold, d: switch_theme,
  " ": toggle_playing, s: switch_panes, n: () => jump(1), b: () => jump(-1),
};
function hear_keys() {
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target;
    if (target.tagName === "INPUT" && event.key.startsWith("Arrow")) return;
    // Space presses what has the focus, and plays elsewhere.
    if (target.type === "number") return;
    if (event.key === " " && target.matches("button, summary, select, [type=checkbox]")) return;
    const action = kKeys[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}

function start() {
  if (!renderer) throw new Error("this browser cannot draw WebGL 2");
  theme_listeners.push(() => {
    renderer.setClearColor(colour("ground"), 1);
    refresh();
  });
  // On a narrow screen the scene comes first; the panel is a press away.
  const panel = address_options.get("panel");
  if (panel === "none") panel_part("unfold").style.display = "none";
  if (panel === "none" || panel === "closed" || innerWidth <= kNarrowWidth && panel !== "open") {
    document.body.classList.add("bare");
  }
  add_heading();
  items.forEach(add_item);
  add_leaks();
  add_cut();
  panel_part("side-row").hidden = !can_stand_side_by_side;
  tell_panes();
  add_robot();
  add_player();
  hear_keys();
  hear_pointer();
  canvas.addEventListener("dblclick", () => look_from("home"));
  window.addEventListener("resize", fit_again);
  apply_theme();
  look_from("home");
}
start();
