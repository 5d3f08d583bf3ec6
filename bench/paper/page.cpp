// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/page.h"

#include "base/files.h"
#include "bench/paper/machine.h"
#include "robot/files/xml_file.h"

#include <cstddef>
#include <cstdio>
#include <ostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>The paper's comparisons, made again</title>
<style>
body { font: 16px/1.5 sans-serif; color: #222; max-width: 1100px; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; margin: 1em 0; font-size: 14px }
th, td { padding: .25em .8em; text-align: right; border-bottom: 1px solid #ddd }
th:first-child, td:first-child { text-align: left }
th { border-bottom: 2px solid #888; vertical-align: bottom }
figure { margin: 1.5em 0 } figure img { max-width: 100% } figcaption { color: #555 }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(320px, 1fr)); gap: 1em }
.pictures figure { margin: 0 }
.fewest { font-weight: bold }
</style>
</head>
<body>
<h1>The paper's comparisons, made again</h1>
<p>Larkin, Short, Pan and van Duin, <i>Bounding Sphere CAD Model Simplification for Efficient
Collision Detection in Offline Programming</i>: its table, its figures and what it says without one,
computed anew. In brackets: the paper's own numbers.</p>
)";

std::string number(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

// Cells are text, not markup.
class Table {
 public:
  Table(std::ostream& out, const std::vector<std::string>& head) : out_(out) {
    out_ << "<table>\n";
    write(head, "th");
  }
  ~Table() { out_ << "</table>\n"; }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  void row(const std::vector<std::string>& cells) { write(cells, "td"); }

 private:
  void write(const std::vector<std::string>& cells, const std::string& tag) {
    out_ << "<tr>";
    for (const std::string& cell : cells) {
      out_ << '<' << tag << '>' << internal::xml_escaped(cell) << "</" << tag << '>';
    }
    out_ << "</tr>\n";
  }

  std::ostream& out_;
};

void image(std::ostream& out, const std::string& file, const std::string& caption) {
  out << "<figure><img src=\"" << file << "\" alt=\"" << internal::xml_escaped(caption)
      << "\"><figcaption>" << internal::xml_escaped(caption) << "</figcaption></figure>\n";
}

void write_table1(const std::vector<Table1Row>& rows, std::ostream& out) {
  const std::size_t queries = rows.empty() ? 0 : rows.front().whole.queries;
  out << "<h2>Table I</h2>\n<p>" << queries
      << " configurations of a weld program; missed and extra are against the original solids. Up "
         "to the decomposition FCL queries; then robot and torch are meshes and the pipes are "
         "spheres; "
         "at last all is in spheres. The ratio is of times, to the first row.</p>\n";
  Table table(out, {"method", "complexity", "collisions", "missed", "extra", "ms", "ratio",
                    "at the seams: collisions", "missed", "extra", "ratio"});
  for (const Table1Row& row : rows) {
    const auto with = [&](std::string text, const std::string& papers) {
      return row.paper ? std::move(text) + " (" + papers + ")" : std::move(text);
    };
    const double of_paper =
        row.paper && rows.front().paper ? rows.front().paper->seconds / row.paper->seconds : 0.0;
    table.row(
        {row.method, with(row.complexity, row.paper ? row.paper->complexity : ""),
         with(std::to_string(row.whole.count.collisions),
              row.paper ? std::to_string(row.paper->collisions) : ""),
         std::to_string(row.whole.count.missed), std::to_string(row.whole.count.extra),
         number(1e3 * row.whole.seconds, 2), with(number(row.whole.ratio, 1), number(of_paper, 1)),
         std::to_string(row.critical.count.collisions), std::to_string(row.critical.count.missed),
         std::to_string(row.critical.count.extra), number(row.critical.ratio, 1)});
  }
}

void write_figure_2(const Figure2& figure, std::ostream& out) {
  out << "<h2>Figure 2: a concave part at equal error</h2>\n<p>A block with slots; max error "
      << number(1e3 * figure.max_error, 0) << " mm, minimum external diameter "
      << number(1e3 * figure.min_external_diameter, 0)
      << " mm. The paper: 33 spheres packed, 11 bounding.</p>\n<div class=\"pictures\">\n";
  image(out, "paper-figure2-mesh.png", "the part");
  for (const Figure2::Fit& fit : figure.fits) {
    image(out, "paper-figure2-" + fit.method + ".png",
          fit.method + ": " + std::to_string(fit.spheres.size()) + " spheres, protrusion " +
              number(1e3 * fit.protrusion, 1) + " mm");
  }
  out << "</div>\n";
}

void write_figure_4(const std::vector<FitCourse>& courses, std::ostream& out) {
  out << "<h2>Figures 4, 5 and 9: a pipe in each representation, the robot, the work cell</h2>\n"
         "<div class=\"pictures\">\n";
  image(out, "paper-figure4-mesh.png", "original mesh");
  image(out, "paper-figure4-hull.png", "convex hull");
  image(out, "paper-figure4-voxels.png", "voxels of 5 mm");
  for (const FitCourse& course : courses) {
    image(out, "paper-figure4-" + course.method + ".png",
          course.method + ": " + std::to_string(course.spheres.size()) + " spheres, inflated");
  }
  image(out, "paper-figure5.png", "robot and torch in spheres");
  image(out, "paper-figure9.png", "the work cell");
  image(out, "paper-figure9-spheres.png", "the work cell in spheres");
  out << "</div>\n";
}

void write_claims(const std::vector<ClaimRow>& rows, std::ostream& out) {
  out << "<h2>What the paper says without a figure</h2>\n<p>Spheres with stage 1 and with a size "
         "so "
         "small that nothing vanishes; and how much faster than FCL on the meshes they are queried "
         "with a rod nearby.</p>\n";
  Table table(out,
              {"shape", "holes", "triangles", "with stage 1", "without", "FCL's time over ours"});
  for (const ClaimRow& row : rows) {
    table.row({row.shape, std::to_string(row.holes), std::to_string(row.triangles),
               std::to_string(row.with_stage1), std::to_string(row.without_stage1),
               number(row.ratio, 1)});
  }
}

void write_counts(const std::vector<CountRow>& rows, std::ostream& out) {
  if (rows.empty()) return;
  out << "<h2>Spheres at equal certified protrusion</h2>\n<p>The fewest that provably hold the "
         "part "
         "and protrude from it by at most "
      << number(100.0 * kEqualProtrusion, 0)
      << " % of its diagonal, whatever setting the method needs for that.</p>\n";
  std::vector<std::string> head = {"part", "triangles"};
  for (const CountEntry& entry : rows.front().entries) head.push_back(entry.method);
  Table table(out, head);
  for (const CountRow& row : rows) {
    std::vector<std::string> cells = {row.part, std::to_string(row.triangles)};
    for (const CountEntry& entry : row.entries) {
      cells.push_back(entry.spheres > 0 ? std::to_string(entry.spheres) : "none found");
    }
    table.row(cells);
  }
}

void write_trees(const std::vector<TreeRow>& rows, std::ostream& out) {
  out << "<h2>Trees for the same traversal</h2>\n<p>The pipe, queried with a rod in random places "
         "nearby: the tree as its method has it, and ours over the same leaves.</p>\n";
  Table table(out,
              {"method", "leaves", "nodes", "node tests", "ns", "ours: nodes", "node tests", "ns"});
  for (const TreeRow& row : rows) {
    table.row({row.method, std::to_string(row.leaves), std::to_string(row.own.nodes),
               number(row.own.node_tests, 1), number(row.own.ns, 0), std::to_string(row.ours.nodes),
               number(row.ours.node_tests, 1), number(row.ours.ns, 0)});
  }
}

}  // namespace

void write_page(const PaperResults& results, const std::filesystem::path& folder) {
  std::ostringstream out;
  out << kHead;
  write_table1(results.table1, out);
  write_figure_2(results.figure_2, out);
  out << "<h2>Figure 3</h2>\n";
  image(out, "paper-figure3.svg", "share of the box that external spheres leave, as they grow");
  write_figure_4(results.courses, out);
  out << "<h2>Figures 6 to 8: the pipe as spheres are added</h2>\n";
  image(out, "paper-figure6.svg", "figure 6: max error");
  image(out, "paper-figure7.svg", "figure 7: covered share of the solid");
  image(out, "paper-figure8.svg", "figure 8: volume outside of the solid");
  write_claims(results.claims, out);
  write_counts(results.counts, out);
  write_trees(results.trees, out);
  out << "<h2>Machine and versions</h2>\n";
  {
    Table table(out, {"", ""});
    for (const auto& [name, value] : machine_facts(folder / "packages.txt"))
      table.row({name, value});
  }
  out << "</body>\n</html>\n";
  write_file_atomically(folder / "paper.html", out.str());
}

}  // namespace spherule
