// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace spherule {

enum class FileKind {
  kMesh,
  kCad,
  kSpheres,       // of one mesh (SPHERES.json)
  kTree,          //
  kUrdf,          // with or without spheres
  kSrdf,          //
  kRobotSpheres,  // any format of several links, but URDF and SRDF
  kPairs,         // of links
  kScene,         //
  kZones,         // of `fit`
  kTable,         // of numbers: a trajectory, or a cloud of points
  kReport,        // of `fit` or `robot`, or what `audit --json` printed
  kPage,          // of `view`
  kUnknown,
};

// What a file is, by its content; meshes also by the ending of their name. Nothing is checked but
// what tells the kinds apart. Throws Error if the file cannot be read.
FileKind recognize(const std::filesystem::path& path);

// The ending of a file's name, ".stl" say, in small letters.
std::string lower_ending(const std::filesystem::path& path);
// Whether the name ends as those of mesh files do.
bool has_mesh_ending(const std::filesystem::path& path);

// What a file of this kind is and which command takes it, for a message: "a sphere tree (spherule
// collide FILE OTHER.tree checks it)". Empty if it is not known.
std::string offer_for(FileKind kind, const std::string& file);

// Of a command that failed with `message`: what the first file is that the message names and that
// is of a kind which the command does not take in its place, and which command takes it, as the end
// of the message; or nothing. Does not throw for files that cannot be read.
std::string wrong_file_hint(const CLI::App& app, const std::string& message);

// Whether the subject of an error is a file or an option, so that a person knows where to look.
bool names_its_place(const Error& error);

// What `action` returns. An exception of the type, for which `is_of_file` holds, becomes an Error
// that has the file it comes from in front.
template <class Exception = Error, class IsOfFile, class Action>
auto blame_file_if(IsOfFile is_of_file, const std::string& file, Action action) {
  try {
    return action();
  } catch (const Exception& error) {
    if (!is_of_file(error)) throw;
    if constexpr (std::is_same_v<Exception, Error>) {
      throw Error(file, error.subject() + ": " + error.reason());  // what() ends at a zero byte
    }
    throw Error(file, error.what());
  }
}

// For what depends on nothing but the file.
template <class Exception = Error, class Action>
auto blame_file(const std::string& file, Action action) {
  return blame_file_if<Exception>([](const Exception&) { return true; }, file, std::move(action));
}

// For a file that an option names, if there is one: for errors whose subject begins like this.
template <class Action>
auto blame_named_file(const std::string& file, std::string_view subject, Action action) {
  return blame_file_if(
      [&](const Error& error) { return !file.empty() && error.subject().starts_with(subject); },
      file, std::move(action));
}

// For errors that do not name their place, but a link, say.
template <class Action>
auto in_file(const std::string& file, Action action) {
  return blame_file_if([](const Error& error) { return !names_its_place(error); }, file,
                       std::move(action));
}

// Throws Error, before long work is done for nothing, if a file of `outputs` cannot be made where
// it is requested, is one of `inputs`, or is named twice. Empty paths are files not requested.
void check_outputs(const std::vector<std::filesystem::path>& outputs,
                   const std::vector<std::filesystem::path>& inputs);

// Where a command puts what it makes of `input` if no place is named: in the folder in which it
// runs, under the input's name with another ending, ".json" say. Throws Error if a file of that
// name is there that is of another kind than the command makes.
std::string default_output(const std::filesystem::path& input, const char* ending, FileKind kind);

}  // namespace spherule
