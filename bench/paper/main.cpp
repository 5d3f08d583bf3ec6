// SPDX-License-Identifier: BSD-3-Clause
// The table and the figures of the paper, made again. See bench/README.md.
#include "base/error.h"
#include "bench/paper/pictures.h"
#include "bench/paper/report.h"
#include "bench/studies/fit_parts.h"
#include "tests/support/program.h"

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// Our own and, where SPHERULE_MODELS says where they are, real ones.
std::vector<NamedMesh> all_parts() {
  std::vector<NamedMesh> parts = own_parts();
  if (const auto models = models_folder()) {
    for (NamedMesh& part : real_parts(*models)) parts.push_back(std::move(part));
  }
  return parts;
}

std::vector<CountRow> count_all(const std::vector<NamedMesh>& parts) {
  std::vector<CountRow> rows;
  for (const NamedMesh& part : parts) {
    std::printf("  %s, %zu triangles\n", part.name.c_str(), part.mesh.triangles.size());
    rows.push_back(compare_counts(part, &print_count));
  }
  return rows;
}

std::filesystem::path parse(int count, char** values) {
  std::filesystem::path out = "bench/out";
  for (int i = 1; i < count; ++i) {
    const std::string option = values[i];
    if (option != "--out" || i + 1 == count) {
      throw Error(option, "unknown option, or its value is lacking (see bench/run --help)");
    }
    out = values[++i];
  }
  return out;
}

void say(const char* what) {
  std::printf("paper: %s\n", what);
  std::fflush(stdout);
}

int run(const std::filesystem::path& out) {
  std::filesystem::create_directories(out);
  // First of all, since some may be unreadable.
  const std::vector<NamedMesh> parts = all_parts();
  PaperResults results;
  say("figure 2");
  results.figure_2 = figure_2();
  print_figure_2(results.figure_2);
  say("figure 3");
  results.figure_3 = figure_3();
  say("figures 6 to 8");
  results.courses.push_back(bounding_course());
  results.courses.push_back(packing_course());
  say("holes, thin plates, a cube");
  results.claims = study_claims();
  print_claims(results.claims);
  say("trees");
  results.trees = study_trees();
  print_trees(results.trees);
  say("spheres at equal protrusion");
  results.counts = count_all(parts);
  print_counts(results.counts);
  say("fitting the work cell");
  Workload workload = make_paper_cell();
  fit_parts(workload, &print_fit);
  write_pictures(workload, results, out);
  say("table I");
  results.table1 = make_table1(workload, make_representations(workload), {});
  print_table1(results.table1);
  write_paper(results, out);
  for (const Table1Row& row : results.table1) {
    if (row.is_conservative && row.whole.count.missed > 0) {
      throw Error(row.method, std::to_string(row.whole.count.missed) + " collisions missed");
    }
  }
  return 0;
}

}  // namespace
}  // namespace spherule

int main(int count, char** values) {
  return spherule::run_program("spherule_paper",
                               [&] { return spherule::run(spherule::parse(count, values)); });
}
