// SPDX-License-Identifier: BSD-3-Clause
"use strict";
// Draws the scene of the page: meshes as triangles, spheres as exact ray-cast balls on squares.
(() => {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const canvas = document.getElementById("canvas");
  const gl = canvas.getContext("webgl2", {antialias: true});
  if (!gl) {
    const failure = document.getElementById("failure");
    failure.textContent = "This browser cannot draw WebGL 2.";
    failure.hidden = false;
    return;
  }

  const kMeshColor = [0.62, 0.66, 0.72];
  const kSphereColors = [[0.16, 0.47, 0.84], [0.92, 0.49, 0.13], [0.18, 0.63, 0.37],
                         [0.66, 0.33, 0.75], [0.84, 0.24, 0.31], [0.10, 0.62, 0.66]];
  const kFieldOfView = 0.7;  // radians, vertical

  const kLighting = `
    vec3 shade(vec3 color, vec3 normal) {
      float front = 0.5 + 0.5 * dot(normal, normalize(vec3(0.35, 0.55, 0.75)));
      return color * (0.35 + 0.75 * front);
    }`;

  const kMeshVertex = `#version 300 es
    uniform mat4 clip_from_eye, eye_from_world;
    in vec3 position;
    out vec3 eye_position;
    void main() {
      vec4 eye = eye_from_world * vec4(position, 1.0);
      eye_position = eye.xyz;
      gl_Position = clip_from_eye * eye;
    }`;

  const kMeshFragment = `#version 300 es
    precision highp float;
    uniform vec4 color;
    in vec3 eye_position;
    out vec4 pixel;
    ${kLighting}
    void main() {
      vec3 normal = normalize(cross(dFdx(eye_position), dFdy(eye_position)));
      pixel = vec4(shade(color.rgb, normal), color.a);
    }`;

  // A square through the centre, perpendicular to the line of sight, that just covers the ball:
  // its half side is r d / sqrt(d^2 - r^2) for a ball of radius r at distance d.
  const kSphereVertex = `#version 300 es
    uniform mat4 clip_from_eye, eye_from_world;
    in vec2 corner;
    in vec4 ball;
    out vec3 ray;
    flat out vec4 eye_ball;
    void main() {
      vec3 center = (eye_from_world * vec4(ball.xyz, 1.0)).xyz;
      float d = length(center), r = ball.w;
      float side = r * d / sqrt(max(d * d - r * r, 0.04 * r * r));
      vec3 sight = center / max(d, 1e-20);
      vec3 across = normalize(cross(sight, abs(sight.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0)));
      ray = center + side * 1.5 * (corner.x * across + corner.y * cross(across, sight));
      eye_ball = vec4(center, r);
      gl_Position = clip_from_eye * vec4(ray, 1.0);
    }`;

  const kSphereFragment = `#version 300 es
    precision highp float;
    uniform mat4 clip_from_eye;
    uniform vec4 color;
    in vec3 ray;
    flat in vec4 eye_ball;
    out vec4 pixel;
    ${kLighting}
    void main() {
      vec3 direction = normalize(ray);
      float along = dot(direction, eye_ball.xyz);
      vec3 offset = eye_ball.xyz - along * direction;
      float chord = eye_ball.w * eye_ball.w - dot(offset, offset);
      if (chord < 0.0) discard;
      vec3 hit = (along - sqrt(chord)) * direction;
      vec4 clip = clip_from_eye * vec4(hit, 1.0);
      float depth = 0.5 + 0.5 * clip.z / clip.w;
      if (hit.z > 0.0 || depth < 0.0) discard;
      gl_FragDepth = depth;
      pixel = vec4(shade(color.rgb, (hit - eye_ball.xyz) / eye_ball.w), color.a);
    }`;

  function make_program(vertex, fragment) {
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) {
        throw new Error(gl.getShaderInfoLog(shader));
      }
      gl.attachShader(program, shader);
    }
    ["position", "corner", "ball"].forEach((name, i) => gl.bindAttribLocation(program, i, name));
    gl.linkProgram(program);
    const uniform = (name) => gl.getUniformLocation(program, name);
    return {program, clip: uniform("clip_from_eye"), eye: uniform("eye_from_world"),
            color: uniform("color")};
  }
  const mesh_program = make_program(kMeshVertex, kMeshFragment);
  const sphere_program = make_program(kSphereVertex, kSphereFragment);

  function decode(text) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return bytes.buffer;
  }
  function make_buffer(data, target = gl.ARRAY_BUFFER) {
    const buffer = gl.createBuffer();
    gl.bindBuffer(target, buffer);
    gl.bufferData(target, data, gl.STATIC_DRAW);
    return buffer;
  }
  const square = make_buffer(new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]));

  function load_mesh(item) {
    const corners = new Uint32Array(decode(item.corners));
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    make_buffer(new Float32Array(decode(item.positions)));
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    make_buffer(corners, gl.ELEMENT_ARRAY_BUFFER);
    return {array, count: corners.length};
  }
  function load_level(text) {
    const balls = new Float32Array(decode(text));
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, square);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 2, gl.FLOAT, false, 0, 0);
    make_buffer(balls);
    gl.enableVertexAttribArray(2);
    gl.vertexAttribPointer(2, 4, gl.FLOAT, false, 0, 0);
    gl.vertexAttribDivisor(2, 1);
    return {array, count: balls.length / 4};
  }

  let sphere_sets = 0;
  const items = scene.items.map((item) => {
    const is_mesh = item.kind === "mesh";
    const levels = is_mesh ? [load_mesh(item)] : item.levels.map(load_level);
    const color = is_mesh ? kMeshColor : kSphereColors[sphere_sets++ % kSphereColors.length];
    return {name: item.name, is_mesh, levels, level: levels.length - 1, color, shown: item.shown};
  });
  const opacity = document.getElementById("opacity");
  if (items.some((item) => item.is_mesh)) opacity.value = 0.45;

  // Camera: the world is turned about the middle of the scene, then stands `distance` ahead.
  const home = {yaw: 0.6, pitch: 0.45, distance: 0.5 * scene.size / Math.sin(kFieldOfView / 2),
                x: 0, y: 0};
  let camera = {...home};

  function eye_from_world() {
    const [cy, sy] = [Math.cos(camera.yaw), Math.sin(camera.yaw)];
    const [cp, sp] = [Math.cos(camera.pitch), Math.sin(camera.pitch)];
    // Columns are the images of the world's axes; z points up in the world.
    return new Float32Array([
      cy, sp * sy, -cp * sy, 0,
      -sy, sp * cy, -cp * cy, 0,
      0, cp, sp, 0,
      camera.x, camera.y, -camera.distance, 1]);
  }
  function clip_from_eye(aspect) {
    const focal = 1 / Math.tan(kFieldOfView / 2);
    const near = Math.max(camera.distance - 2 * scene.size, camera.distance * 0.01);
    const far = camera.distance + 2 * scene.size;
    return new Float32Array([
      focal / aspect, 0, 0, 0,
      0, focal, 0, 0,
      0, 0, (near + far) / (near - far), -1,
      0, 0, 2 * near * far / (near - far), 0]);
  }

  function draw_spheres(item, alpha) {
    const level = item.levels[item.level];
    gl.uniform4f(sphere_program.color, ...item.color, alpha);
    gl.bindVertexArray(level.array);
    const draw = () => gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, level.count);
    if (alpha >= 1) return draw();
    // Depth first, then colour: only the outer skin of the union is blended over what it hides.
    gl.colorMask(false, false, false, false);
    draw();
    gl.colorMask(true, true, true, true);
    gl.enable(gl.BLEND);
    draw();
    gl.disable(gl.BLEND);
  }

  let drawing = false;
  function draw() {
    drawing = false;
    const scale = window.devicePixelRatio || 1;
    const [width, height] = [innerWidth * scale, innerHeight * scale].map(Math.round);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const [clip, eye] = [clip_from_eye(width / height), eye_from_world()];
    for (const program of [mesh_program, sphere_program]) {
      gl.useProgram(program.program);
      gl.uniformMatrix4fv(program.clip, false, clip);
      gl.uniformMatrix4fv(program.eye, false, eye);
      for (const item of items) {
        if (!item.shown || item.is_mesh !== (program === mesh_program)) continue;
        if (!item.is_mesh) {
          draw_spheres(item, Number(opacity.value));
          continue;
        }
        gl.uniform4f(program.color, ...item.color, 1);
        gl.bindVertexArray(item.levels[0].array);
        gl.drawElements(gl.TRIANGLES, item.levels[0].count, gl.UNSIGNED_INT, 0);
      }
    }
  }
  function redraw() {
    if (!drawing) requestAnimationFrame(draw);
    drawing = true;
  }

  const short_name = (path) => path.slice(path.lastIndexOf("/") + 1);
  function element(tag, properties, ...children) {
    const node = Object.assign(document.createElement(tag), properties);
    node.append(...children);
    return node;
  }
  document.querySelector("h1").textContent = short_name(document.title);
  for (const item of items) {
    const box = element("input", {type: "checkbox", checked: item.shown});
    box.addEventListener("change", () => {
      item.shown = box.checked;
      redraw();
    });
    const swatch = element("span", {className: "swatch"});
    swatch.style.background = `rgb(${item.color.map((c) => Math.round(255 * c)).join(",")})`;
    const note = element("p", {className: "note"});
    const row = element("div", {className: "item"},
                        element("label", {title: item.name}, box, swatch,
                                element("span", {}, short_name(item.name))), note);
    const describe = () => {
      const count = item.levels[item.level].count;
      note.textContent = item.is_mesh ? `${count / 3} triangles`
        : item.levels.length === 1 ? `${count} spheres`
        : `level ${item.level} of ${item.levels.length - 1}: ${count} spheres`;
    };
    describe();
    if (item.levels.length > 1) {
      const slider = element("input", {type: "range", min: 0, max: item.levels.length - 1, step: 1,
                                       value: item.level, ariaLabel: `level of ${item.name}`});
      slider.addEventListener("input", () => {
        item.level = Number(slider.value);
        describe();
        redraw();
      });
      row.append(slider);
    }
    document.getElementById("items").append(row);
  }

  function turn(dx, dy) {
    camera.yaw += dx;
    camera.pitch = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, camera.pitch + dy));
  }
  function zoom(factor) {
    camera.distance = Math.min(20 * scene.size, Math.max(0.02 * scene.size,
                                                         camera.distance * factor));
  }
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons === 0) return;
    if (event.buttons & 1 && !event.shiftKey) {
      turn(event.movementX * 0.008, event.movementY * 0.008);
    } else {
      const step = 2 * camera.distance * Math.tan(kFieldOfView / 2) / innerHeight;
      camera.x += event.movementX * step;
      camera.y -= event.movementY * step;
    }
    redraw();
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(event.deltaY * 0.001));
    redraw();
  }, {passive: false});
  canvas.addEventListener("dblclick", () => {
    camera = {...home};
    redraw();
  });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("keydown", (event) => {
    const actions = {ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0),
                     ArrowUp: () => turn(0, -0.1), ArrowDown: () => turn(0, 0.1),
                     "+": () => zoom(0.9), "-": () => zoom(1.1)};
    if (!actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
    redraw();
  });
  opacity.addEventListener("input", redraw);
  window.addEventListener("resize", redraw);
  redraw();
})();
