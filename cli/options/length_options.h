// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/length_unit.h"

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace spherule {

// The unit of what a command writes, and of lengths that are written without one. `file` is named
// where a length has a unit and this one is not known.
struct LengthContext {
  std::string file;
  std::optional<double> micrometres;
};

// Robots are in metres.
LengthContext metres();

// The length in units of the context. Throws Error, naming the option, for one with a unit where
// that of the context is not known.
double converted(const Length& length, const std::string& option, const LengthContext& context);

// What is wrong with the text of a length that must not be negative, or nothing; also for 0.
std::string check_length(const std::string& text);
std::string check_positive_length(const std::string& text);

// The options of a command that are lengths: numbers, or numbers with a unit behind (1mm, 0.5in).
// The numbers go to their place as they are read, those with a unit when convert() is called, once
// the unit of the model is known. The places must live as long as this.
class LengthOptions {
 public:
  // Refuses what is negative or not finite. The help says LENGTH.
  CLI::Option* add(CLI::App& command, const std::string& names, double& length,
                   const std::string& help);
  CLI::Option* add(CLI::App& command, const std::string& names, std::optional<double>& length,
                   const std::string& help);
  // Refuses 0, too.
  CLI::Option* add_positive(CLI::App& command, const std::string& names, double& length,
                            const std::string& help);
  CLI::Option* add_positive(CLI::App& command, const std::string& names,
                            std::optional<double>& length, const std::string& help);

  // Throws Error as converted() does.
  void convert(const LengthContext& context) const;

 private:
  struct Pending {
    std::string option;
    Length length;
    std::function<void(double)> set;
  };

  CLI::Option* add(CLI::App& command, const std::string& names, const std::string& help,
                   std::function<void(double)> set);

  std::vector<Pending> pending_;
};

// Lengths with commas between them. Throws Error, naming the option, also for what is no length.
std::vector<double> lengths_in(const std::string& text, const std::string& option,
                               const LengthContext& context);

}  // namespace spherule
