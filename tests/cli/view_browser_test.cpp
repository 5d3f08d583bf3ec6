// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/cli/robot_fixtures.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <zlib.h>

namespace spherule {
namespace {

// A picture of 8-bit red, green and blue.
struct Picture {
  using Pixel = std::array<std::uint8_t, 3>;
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Pixel> pixels;  // row by row from the top

  Pixel at(std::size_t x, std::size_t y) const { return pixels[y * width + x]; }
};

constexpr std::size_t kSignature = 8;

std::size_t big_endian(const std::string& bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  }
  return value;
}

std::uint8_t paeth(int left, int up, int corner) {
  const int guess = left + up - corner;
  const int to_left = std::abs(guess - left);
  const int to_up = std::abs(guess - up);
  const int to_corner = std::abs(guess - corner);
  if (to_left <= to_up && to_left <= to_corner) return static_cast<std::uint8_t>(left);
  return static_cast<std::uint8_t>(to_up <= to_corner ? up : corner);
}

// What a filter of the format adds to a byte.
std::uint8_t prediction(int filter, std::uint8_t left, std::uint8_t up, std::uint8_t corner) {
  switch (filter) {
    case 0:
      return 0;
    case 1:
      return left;
    case 2:
      return up;
    case 3:
      return static_cast<std::uint8_t>((left + up) / 2);
    case 4:
      return paeth(left, up, corner);
    default:
      throw std::runtime_error("png: unknown filter");
  }
}

// Of a PNG file with 8 bits a channel, RGB or RGBA (which is dropped), not interlaced: what
// browsers write. Throws std::runtime_error for others.
Picture decode_png(const std::string& bytes) {
  Picture picture;
  std::string packed;
  std::size_t channels = 0;
  for (std::size_t at = kSignature; at + 12 <= bytes.size();) {
    const std::size_t length = big_endian(bytes, at);
    const std::string type = bytes.substr(at + 4, 4);
    const std::size_t data = at + 8;
    if (type == "IHDR") {
      picture.width = big_endian(bytes, data);
      picture.height = big_endian(bytes, data + 4);
      const char colour = bytes.at(data + 9);
      if (bytes.at(data + 8) != 8 || (colour != 2 && colour != 6) || bytes.at(data + 12) != 0) {
        throw std::runtime_error("png: not 8 bits a channel, or interlaced");
      }
      channels = colour == 2 ? 3 : 4;
    } else if (type == "IDAT") {
      packed += bytes.substr(data, length);
    }
    at = data + length + 4;
  }
  const std::size_t stride = picture.width * channels;
  std::vector<std::uint8_t> rows((stride + 1) * picture.height);
  uLongf size = rows.size();
  if (rows.empty() ||
      uncompress(rows.data(), &size, reinterpret_cast<const Bytef*>(packed.data()),
                 packed.size()) != Z_OK ||
      size != rows.size()) {
    throw std::runtime_error("png: cannot be unpacked");
  }
  std::vector<std::uint8_t> above(stride, 0);
  for (std::size_t y = 0; y < picture.height; ++y) {
    std::uint8_t* row = rows.data() + y * (stride + 1);
    const int filter = *row++;
    for (std::size_t i = 0; i < stride; ++i) {
      const bool first = i < channels;
      row[i] =
          static_cast<std::uint8_t>(row[i] + prediction(filter, first ? 0 : row[i - channels],
                                                        above[i], first ? 0 : above[i - channels]));
    }
    above.assign(row, row + stride);
    for (std::size_t x = 0; x < picture.width; ++x) {
      const std::uint8_t* pixel = row + x * channels;
      picture.pixels.push_back({pixel[0], pixel[1], pixel[2]});
    }
  }
  return picture;
}

// The page as a browser shows it: opened from its file, without a network.

using Pixel = Picture::Pixel;

constexpr int kWidth = 900;
constexpr int kHeight = 600;

// A browser that can be run without a display, the quickest to start first; empty if there is none.
std::string browser() {
  for (const char* name :
       {"chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"}) {
    const std::string command = std::string("command -v ") + name + " > /dev/null 2>&1";
    if (std::system(command.c_str()) == 0) return name;
  }
  return "";
}

// What is left of a page without its scripts and the scene in one of them.
std::string without_scripts(std::string dom) {
  const std::string end = "</script>";
  for (;;) {
    const std::size_t from = dom.find("<script");
    if (from == std::string::npos) return dom;
    const std::size_t to = dom.find(end, from);
    if (to == std::string::npos) return dom.substr(0, from);
    dom.erase(from, to + end.size() - from);
  }
}

class ViewBrowserTest : public CommandTest {
 protected:
  // What the page looks like and what stands in it once it has drawn itself. `state` is what is
  // behind # in its address.
  struct Shown {
    Picture picture;
    std::string dom;
  };

