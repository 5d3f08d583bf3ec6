// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/files/kdl_robot.h"

#include <cstdlib>
#include <set>
#include <stdexcept>
#include <tinyxml2.h>

namespace spherule::test {
namespace {

using tinyxml2::XMLElement;

std::string value_of(const XMLElement* element, const char* name, const char* otherwise) {
  const char* const value = element ? element->Attribute(name) : nullptr;
  return value ? value : otherwise;
}

KDL::Vector vector_of(const XMLElement* element, const char* name, const char* otherwise) {
  const std::string text = value_of(element, name, otherwise);
  char* at = const_cast<char*>(text.c_str());
  const double x = std::strtod(at, &at);
  const double y = std::strtod(at, &at);
  return {x, y, std::strtod(at, &at)};
}

KDL::Frame frame_of(const XMLElement* origin) {
  const KDL::Vector rpy = vector_of(origin, "rpy", "0 0 0");
  return {KDL::Rotation::RPY(rpy.x(), rpy.y(), rpy.z()), vector_of(origin, "xyz", "0 0 0")};
}

KDL::Joint joint_of(const XMLElement& joint, const KDL::Frame& frame) {
  const std::string name = joint.Attribute("name");
  const std::string type = joint.Attribute("type");
  const KDL::Vector axis = frame.M * vector_of(joint.FirstChildElement("axis"), "xyz", "1 0 0");
  if (type == "revolute" || type == "continuous") return {name, frame.p, axis, KDL::Joint::RotAxis};
  if (type == "prismatic") return {name, frame.p, axis, KDL::Joint::TransAxis};
  return KDL::Joint(name, KDL::Joint::None);
}

}  // namespace

KdlRobot::KdlRobot(const std::filesystem::path& urdf) {
  tinyxml2::XMLDocument document;
  if (document.LoadFile(urdf.c_str()) != tinyxml2::XML_SUCCESS) {
    throw std::runtime_error(urdf.string());
  }
  const XMLElement* const robot = document.RootElement();
  std::vector<const XMLElement*> joints;
  std::set<std::string> below;
  for (const auto* j = robot->FirstChildElement("joint"); j; j = j->NextSiblingElement("joint")) {
    joints.push_back(j);
    below.insert(j->FirstChildElement("child")->Attribute("link"));
  }
  std::string root;
  for (const auto* l = robot->FirstChildElement("link"); l; l = l->NextSiblingElement("link")) {
    links_.push_back(l->Attribute("name"));
    if (!below.contains(links_.back())) root = links_.back();
  }
  KDL::Tree tree(root);
  std::set<std::string> placed = {root};
  while (placed.size() < links_.size()) {
    const std::size_t before = placed.size();
    for (const XMLElement* joint : joints) {
      const std::string parent = joint->FirstChildElement("parent")->Attribute("link");
      const std::string child = joint->FirstChildElement("child")->Attribute("link");
      if (!placed.contains(parent) || placed.contains(child)) continue;
      const KDL::Frame frame = frame_of(joint->FirstChildElement("origin"));
      tree.addSegment(KDL::Segment(child, joint_of(*joint, frame), frame), parent);
      placed.insert(child);
    }
    if (placed.size() == before) throw std::runtime_error("no tree: " + urdf.string());
  }
  for (const XMLElement* joint : joints) {
    const std::string name = joint->Attribute("name");
    if (std::string(joint->Attribute("type")) == "fixed") continue;
    if (const XMLElement* mimic = joint->FirstChildElement("mimic")) {
      mimics_[name] = {mimic->Attribute("joint"), std::stod(value_of(mimic, "multiplier", "1")),
                       std::stod(value_of(mimic, "offset", "0"))};
    } else {
      variables_.push_back(name);
    }
  }
  tree_ = tree;
}

double KdlRobot::position(const std::string& joint,
                          const std::map<std::string, double>& positions) const {
  const auto mimic = mimics_.find(joint);
  if (mimic == mimics_.end()) return positions.at(joint);
  const auto& [other, multiplier, offset] = mimic->second;
  return multiplier * position(other, positions) + offset;
}

std::map<std::string, Eigen::Isometry3d> KdlRobot::poses(
    const std::map<std::string, double>& positions) const {
  std::map<std::string, Eigen::Isometry3d> result;
  for (const std::string& link : links_) {
    KDL::Frame frame = KDL::Frame::Identity();
    for (auto at = tree_.getSegment(link); at != tree_.getRootSegment(); at = at->second.parent) {
      const KDL::Segment& segment = at->second.segment;
      const bool moves = segment.getJoint().getType() != KDL::Joint::None;
      const double value = moves ? position(segment.getJoint().getName(), positions) : 0.0;
      frame = segment.pose(value) * frame;
    }
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (int row = 0; row < 3; ++row) {
      pose.translation()[row] = frame.p[row];
      for (int column = 0; column < 3; ++column) pose.linear()(row, column) = frame.M(row, column);
    }
    result[link] = pose;
  }
  return result;
}

}  // namespace spherule::test
