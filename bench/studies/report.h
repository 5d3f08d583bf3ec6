// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/studies/study.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace spherule {

void print_tables(const Studies& studies);

// What stands under "studies" in results.json.
nlohmann::ordered_json to_json(const Studies& studies);

// Columns for bench/plots/studies.gp: FOLDER/NAME-{sizes,small,distances}.dat. Throws Error.
void write_plot_data(const Studies& studies, const std::string& name,
                     const std::filesystem::path& folder);

}  // namespace spherule
