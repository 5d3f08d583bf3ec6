// SPDX-License-Identifier: BSD-3-Clause
// `fit --method` with the stage 2 methods of the library of baselines.
#include "tests/cli/command_test_support.h"
#include "tests/support/effort.h"

namespace spherule {
namespace {

using Stage2MethodTest = CommandTest;

TEST_F(Stage2MethodTest, FitsAndAnAuditProvesTheFile) {
  write_box("box.stl", {1, 2, 3});
  const double error = test::kSanitized ? 0.5 : 0.3;
  for (const char* method : test::effort(std::vector{"medial", "packing"}, 1)) {
    SCOPED_TRACE(method);
    const Outcome fit =
        run({"fit", "box.stl", "-o", "box.json", "--max-error", std::to_string(error), "--method",
             method, "--report", "report.json", "--tree", "box.tree"});
    EXPECT_EQ(fit.exit_code, 0) << fit.err;
    const nlohmann::json file = read_json("box.json");
    EXPECT_EQ(file["options"]["method"], method);
    EXPECT_TRUE(file["certificate"]["covered"]);
    EXPECT_LE(file["certificate"]["protrusion_over_simplified_max"], error);
    const nlohmann::json report = read_json("report.json");
    EXPECT_EQ(report["cover"]["spheres_before_inflation"].size(), file["spheres"].size());
    EXPECT_EQ(run({"audit", "box.stl", "box.json"}).exit_code, 0);
    EXPECT_EQ(run({"audit", "box.stl", "box.json", "--repair", "mended.json"}).exit_code, 0);
    EXPECT_EQ(read_json("mended.json")["options"]["method"], method);
  }
}

TEST_F(Stage2MethodTest, ZonesOfAnErrorOfTheirOwnAreRefused) {
  write_box("box.stl", {1, 1, 1});
  write(
      "zones.json",
      R"({"format":"spherule-zones","version":1,"zones":[{"shape":"ball","center":[0,0,0],"radius":0.5,"max_error":0.05}]})");
  for (const char* method : {"medial", "packing"}) {
    const Outcome fit = run({"fit", "box.stl", "-o", "out.json", "--max-error", "0.3", "--zones",
                             "zones.json", "--method", method});
    EXPECT_EQ(fit.exit_code, 2);
    EXPECT_NE(fit.err.find(std::string("\"") + method + "\" knows one max error only"),
              std::string::npos)
        << fit.err;
  }
  EXPECT_FALSE(exists("out.json"));
}

}  // namespace
}  // namespace spherule
