// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/structure/repository.h"
#include "tests/structure/source_names.h"

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace spherule {

struct Source {
  SourceNames names;
  std::vector<Include> includes;
};

// By their paths relative to the root.
using Sources = std::map<std::string, Source>;

Sources read_sources(const std::filesystem::path& root, const std::vector<std::string>& files);

// All sources and headers of the project below `root`.
Sources all_sources(const std::filesystem::path& root);

// A source and those that it includes, directly or not, as far as they are among the sources.
std::set<const Source*> with_included(const Sources& sources, const std::string& file);

}  // namespace spherule
