// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/files/random_urdf.h"

#include <cstdio>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string vector(Random& random, double size) {
  const char* const gap = random.index(4) == 0 ? " \n\t " : " ";
  return number(random.between(-size, size)) + gap + number(random.between(-size, size)) + gap +
         number(random.between(-size, size));
}

std::string origin(Random& random) {
  switch (random.index(4)) {
    case 0:
      return {};
    case 1:
      return "<origin xyz='" + vector(random, 1.0) + "'/>";
    case 2:
      return "<origin rpy='" + vector(random, 4.0) + "'/>";
    default:
      return "<origin rpy='" + vector(random, 4.0) + "' xyz='" + vector(random, 1.0) + "'/>";
  }
}

std::string shape(Random& random) {
  switch (random.index(3)) {
    case 0:
      return "<box size='1 2 .5e0'/>";
    case 1:
      return "<sphere radius='+0.25'/>";
    default:
      return "<cylinder length='1' radius=' 3 '/>";
  }
}

std::string link(Random& random, int index) {
  std::string text = "<link name='link &amp; " + std::to_string(index) + "'>";
  for (std::size_t i = random.index(3); i > 0; --i) {
    const std::string tag = random.index(2) == 0 ? "visual" : "collision";
    text += "<" + tag + ">" + origin(random) + "<geometry>" + shape(random) + "</geometry></" +
            tag + ">";
  }
  return text + "</link>\n";
}

// Moving joints follow those before them in `rank`.
std::string joint(Random& random, int index, const std::vector<int>& rank,
                  const std::vector<bool>& moves) {
  const auto at = static_cast<std::size_t>(index);
  const int parent = static_cast<int>(random.index(at + 1));
  const char* type = "fixed";
  if (moves[at]) {
    const char* const types[] = {"revolute", "continuous", "prismatic"};
    type = types[random.index(3)];
  }
  std::string text = "<joint type='" + std::string(type) + "' name='joint %s " +
                     std::to_string(index) + "'>" + origin(random);
  text += "<child link='link &amp; " + std::to_string(index + 1) + "'/>";
  if (random.index(5) > 0) text += "<axis xyz='" + vector(random, 2.0) + "'/>";
  text += "<parent link='link &amp; " + std::to_string(parent) + "'/>";
  text += "<limit lower='-2' upper='3' effort='1' velocity='1'/>";
  std::vector<int> leaders;
  for (std::size_t i = 0; i < rank.size(); ++i) {
    if (moves[i] && rank[i] < rank[at]) leaders.push_back(static_cast<int>(i));
  }
  if (!leaders.empty() && random.index(2) == 0) {
    text += "<mimic joint='joint %s " + std::to_string(leaders[random.index(leaders.size())]) + "'";
    if (random.index(3) > 0) text += " multiplier='" + number(random.between(-2.0, 2.0)) + "'";
    if (random.index(3) > 0) text += " offset='" + number(random.between(-1.0, 1.0)) + "'";
    text += "/>";
  }
  return text + "</joint>\n";
}

template <class Element>
void shuffle(std::vector<Element>& elements, Random& random) {
  for (std::size_t i = elements.size(); i > 1; --i) {
    std::swap(elements[i - 1], elements[random.index(i)]);
  }
}

}  // namespace

std::string random_urdf(Random& random, int joints) {
  std::vector<int> rank;
  std::vector<bool> moves;
  for (int i = 0; i < joints; ++i) {
    rank.push_back(i);
    moves.push_back(random.index(4) > 0);
  }
  shuffle(rank, random);
  std::vector<std::string> elements = {link(random, 0)};
  for (int i = 0; i < joints; ++i) {
    elements.push_back(link(random, i + 1));
    elements.push_back(joint(random, i, rank, moves));
  }
  shuffle(elements, random);
  std::string text = "<?xml version='1.0'?>\n<!-- random -->\n<robot name='random'>\n";
  for (const std::string& element : elements) text += element;
  return text + "</robot>\n";
}

}  // namespace spherule::test