  void SetUp() override {
    CommandTest::SetUp();
    if (test::kSanitized) GTEST_SKIP() << "what runs in the browser is none of our binaries";
    browser_ = browser();
    if (browser_.empty()) GTEST_SKIP() << "no chromium to open the page with";
  }

  // Compositing on an emulated graphics processor would take half the time of a start.
  Shown show(const std::string& page, const std::string& state) {
    const std::string folder = folder_.string();
    const std::string command = "cd '" + folder + "' && HOME='" + folder + "' timeout 120 " +
                                browser_ +
                                " --headless --no-sandbox --use-gl=angle --use-angle=swiftshader"
                                " --enable-unsafe-swiftshader --hide-scrollbars --no-first-run"
                                " --host-resolver-rules='MAP * ~NOTFOUND' --user-data-dir='" +
                                folder + "/.profile'" + " --window-size=" + std::to_string(kWidth) +
                                "," + std::to_string(kHeight) +
                                " --virtual-time-budget=3000 --screenshot=shot.png --dump-dom"
                                " --disable-gpu-compositing 'file://" +
                                folder + "/" + page + "#" + state + "' > dom.html 2> browser.log";
    EXPECT_EQ(std::system(command.c_str()), 0) << read("browser.log");
    Shown shown{.picture = {}, .dom = without_scripts(read("dom.html"))};
    EXPECT_TRUE(has(shown.dom, "data-drawn=")) << read("browser.log");
    EXPECT_FALSE(has(shown.dom, "data-failure="));
    if (exists("shot.png")) shown.picture = decode_png(read("shot.png"));
    return shown;
  }

  // The page with script that runs once it has drawn itself; for the page frames are 16 ms apart,
  // however long the browser takes.
  Shown act(const std::string& script, const std::string& state) {
    std::string page = read("page.html");
    page.insert(page.rfind("</body>"),
                "<script>let frame_time = performance.now();\n"
                "window.requestAnimationFrame = (call) => setTimeout(() =>"
                " call(frame_time += 16), 16);\nconst on = (type, x, y) => "
                "document.getElementById('canvas')"
                ".dispatchEvent(new PointerEvent(type, {clientX: x, clientY: y, bubbles: true,"
                " pointerId: 1}));\nconst click = (x, y) => { on('pointerdown', x, y);"
                " on('pointerup', x, y); };\nsetTimeout(() => {" +
                    script + "}, 500);</script>");
    write("acted.html", page);
    return show("acted.html", state);
  }

