// SPDX-License-Identifier: BSD-3-Clause
// What is under the pointer: the ray of its pixel met exactly with spheres and triangles. The
// pointer says what it is over; a click shows a link alone, and another one all of them again.
const pick_caster = new THREE.Raycaster();

// The first sphere of a list that a ray meets, with the disc of the cut where that opens it.
function pick_sphere(spheres, ray, plane) {
  const center = new THREE.Vector3();
  const foot = new THREE.Vector3();
  const plane_at = plane && plane.normal.dot(ray.direction) < 0 && ray.distanceToPlane(plane);
  let best = {t: Infinity, index: -1};
  for (let i = 0; i < spheres.length; i += 4) {
    center.fromArray(spheres, i);
    ray.closestPointToPoint(center, foot);
    const chord = spheres[i + 3] ** 2 - foot.distanceToSquared(center);
    if (chord < 0) continue;
    const along = foot.distanceTo(ray.origin);
    const reach = Math.sqrt(chord);
    const is_kept = !plane || plane.distanceToPoint(ray.at(along - reach, foot)) <= 0;
    if (!is_kept && !(plane_at <= along + reach)) continue;
    const t = is_kept ? along - reach : plane_at;
    if (t > 0 && t < best.t) best = {t, index: i / 4};
  }
  return best;
}

// The first triangle that a ray meets.
function pick_triangle(triangles, ray, plane) {
  const [a, b, c, hit] = [0, 1, 2, 3].map(() => new THREE.Vector3());
  let best = {t: Infinity, index: -1};
  for (let i = 0; i < triangles.length; i += 9) {
    a.fromArray(triangles, i);
    b.fromArray(triangles, i + 3);
    c.fromArray(triangles, i + 6);
    if (!ray.intersectTriangle(a, b, c, false, hit)) continue;
    const t = hit.distanceTo(ray.origin);
    if (t < best.t && (!plane || plane.distanceToPoint(hit) <= 0)) best = {t, index: i / 9};
  }
  return best;
}

// The nearest thing at a place of the window: item, part, and index of sphere or triangle; null for
// none. Leaks are marks and not met.
function pick(x, y) {
  const pane = pane_at(x, y);
  fit_view(pane);
  pick_caster.setFromCamera({x: 2 * x / innerWidth - 1, y: 1 - 2 * y / innerHeight}, camera);
  let best = null;
  for (const item of items) {
    const own = pane_of(item);
    if (!item.shown || item.kind === "leaks" || (own >= 0 && own !== pane)) continue;
    for (const part of item.parts) {
      if (!part.visible || part.box.isEmpty()) continue;
      const ray = pick_caster.ray.clone().applyMatrix4(
          new THREE.Matrix4().getInverse(frame_of(part.link).matrixWorld));
      if (item.kind === "mesh" && !ray.intersectsBox(part.box)) continue;
      const plane = cut_in(part.link);
      const found = item.kind === "mesh" ? pick_triangle(part.triangles, ray, plane)
          : pick_sphere(level_of(item, part).spheres, ray, plane);
      if (found.t < (best ? best.t : Infinity)) best = {...found, item, part};
    }
  }
  return best;
}

const kClickPixels = 4;
let hover_place = null;
let pressed_at = null;
let link_alone = -1;

function hover_text({item, part, index}) {
  const words = [part.name || (part.link >= 0 ? link_name(part.link) : "")];
  if (item.kind === "mesh") {
    words.push(part.name ? "" : item.name);
  } else {
    const level = level_of(item, part);
    words.push((item.kind === "external" ? "external " : "") + `sphere ${index}` +
               (level === last_level(part) ? "" : ` of level ${item.level}`));
    words.push(`radius ${distance_text(level.spheres[4 * index + 3])}`);
    if (sets.length > 1) words.push(item.name);
  }
  return words.filter(Boolean).join(" · ");
}

function show_hover() {
  const found = hover_place && pick(hover_place.x, hover_place.y);
  const note = panel_part("hover");
  note.hidden = !found;
  if (!found) return;
  const {x, y} = hover_place;
  note.textContent = hover_text(found);
  note.style.left = `${Math.max(4, Math.min(x + 14, innerWidth - note.offsetWidth - 4))}px`;
  note.style.top = `${y > 40 ? y - 34 : y + 18}px`;
}

// Not while the scene is turned, and once a frame at most.
let hover_waits = false;
function hover_at(event) {
  hover_place = event && event.buttons === 0 ? {x: event.clientX, y: event.clientY} : null;
  if (!hover_waits) {
    requestAnimationFrame(() => {
      hover_waits = false;
      show_hover();
    });
  }
  hover_waits = true;
}

function show_alone(link) {
  link_alone = link === link_alone ? -1 : link;
  show_links((index) => link_alone < 0 || index === link_alone);
}

function click_at(x, y) {
  const found = pick(x, y);
  if (found ? found.part.link >= 0 : link_alone >= 0) {
    show_alone(found ? found.part.link : link_alone);
  }
}

function hear_pointer() {
  canvas.addEventListener("pointermove", hover_at);
  canvas.addEventListener("pointerleave", () => hover_at(null));
  canvas.addEventListener("pointerdown", (event) => {
    const {clientX: x, clientY: y} = event;
    pressed_at = event.button === 0 && !event.shiftKey ? {x, y} : null;
  });
  canvas.addEventListener("pointerup", (event) => {
    if (!pressed_at) return;
    const moved = Math.hypot(event.clientX - pressed_at.x, event.clientY - pressed_at.y);
    pressed_at = null;
    if (moved <= kClickPixels) click_at(event.clientX, event.clientY);
  });
}
