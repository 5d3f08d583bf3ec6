// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Forward kinematics of a URDF file that share nothing with the library: the XML is read here, the
// poses are KDL's.

#include <Eigen/Geometry>
#include <kdl/tree.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace spherule::test {

class KdlRobot {
 public:
  explicit KdlRobot(const std::filesystem::path& urdf);

  const std::vector<std::string>& links() const { return links_; }
  // Joints that move and mimic no other, in the order of the file.
  const std::vector<std::string>& variables() const { return variables_; }

  // The pose of every link, seen from the root, for positions by the names of variables().
  std::map<std::string, Eigen::Isometry3d> poses(
      const std::map<std::string, double>& positions) const;

 private:
  struct Mimic {
    std::string joint;
    double multiplier = 1.0;
    double offset = 0.0;
  };
  double position(const std::string& joint, const std::map<std::string, double>& positions) const;

  KDL::Tree tree_;
  std::vector<std::string> links_;
  std::vector<std::string> variables_;
  std::map<std::string, Mimic> mimics_;
};

}  // namespace spherule::test
