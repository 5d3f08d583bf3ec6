// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/text/json.h"
#include "io/mesh_io.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace spherule {

// For CLI::Option::check: what is wrong with the text of a number that must be finite and not
// negative, or positive, or nothing. A text that is no number is left to the conversion to refuse.
// (The messages of CLI11's own checks hold the largest number there is, of 309 digits.)
std::string check_not_negative(const std::string& text);
std::string check_positive(const std::string& text);

// Adds an option that takes a file, or several; an argument that has to be there.
CLI::Option* add_file(CLI::App& command, const std::string& names, std::string& file,
                      const std::string& help);
CLI::Option* add_file(CLI::App& command, const std::string& names, std::vector<std::string>& files,
                      const std::string& help);
void add_file_argument(CLI::App& command, const std::string& name, std::string& file,
                       const std::string& help);
void add_file_argument(CLI::App& command, const std::string& name, std::vector<std::string>& files,
                       const std::string& help);

// Adds those of the options that were given to a command, as they were, to the words of another.
void repeat(const CLI::App& command, std::initializer_list<const char*> options,
            std::vector<std::string>& words);

// Adds --threads to a command, with what is said of its result.
void add_threads_option(CLI::App& command, int& threads,
                        const std::string& result = "the result is the same");

// How long is searched for fewer spheres, where a command keeps it.
struct SearchOptions {
  std::uint64_t& seed;
  int& effort;
  double& seconds;
  int& threads;
};

// Adds --seed, --effort, --seconds and --threads to a command, with what the second and the third
// mean there. The options have to outlive the command.
void add_search_options(CLI::App& command, const SearchOptions& options,
                        const std::string& effort_means, const std::string& seconds_mean);

// Adds the option --external-spheres, which requires all.
void add_external_spheres_flag(CLI::App& command, ReportContent& content);

// The part of a command's work that one of several processes does: the index-th of `of`, from 1.
struct Shard {
  std::size_t index = 1;
  std::size_t of = 1;
};

// Things in a row, `first` the index of the first one.
struct ShardRange {
  std::size_t first = 0;
  std::size_t count = 0;
};

// Those of a shard of `count` things: shards follow one another, each thing is in one of them, and
// their sizes differ by one at most.
ShardRange range_of(const Shard& shard, std::size_t count);

// Whether a thing is among those that a shard takes where neighbours cost alike: every `of`-th.
bool is_dealt_to(const Shard& shard, std::size_t thing);

// Adds --shard I/N, whose help says what is divided.
CLI::Option* add_shard_option(CLI::App& command, const std::string& help, Shard& shard);

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
  template <class Target>
  CLI::Option* add(CLI::App& command, const std::string& names, Target& length,
                   const std::string& help) {
    return add(command, names, help, check_length, [&length](double value) { length = value; });
  }
  // Refuses 0, too.
  template <class Target>
  CLI::Option* add_positive(CLI::App& command, const std::string& names, Target& length,
                            const std::string& help) {
    return add(command, names, help, check_positive_length,
               [&length](double value) { length = value; });
  }

  // Throws Error as converted() does.
  void convert(const LengthContext& context) const;

 private:
  struct Pending {
    std::string option;
    Length length;
    std::function<void(double)> set;
  };

  CLI::Option* add(CLI::App& command, const std::string& names, const std::string& help,
                   std::string (*fault_of)(const std::string&), std::function<void(double)> set);

  std::vector<Pending> pending_;
};

// Lengths with commas between them. Throws Error, naming the option, also for what is no length.
std::vector<double> lengths_in(const std::string& text, const std::string& option,
                               const LengthContext& context);

}  // namespace spherule
