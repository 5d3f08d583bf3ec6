// SPDX-License-Identifier: BSD-3-Clause
#include "cli/parts/fit_each.h"

#include "base/error.h"
#include "cli/options/shard.h"
#include "cli/text/exit_code.h"
#include "cli/text/message.h"
#include "io/sphere_file.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;

// Where the spheres of each file go, in the order of the files. Throws Error for two of one name.
std::vector<std::string> outputs_of(const FitArguments& arguments) {
  const fs::path folder = arguments.spheres.empty() ? "." : arguments.spheres;
  std::map<std::string, std::string> taken;
  std::vector<std::string> outputs;
  for (const std::string& model : arguments.models) {
    const std::string output = (folder / fs::path(model).stem()).string() + ".json";
    const auto [other, is_new] = taken.emplace(output, model);
    if (!is_new)
      throw Error(model, "its spheres would go to " + output + ", as those of " + other->second);
    outputs.push_back(output);
  }
  return outputs;
}

// Whether there are spheres that are proved to cover, with whatever options they were made, by a
// search that was not interrupted.
bool has_cover(const std::string& file) {
  if (!fs::exists(file)) return false;
  try {
    const SphereFile found = load_spheres(file);
    return found.certificate && found.certificate->covered && !found.interrupted;
  } catch (const Error&) {
    return false;
  }
}

void require_one_file_options(const FitArguments& arguments) {
  const std::pair<const char*, const std::string&> kOptions[] = {
      {"--report", arguments.report}, {"--tree", arguments.tree}, {"--view", arguments.view}};
  for (const auto& [option, value] : kOptions) {
    if (!value.empty()) throw Error(option, "is of one file, not of each (--each)");
  }
}

}  // namespace

int fit_each(FitArguments& arguments, const std::function<int(FitArguments&)>& fit) {
  require_one_file_options(arguments);
  const std::vector<std::string> models = arguments.models;
  const std::vector<std::string> outputs = outputs_of(arguments);
  if (!arguments.spheres.empty()) {
    std::error_code error;
    fs::create_directories(arguments.spheres, error);
    if (error) throw Error(arguments.spheres, "cannot be made: " + error.message());
  }
  int exit_code = kYes;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (!is_dealt_to(arguments.shard, i)) continue;
    if (arguments.skips_existing && has_cover(outputs[i])) {
      std::cout << one_line(outputs[i]) << ": is there\n";
      continue;
    }
    arguments.models = {models[i]};
    arguments.spheres = outputs[i];
    std::cout << one_line(models[i]) << ":\n";
    try {
      exit_code = std::max(exit_code, fit(arguments));
    } catch (const Error& error) {
      tell(error.what());
      exit_code = kBadInput;
    }
  }
  return exit_code;
}

}  // namespace spherule