  std::string browser_;
};

// Right of the panel, where the scene is, or in some columns of it.
std::size_t count(const Picture& picture, const std::function<bool(const Pixel&)>& is_wanted,
                  std::size_t from = 340, std::size_t to = kWidth) {
  std::size_t number = 0;
  for (std::size_t y = 0; y < picture.height; ++y) {
    for (std::size_t x = from; x < std::min(to, picture.width); ++x) {
      number += is_wanted(picture.at(x, y));
    }
  }
  return number;
}

bool is_red(const Pixel& p) {
  return p[0] > 120 && p[0] > 2 * p[1] && p[0] > 2 * p[2];
}
bool is_blue(const Pixel& p) {
  return p[2] > p[0] + 25 && p[2] > p[1] + 10;
}
auto is_exactly(const Pixel& wanted) {
  return [wanted](const Pixel& p) { return p == wanted; };
}

TEST_F(ViewBrowserTest, LeakingPartByDay) {
  write_box("box.stl", {4, 2, 1});
  write_spheres("two.json", {{1, 1, 0.5, 1.2}, {2, 1, 0.5, 1.2}});
  expect_exit(0, "view box.stl two.json --leaks -o page.html");
  const Shown shown = show("page.html", "theme=light");
  ASSERT_EQ(shown.picture.width, static_cast<std::size_t>(kWidth));
  EXPECT_EQ(shown.picture.at(kWidth - 2, 2), (Pixel{0xf3, 0xf5, 0xf8}));
  // Marks lie on the end of the box that sticks out.
  EXPECT_GT(count(shown.picture, is_red), 500u);
  EXPECT_GT(count(shown.picture, is_blue), 5000u);
  for (const char* text : {"12 triangles", "2 spheres", "leaks: two.json", "deepest leak",
                           "found by samples", ">4 × 2 × 1<"}) {
    EXPECT_TRUE(has(shown.dom, text)) << text;
  }
}

// A set that covers beside one that leaves the end of the box; what is pressed is a cut across x.
TEST_F(ViewBrowserTest, TwoSetsSideBySide) {
  write_box("box.stl", {4, 2, 1});
  write_spheres("all.json", {{2, 1, 0.5, 2.4}});
  write_spheres("some.json", {{1, 1, 0.5, 1.6}, {2, 1, 0.5, 1.6}});
  expect_exit(0, "view box.stl all.json some.json --leaks -o page.html");
  const Shown shown = show("page.html", "theme=light");
  for (const char* text :
       {"aria-pressed=\"true\" title=\"Sets of spheres side by side", "no leak found",
        "id=\"leak-scale\"", "<span>1 sphere</span>", "<span>2 spheres</span>"}) {
    EXPECT_TRUE(has(shown.dom, text)) << text;
  }
  const std::size_t middle = (340 + kWidth) / 2;
  EXPECT_EQ(count(shown.picture, is_red, 340, middle - 60), 0u);
  EXPECT_GT(count(shown.picture, is_red, middle, kWidth), 100u);
  EXPECT_GT(count(shown.picture, is_blue, 340, middle), 3000u);
  // The deepest leak is the end at x = 4, which the home view sees; 2 is the middle.
  const Shown cut = act(
      "document.querySelectorAll('#cut button')[1].click(); document.documentElement.dataset.cut ="
      " Math.round(Number(document.querySelector('#cut output').textContent));",
      "theme=light&side=off");
  EXPECT_TRUE(has(cut.dom, "data-cut=\"4\""));
  EXPECT_FALSE(has(cut.dom, "class=\"pane-title\""));
}

TEST_F(ViewBrowserTest, CutByNight) {
  write_box("box.stl", {4, 2, 1});
  write_spheres("one.json", {{2, 1, 0.5, 2.4}});
  expect_exit(0, "tree one.json -o one.tree");
  expect_exit(0, "view box.stl one.tree -o page.html");
  // Cut in the middle, seen from where the normal points: a disc with the outline of the box on it.
  const Shown shown = show("page.html", "theme=dark&cut=-y:0.5");
  EXPECT_EQ(shown.picture.at(kWidth - 2, 2), (Pixel{0x12, 0x15, 0x1a}));
  EXPECT_GT(count(shown.picture, is_exactly({0xf4, 0xf6, 0xfa})), 300u);
  EXPECT_GT(count(shown.picture, is_blue), 20000u);
}

TEST_F(ViewBrowserTest, Robot) {
#ifndef SPHERULE_HAS_ROBOT
  GTEST_SKIP() << "built without robots";
#endif
  write("arm.urdf", R"(<?xml version="1.0"?>
<robot name="arm">
  <link name="base"><collision><geometry><box size="0.4 0.4 0.2"/></geometry></collision></link>
  <link name="boom"><collision><origin xyz="0.4 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry>
    </collision></link>
  <joint name="hip" type="revolute"><parent link="base"/><child link="boom"/>
    <origin xyz="0 0 0.2"/><axis xyz="0 0 1"/><limit lower="1" upper="2" effort="1" velocity="1"/>
  </joint>
</robot>)");
  write("arm.yml",
        "collision_spheres:\n  base:\n  - center: [0, 0, 0]\n    radius: 0.31\n"
        "  boom:\n  - center: [0.4, 0, 0]\n    radius: 0.2\n");
  const Outcome view = expect_exit(0, "view arm.urdf arm.yml --leaks -o page.html");
  const Shown shown = show("page.html", "theme=light");
  EXPECT_GT(count(shown.picture, is_blue), 3000u);
  EXPECT_GT(count(shown.picture, is_red), 60u);
  // The joint stands in the middle of its limits, which do not hold zero.
  for (const char* text : {">arm<", "2 links, 1 joint", "joint hip", "85.9°", "collision geometry",
                           "2 spheres", ">boom<", "No two links overlap by their spheres."}) {
    EXPECT_TRUE(has(shown.dom, text)) << text;
  }
}

#ifdef SPHERULE_HAS_ROBOT
// A hand that slides through a wall, and what a person does on the page: script that runs there.
class CheckedPageTest : public ViewBrowserTest {
 protected:
  void SetUp() override {
    ViewBrowserTest::SetUp();
    if (IsSkipped()) return;
    write("slider.urdf", kSlider);
    write("slider.json", R"({"hand": {"centers": [[0, 0, 0]], "radii": [0.05]}})");
    write("cell.json", wall_and(""));
    write("path.csv", "-1 0\n0.03 0\n1 0\n");
    expect_exit(1, "check slider.urdf cell.json path.csv --spheres slider.json --view page.html");
  }
  static void expect_text(const Shown& shown, const std::string& text, bool is_there = true) {
    EXPECT_EQ(shown.dom.find(text) != std::string::npos, is_there) << text;
  }
};

TEST_F(CheckedPageTest, ShowsWhatTouchesAndHowFarTheRestIs) {
  const Shown contact = show("page.html", "theme=light&contact=1");
  expect_text(contact, "hand – wall 20.5 mm");
  expect_text(contact, "Contacts, line 2");
  expect_text(contact, "collision: 3 configurations, 1 with contacts");
  EXPECT_GT(count(contact.picture, is_red), 100u);
  const Shown free = show("page.html", "theme=light&at=2");
  expect_text(free, "hand – wall 20.5 mm", false);
  expect_text(free, "clearance ≥ 949 mm in line 3, hand – wall");
  expect_text(free, "curve: how far the spheres are apart at least, to 9");
  expect_text(free, "proved free of each other", false);
  expect_text(free, "class=\"verdict f\">free<");
  // Halfway between two lines: there the joint is, too.
  const Shown between = show("page.html", "theme=light&at=1.5");
  expect_text(between, "line 2 → 3, 50 %");
  expect_text(between, ">515 mm<");
}

TEST_F(CheckedPageTest, TheSpaceKeyPlays) {
  const Shown shown =
      act("const key = () => document.body.dispatchEvent("
          "new KeyboardEvent('keydown', {key: ' ', bubbles: true}));"
          "const place = () => document.getElementById('place').textContent;"
          "key(); setTimeout(() => { key(); document.documentElement.dataset.played = place(); },"
          " 600);",
          "theme=light");
  expect_text(shown, "data-played=\"line 1 → 2, ");
  expect_text(shown, "aria-label=\"Play\"");
}

// The label stands beside the point where hand and wall touch, inside the hand.
std::string at_contact(const char* script) {
  std::string all =
      "const label = document.querySelector('.contact-label').getBoundingClientRect();"
      "const [x, y] = [label.left - 16, label.top + 12];";
  return all.append(script);
}

TEST_F(CheckedPageTest, TellsWhatIsUnderThePointerAndShowsALinkAlone) {
  const Shown shown =
      act(at_contact(
              "on('pointermove', x, y); const told = () => document.documentElement.dataset.links ="
              " (document.documentElement.dataset.links || '') +"
              " document.querySelectorAll('.link input:checked').length;"

              "click(x, y); told(); click(x, y); told();"),
          "theme=light&contact=1");
  expect_text(shown, "hand · sphere 0 · radius 50 mm");
  expect_text(shown, "data-links=\"11\"");
}

#endif

}  // namespace
}  // namespace spherule
