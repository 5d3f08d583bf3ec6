// SPDX-License-Identifier: BSD-3-Clause
// What all shaders have in common: the light, and the cut.
const shared_uniforms = {
  // The points p with cut.xyz . p > cut.w, in the frame of the eye, are cut away.
  cut: {value: new THREE.Vector4(0, 0, 0, 1)},
  viewport: {value: new THREE.Vector2(1, 1)},  // pixels
};

const kShading = `
  uniform vec4 cut;
  bool is_cut_away(vec3 p) { return dot(cut.xyz, p) > cut.w; }
  // A lamp above the left shoulder, a weaker one from the right, and the sky.
  vec3 shade(vec3 base, vec3 normal) {
    float lamp = max(dot(normal, normalize(vec3(-0.45, 0.65, 0.75))), 0.0);
    float fill = max(dot(normal, normalize(vec3(0.8, 0.1, 0.4))), 0.0);
    float gloss = pow(max(dot(normal, normalize(vec3(-0.25, 0.36, 1.0))), 0.0), 40.0);
    float sky = 0.5 + 0.5 * normal.y;
    return base * (0.40 + 0.16 * sky + 0.46 * lamp + 0.22 * fill) + 0.08 * gloss;
  }`;

// The materials of both passes by which a translucent body shows its outer skin only: depth first,
// then the colour of what is nearest, by the stencil once a pixel where several are equally near.
function make_materials(vertexShader, fragmentShader, order, uniforms, options = {}) {
  const settings = {vertexShader, fragmentShader, uniforms: {...shared_uniforms, ...uniforms},
                    side: THREE.DoubleSide, transparent: true,
                    extensions: {fragDepth: true, derivatives: true}, ...options};
  return {
    depth: new THREE.ShaderMaterial({...settings, colorWrite: false}),
    colour: new THREE.ShaderMaterial({
      ...settings, stencilRef: order + 1, stencilFunc: THREE.NotEqualStencilFunc,
      stencilZPass: THREE.ReplaceStencilOp}),
  };
}
function set_alpha(materials, alpha) {
  const {depth, colour: front} = materials;
  front.uniforms.alpha.value = alpha;
  front.transparent = front.stencilWrite = alpha < 1;
  depth.visible = alpha < 1;
}

// A geometry as it is drawn in its turn; bodies with a lower order are drawn before.
function make_drawing(geometry, material, order) {
  const drawing = new THREE.Mesh(geometry, material);
  drawing.frustumCulled = false;
  drawing.renderOrder = order;
  return drawing;
}
// Both passes of it.
function make_body(geometry, materials, order) {
  const body = new THREE.Group();
  body.add(make_drawing(geometry, materials.depth, 2 * order),
           make_drawing(geometry, materials.colour, 2 * order + 1));
  return body;
}
