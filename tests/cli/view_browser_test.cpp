// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/cli/robot_fixtures.h"
#include "tests/support/effort.h"

#include <cstdlib>

namespace spherule {
namespace {

// The page as a browser shows it: opened from its file, without a network.

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

// For the page frames are 16 ms apart, however long the browser takes, and its picture can be read.
constexpr const char* kBefore = R"(<script>
  let frame_time = performance.now();
  window.requestAnimationFrame = (call) => setTimeout(() => call(frame_time += 16), 16);
  const get_context = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function(type, options) {
    return get_context.call(this, type, {...options, preserveDrawingBuffer: true});
  };
</script>)";

// What scripts of the tests call, once the page has drawn itself.
constexpr const char* kHelpers = R"(
  const on = (type, x, y) => document.getElementById('canvas').dispatchEvent(new PointerEvent(
      type, {clientX: x, clientY: y, bubbles: true, pointerId: 1}));
  const click = (x, y) => { on('pointerdown', x, y); on('pointerup', x, y); };
  const told = document.documentElement.dataset;
  const copy = document.createElement('canvas');
  Object.assign(copy, {width: innerWidth, height: innerHeight});
  // Pixels right of the panel, where the scene is, or in some columns of it.
  const count = (is_wanted, from = 340, to = innerWidth) => {
    const paint = copy.getContext('2d');
    paint.drawImage(document.getElementById('canvas'), 0, 0);
    const {data} = paint.getImageData(from, 0, to - from, innerHeight);
    let number = 0;
    for (let i = 0; i < data.length; i += 4) number += is_wanted(...data.subarray(i, i + 3)) ? 1 : 0;
    return number;
  };
  const is_red = (r, g, b) => r > 120 && r > 2 * g && r > 2 * b;
  const is_blue = (r, g, b) => b > r + 25 && b > g + 10;
  const is = (...wanted) => (...pixel) => pixel.every((value, k) => value === wanted[k]);
)";

class ViewBrowserTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    if (test::kSanitized) GTEST_SKIP() << "what runs in the browser is none of our binaries";
    browser_ = browser();
    if (browser_.empty()) GTEST_SKIP() << "no chromium to open the page with";
  }

  // What stands in the page once it has drawn itself and run a script; `state` is what is behind #
  // in its address. Compositing on an emulated graphics processor would take half the time of a
  // start.
  std::string show(const std::string& state, const std::string& script = "") {
    std::string page = read("page.html");
    page.insert(page.rfind("</body>"),
                "<script>setTimeout(() => {" + (kHelpers + script) + "}, 500);</script>");
    page.insert(page.find("<script"), kBefore);
    write("shown.html", page);
    const Outcome run = type(
        "timeout 120 " + browser_ +
        " --headless --no-sandbox --use-gl=angle --use-angle=swiftshader"
        " --enable-unsafe-swiftshader --hide-scrollbars --no-first-run"
        " --host-resolver-rules='MAP * ~NOTFOUND' --user-data-dir=\"$HOME/.profile\""
        " --window-size=900,600 --virtual-time-budget=3000 --dump-dom --disable-gpu-compositing"
        " \"file://$HOME/shown.html#" +
        state + "\"");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string dom = without_scripts(run.out);
    EXPECT_TRUE(has(dom, "data-drawn=")) << run.err;
    EXPECT_FALSE(has(dom, "data-failure="));
    return dom;
  }

  // A number that a script has told.
  static double told(const std::string& dom, const std::string& name) {
    const std::string mark = "data-" + name + "=\"";
    const std::size_t place = dom.find(mark);
    EXPECT_NE(place, std::string::npos) << name;
    return place == std::string::npos ? -1.0 : std::atof(dom.c_str() + place + mark.size());
  }

  static void expect_texts(const std::string& dom, const std::vector<std::string>& texts) {
    for (const std::string& text : texts) EXPECT_TRUE(has(dom, text));
  }

  std::string browser_;
};

TEST_F(ViewBrowserTest, LeakingPartByDay) {
  write_box("box.stl", {4, 2, 1});
  write_spheres("two.json", {{1, 1, 0.5, 1.2}, {2, 1, 0.5, 1.2}});
  expect_exit(0, "view box.stl two.json --leaks -o page.html");
  const std::string dom =
      show("theme=light",
           "Object.assign(told, {ground: count(is(0xf3, 0xf5, 0xf8), 890), red: count(is_red),"
           " blue: count(is_blue)});");
  EXPECT_EQ(told(dom, "ground"), 10 * 600);
  // Marks lie on the end of the box that sticks out.
  EXPECT_GT(told(dom, "red"), 500);
  EXPECT_GT(told(dom, "blue"), 5000);
  expect_texts(dom, {"12 triangles", "2 spheres", "leaks: two.json", "deepest leak",
                     "found by samples", ">4 × 2 × 1<"});
}

