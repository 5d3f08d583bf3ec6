// SPDX-License-Identifier: BSD-3-Clause
// The pointer says what it is over; a click shows a link alone, and another one all of them again.
const kClickPixels = 4;
const hover_note = document.getElementById("hover");
let hover_place = null;
let pressed_at = null;
let link_alone = -1;

const part_name = (part) => part.name || (part.link >= 0 ? plain_name(robot_data.links[part.link].name) : "");

function hover_text({item, part, index}) {
  const words = [part_name(part)];
  if (item.kind === "mesh") {
    words.push(part.name ? "" : item.name);
  } else {
    const is_last = level_of(item, part) === part.levels[part.levels.length - 1];
    const radius = spheres_of(level_of(item, part))[4 * index + 3];
    words.push(item.kind === "external" ? `external sphere ${index}`
        : is_last ? `sphere ${index}` : `sphere ${index} of level ${item.level}`);
    words.push(`radius ${distance_text(radius)}`);
    if (items.filter((one) => one.kind === "spheres" || one.kind === "tree").length > 1) {
      words.push(item.name);
    }
  }
  return words.filter(Boolean).join(" · ");
}

function show_hover() {
  const found = hover_place && pick(hover_place.x, hover_place.y);
  hover_note.hidden = !found;
  if (!found) return;
  hover_note.textContent = hover_text(found);
  const width = hover_note.offsetWidth;
  hover_note.style.left = `${Math.max(4, Math.min(hover_place.x + 14, innerWidth - width - 4))}px`;
  hover_note.style.top = `${hover_place.y > 40 ? hover_place.y - 34 : hover_place.y + 18}px`;
}

// Not while the scene is turned, and after the first time once a frame at most.
let hover_waits = false;
function hover_at(event) {
  hover_place = event && event.buttons === 0 ? {x: event.clientX, y: event.clientY} : null;
  if (hover_waits) return;
  hover_waits = true;
  show_hover();
  const shown = hover_place;
  requestAnimationFrame(() => {
    hover_waits = false;
    if (hover_place !== shown) show_hover();
  });
}

function show_alone(link) {
  link_alone = link === link_alone ? -1 : link;
  show_links((index) => link_alone < 0 || index === link_alone);
}

function click_at(x, y) {
  const found = pick(x, y);
  if (found && found.part.link >= 0) {
    show_alone(found.part.link);
  } else if (!found && link_alone >= 0) {
    show_alone(link_alone);
  }
}

function hear_pointer() {
  canvas.addEventListener("pointermove", hover_at);
  canvas.addEventListener("pointerleave", () => hover_at(null));
  canvas.addEventListener("pointerdown", (event) => {
    pressed_at = event.button === 0 && !event.shiftKey ? {x: event.clientX, y: event.clientY} : null;
  });
  canvas.addEventListener("pointerup", (event) => {
    if (!pressed_at) return;
    const moved = Math.hypot(event.clientX - pressed_at.x, event.clientY - pressed_at.y);
    pressed_at = null;
    if (moved <= kClickPixels) click_at(event.clientX, event.clientY);
  });
}
