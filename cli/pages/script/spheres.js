// SPDX-License-Identifier: BSD-3-Clause
// Spheres, exact at any zoom: each is a square in which the ray of every pixel is met with it.

// The square stands through the centre, perpendicular to the line of sight, and covers the sphere:
// its half side is r d / sqrt(d^2 - r^2) for a sphere of radius r at distance d.
const kSphereVertex = `
  attribute vec4 sphere;
  uniform float least_radius;     // pixels; no sphere is drawn smaller
  uniform float greatest_radius;  // none larger
  uniform vec2 viewport;
  varying vec3 ray;
  flat varying vec4 eye_sphere;
  flat varying float variation;
  void main() {
    vec3 center = (modelViewMatrix * vec4(sphere.xyz, 1.0)).xyz;
    float d = length(center);
    float pixel = 2.0 * max(-center.z, 0.0) / (projectionMatrix[1][1] * viewport.y);
    float r = max(min(sphere.w, greatest_radius), least_radius * pixel);
    float side = r * d / sqrt(max(d * d - r * r, 0.04 * r * r));
    vec3 sight = center / max(d, 1e-20);
    vec3 across = normalize(cross(sight, abs(sight.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0)));
    ray = center + side * (position.x * across + position.y * cross(across, sight));
    eye_sphere = vec4(center, r);
    variation = fract(float(gl_InstanceID) * 0.754878) - 0.5;
    gl_Position = projectionMatrix * vec4(ray, 1.0);
  }`;

const kSphereFragment = `
  uniform vec3 base;
  uniform float alpha, lift, ring_tint;
  uniform mat4 projectionMatrix;
  varying vec3 ray;
  flat varying vec4 eye_sphere;
  flat varying float variation;
  ${kShading}
  void main() {
    vec3 direction = normalize(ray);
    float along = dot(direction, eye_sphere.xyz);
    vec3 offset = eye_sphere.xyz - along * direction;
    float chord = eye_sphere.w * eye_sphere.w - dot(offset, offset);
    if (chord < 0.0) discard;
    float reach = sqrt(chord);
    vec3 hit = (along - reach) * direction;
    vec3 own = base * (1.0 + 0.16 * variation);
    float nearer = 0.0;
    vec3 result;
    if (is_cut_away(hit)) {
      // The ray goes on to the plane, and shows the disc in which that cuts the sphere.
      float slope = dot(cut.xyz, direction);
      if (slope >= 0.0) discard;
      float t = cut.w / slope;
      if (t > along + reach) discard;
      hit = t * direction;
      float height = cut.w - dot(cut.xyz, eye_sphere.xyz);
      float radius = sqrt(max(eye_sphere.w * eye_sphere.w - height * height, 0.0));
      float within = radius - distance(hit, eye_sphere.xyz + height * cut.xyz);
      bool ring = within < 1.4 * fwidth(within);
      result = base * (ring ? ring_tint : 0.86);
      nearer = ring ? 2.0 * lift : lift;
    } else {
      vec3 normal = (hit - eye_sphere.xyz) / eye_sphere.w;
      float facing = dot(normal, -direction);
      result = shade(own, normal) * mix(0.62, 1.0, smoothstep(0.0, 0.45, facing));
    }
    vec4 clip = projectionMatrix * vec4(hit * (1.0 - nearer), 1.0);
    float depth = 0.5 + 0.5 * clip.z / clip.w;
    if (hit.z > 0.0 || depth < 0.0) discard;
    gl_FragDepthEXT = depth;
    gl_FragColor = vec4(result, alpha);
  }`;

// A square for each row of an array, which the attributes share: their names, how wide they are.
function make_squares(rows, attributes) {
  const geometry = new THREE.InstancedBufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(
      new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  const width = Object.values(attributes).reduce((sum, one) => sum + one, 0);
  const buffer = new THREE.InstancedInterleavedBuffer(rows, width, 1);
  let offset = 0;
  for (const [name, size] of Object.entries(attributes)) {
    geometry.setAttribute(name, new THREE.InterleavedBufferAttribute(buffer, size, offset));
    offset += size;
  }
  geometry.maxInstancedCount = geometry.instanceCount = rows.length / width;
  return geometry;
}

// Of x, y, z, radius a sphere.
const make_sphere_geometry = (spheres) => make_squares(spheres, {sphere: 4});
const sphere_drawing = (numbers, material, order) =>
    make_drawing(make_sphere_geometry(new Float32Array(numbers)), material, order);

function make_sphere_materials(order, uniforms = {}, options = {}) {
  return make_materials(kSphereVertex, kSphereFragment, order, {
    base: {value: new THREE.Color()},
    alpha: {value: 1},
    ring_tint: {value: 0.45},
    // Discs of several sets lie in one plane: later sets are drawn a little in front.
    lift: {value: 1e-4 * (1 + order)},
    least_radius: {value: 0},
    greatest_radius: {value: 1e30},
    ...uniforms,
  }, options);
}

// The box of spheres, of meshes' corners (width 3) or of spheres with their radii (width 4).
function box_of(numbers, width) {
  const box = new THREE.Box3();
  const point = new THREE.Vector3();
  for (let i = 0; i < numbers.length; i += width) {
    const reach = width === 4 ? numbers[i + 3] : 0;
    point.set(numbers[i] - reach, numbers[i + 1] - reach, numbers[i + 2] - reach);
    box.expandByPoint(point);
    point.addScalar(2 * reach);
    box.expandByPoint(point);
  }
  return box;
}
