// SPDX-License-Identifier: BSD-3-Clause
// What is under the pointer: the ray of its pixel met exactly with spheres and triangles.
const pick_caster = new THREE.Raycaster();

// The plane of the cut in the frame of a part; what is above it is cut away.
function part_cut(to_part) {
  return cut.axis >= 0 ? cut_plane().applyMatrix4(to_part) : null;
}
const kept_at = (plane, ray, t) =>
    !plane || plane.distanceToPoint(ray.at(t, new THREE.Vector3())) <= 0;

// The first sphere of a list that a ray meets, with the disc of the cut where that opens it.
function pick_sphere(spheres, ray, plane) {
  const {origin: o, direction: d} = ray;
  const slope = plane ? plane.normal.dot(d) : 0;
  const plane_at = plane && slope < 0 ? -plane.distanceToPoint(o) / slope : Infinity;
  let best = {t: Infinity, index: -1};
  for (let i = 0; i < spheres.length; i += 4) {
    const [x, y, z] = [spheres[i] - o.x, spheres[i + 1] - o.y, spheres[i + 2] - o.z];
    const along = x * d.x + y * d.y + z * d.z;
    const chord = spheres[i + 3] ** 2 - (x - along * d.x) ** 2 - (y - along * d.y) ** 2 -
                  (z - along * d.z) ** 2;
    if (chord < 0) continue;
    const reach = Math.sqrt(chord);
    let t = along - reach;
    if (!kept_at(plane, ray, t)) {
      if (plane_at > along + reach) continue;
      t = plane_at;
    }
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
    if (t < best.t && kept_at(plane, ray, t)) best = {t, index: i / 9};
  }
  return best;
}

// The nearest thing at a place of the window: item, part, index of sphere or triangle, and the point,
// in the frame of the part; null for none. Leaks are marks and not met.
function pick(x, y) {
  const pane = pane_at(x, y);
  fit_view(pane);
  pick_caster.setFromCamera({x: 2 * x / innerWidth - 1, y: 1 - 2 * y / innerHeight}, camera);
  let best = null;
  for (const item of items) {
    const own = pane_of(item);
    if (!item.shown || item.kind === "leaks" || (own >= 0 && own !== pane)) continue;
    for (const part of item.parts) {
      if (!part.group.visible || part.box.isEmpty()) continue;
      const to_part = new THREE.Matrix4().getInverse(frame_of(part.link).matrixWorld);
      const ray = pick_caster.ray.clone().applyMatrix4(to_part);
      if (item.kind === "mesh" && !ray.intersectsBox(part.box)) continue;
      const level = level_of(item, part);
      const plane = part_cut(to_part);
      const found = item.kind === "mesh" ? pick_triangle(part.triangles, ray, plane)
          : level.count > 0 ? pick_sphere(spheres_of(level), ray, plane) : {t: Infinity};
      if (found.t < (best ? best.t : Infinity)) {
        best = {...found, item, part, pane, point: ray.at(found.t, new THREE.Vector3())};
      }
    }
  }
  return best;
}