// A set that covers beside one that leaves the end of the box; what is pressed is a cut across x.
TEST_F(ViewBrowserTest, TwoSetsSideBySide) {
  write_box("box.stl", {4, 2, 1});
  write_spheres("all.json", {{2, 1, 0.5, 2.4}});
  write_spheres("some.json", {{1, 1, 0.5, 1.6}, {2, 1, 0.5, 1.6}});
  expect_exit(0, "view box.stl all.json some.json --leaks -o page.html");
  const std::string dom =
      show("theme=light",
           "Object.assign(told, {left: count(is_red, 340, 560), right: count(is_red, 620),"
           " blue: count(is_blue, 340, 620), scale: "
           "document.getElementById('leak-scale').offsetWidth});");
  expect_texts(dom, {"aria-pressed=\"true\" title=\"Sets of spheres side by side", "no leak found",
                     "<span>1 sphere</span>", "<span>2 spheres</span>"});
  EXPECT_EQ(told(dom, "left"), 0);
  EXPECT_GT(told(dom, "right"), 100);
  EXPECT_GT(told(dom, "blue"), 3000);
  EXPECT_GT(told(dom, "scale"), 0);
  // The deepest leak is the end at x = 4, which the home view sees; 2 is the middle.
  const std::string cut = show("theme=light&side=off",
                               "document.querySelectorAll('#cut button')[1].click(); told.cut ="
                               " document.querySelector('#cut output').textContent;");
  EXPECT_NEAR(told(cut, "cut"), 4.0, 0.5);
  EXPECT_FALSE(has(cut, "class=\"pane-title\""));
}

TEST_F(ViewBrowserTest, CutByNight) {
  write_box("box.stl", {4, 2, 1});
  write_spheres("one.json", {{2, 1, 0.5, 2.4}});
  expect_exit(0, "tree one.json -o one.tree");
  expect_exit(0, "view box.stl one.tree -o page.html");
  // Cut in the middle, seen from where the normal points: a disc with the outline of the box on it.
  const std::string dom =
      show("theme=dark&cut=-y:0.5",
           "Object.assign(told, {ground: count(is(0x12, 0x15, 0x1a), 890), blue: count(is_blue),"
           " outline: count(is(0xf4, 0xf6, 0xfa))});");
  EXPECT_EQ(told(dom, "ground"), 10 * 600);
  EXPECT_GT(told(dom, "outline"), 300);
  EXPECT_GT(told(dom, "blue"), 20000);
}

#ifdef SPHERULE_HAS_ROBOT
TEST_F(ViewBrowserTest, Robot) {
  write("arm.urdf",
        sliding("arm", box("collision", "0.4 0.4 0.2"), box("collision", "0.8 0.1 0.1")));
  write("arm.yml",
        "collision_spheres:\n  base:\n  - center: [0, 0, 0]\n    radius: 0.31\n"
        "  hand:\n  - center: [0, 0, 0]\n    radius: 0.2\n");
  expect_exit(0, "view arm.urdf arm.yml --leaks -o page.html");
  const std::string dom =
      show("theme=light", "Object.assign(told, {red: count(is_red), blue: count(is_blue)});");
  EXPECT_GT(told(dom, "blue"), 3000);
  EXPECT_GT(told(dom, "red"), 60);
  expect_texts(dom, {">arm<", "2 links, 1 joint", "joint slide", ">0 mm<", "collision geometry",
                     "2 spheres", ">hand<", "No two links overlap by their spheres."});
}

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
};

TEST_F(CheckedPageTest, ShowsWhatTouchesAndHowFarTheRestIs) {
  const std::string contact = show("theme=light&contact=1", "told.red = count(is_red);");
  expect_texts(contact, {"hand – wall 20.5 mm", "Contacts, line 2",
                         "collision: 3 configurations, 1 with contacts"});
  EXPECT_GT(told(contact, "red"), 100);
  const std::string free = show("theme=light&at=2");
  EXPECT_FALSE(has(free, "hand – wall 20.5 mm"));
  EXPECT_FALSE(has(free, "proved free of each other"));
  expect_texts(free, {"clearance ≥ 949 mm in line 3, hand – wall", "class=\"verdict f\">free<",
                      "curve: how far the spheres are apart at least, to 9"});
  // Halfway between two lines: there the joint is, too.
  expect_texts(show("theme=light&at=1.5"), {"line 2 → 3, 50 %", ">515 mm<"});
}

TEST_F(CheckedPageTest, TheSpaceKeyPlays) {
  const std::string dom = show("theme=light",
                               "const key = () => document.body.dispatchEvent("
                               "new KeyboardEvent('keydown', {key: ' ', bubbles: true}));"
                               "key(); setTimeout(() => { key(); told.played = "
                               "document.getElementById('place').textContent; },"
                               " 600);");
  expect_texts(dom, {"data-played=\"line 1 → 2, ", "aria-label=\"Play\""});
}

// The label stands beside the point where hand and wall touch, inside the hand.
TEST_F(CheckedPageTest, TellsWhatIsUnderThePointerAndShowsALinkAlone) {
  const std::string dom =
      show("theme=light&contact=1",
           "const label = document.querySelector('.contact-label').getBoundingClientRect();"
           "const [x, y] = [label.left - 16, label.top + 12];"
           "on('pointermove', x, y); told.links = ''; for (const _ of [1, 2]) { click(x, y);"
           " told.links += document.querySelectorAll('.link input:checked').length; }");
  expect_texts(dom, {"hand · sphere 0 · radius 50 mm", "data-links=\"11\""});
}
#endif

}  // namespace
}  // namespace spherule
