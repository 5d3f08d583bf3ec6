// SPDX-License-Identifier: BSD-3-Clause
// The scene as a PNG of a chosen size, with the labels that stand in it.
const kLargestPicture = 8192;

function picture_size() {
  const limit = Math.min(kLargestPicture, context.getParameter(context.MAX_RENDERBUFFER_SIZE));
  return ["picture-width", "picture-height"].map((id) => {
    const value = Math.round(Number(panel_part(id).value)) || 0;
    return Math.min(limit, Math.max(16, value));
  });
}

// A label at its place on the page, carried over to the picture.
function paint_label(paint, label, place, scale) {
  const style = getComputedStyle(label);
  const size = 13 * scale;
  paint.font = `600 ${size}px system-ui, "DejaVu Sans", sans-serif`;
  const width = paint.measureText(label.textContent).width + size;
  paint.fillStyle = style.backgroundColor;
  paint.lineWidth = scale;
  paint.fillRect(place.x, place.y - 0.8 * size, width, 1.6 * size);
  paint.strokeStyle = style.color;
  paint.strokeRect(place.x, place.y - 0.8 * size, width, 1.6 * size);
  paint.fillStyle = style.color;
  paint.textBaseline = "middle";
  paint.fillText(label.textContent, place.x + 0.5 * size, place.y);
}

function paint_labels(paint, areas, width, height) {
  const scale = Math.max(1, height / 900);
  const labels = contact_labels.map((label, i) => ({label, world: shown_contacts[i].place, pane: 0}));
  if (measure.points.length === 2) {
    const [a, b] = measure.points.map(world_place);
    labels.push({label: measure.label, world: a.add(b).multiplyScalar(0.5),
                 pane: measure.points[1].pane});
  }
  if (labelled_leak && leak_shown(labelled_leak)) {
    labels.push({label: document.querySelector("#label span"), world: world_place(labelled_leak),
                 pane: pane_of(labelled_leak.item)});
  }
  let lowest = -Infinity;
  const placed = labels.map(({label, world, pane}) => {
    aim_at(areas[Math.max(pane, 0)], width, height);
    const place = pixel_of(world, width, height);
    return {label, ...place, x: place.x + 12 * scale};
  }).filter((one) => one.seen).sort((a, b) => a.y - b.y);
  for (const one of placed) {
    one.y = Math.max(one.y, lowest + 26 * scale);
    lowest = one.y;
    paint_label(paint, one.label, one, scale);
  }
}

// What stands above each of several panes, and the lines between them.
function paint_panes(paint, areas, height) {
  if (areas.length < 2) return;
  const size = 13 * Math.max(1, height / 900);
  const style = getComputedStyle(document.body);
  paint.textBaseline = "top";
  areas.forEach((area, k) => {
    paint.font = `600 ${size}px system-ui, "DejaVu Sans", sans-serif`;
    paint.fillStyle = style.color;
    paint.textAlign = "center";
    paint.fillText(pane_title(pane_sets[k]).join(" · "), area.x + area.width / 2, area.y + size,
                   area.width - size);
    paint.strokeStyle = theme().grid;
    paint.strokeRect(area.x, area.y, area.width, area.height);
  });
  paint.textAlign = "left";
}

// All that the camera sees, without what the panel covers.
function make_picture(width, height) {
  renderer.setPixelRatio(1);
  renderer.setSize(width, height, false);
  const areas = split_area({x: 0, y: 0, width, height});
  shared_uniforms.viewport.value.set(width, height);
  place_cut(camera);
  place_measure();
  draw_panes(areas, width, height, (k) => aim_at(areas[k], width, height));
  const made = node("canvas", {width, height});
  const paint = made.getContext("2d");
  paint.drawImage(canvas, 0, 0);
  paint_panes(paint, areas, height);
  paint_labels(paint, areas, width, height);
  fit_view();  // the window's own again
  redraw();
  return made;
}

function save_picture() {
  const [width, height] = picture_size();
  [panel_part("picture-width").value, panel_part("picture-height").value] = [width, height];
  make_picture(width, height).toBlob((blob) => {
    const name = short_name(document.title).replace(/\.[^.]*$/, "") || "picture";
    const link = node("a", {href: URL.createObjectURL(blob), download: `${name}.png`});
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
}

function add_tools() {
  panel_part("measure").addEventListener("click", switch_measure);
  panel_part("save-picture").addEventListener("click", save_picture);
  const ratio = Math.min(devicePixelRatio || 1, 2);
  panel_part("picture-width").value = Math.round(innerWidth * ratio);
  panel_part("picture-height").value = Math.round(innerHeight * ratio);
}
