// SPDX-License-Identifier: BSD-3-Clause
#include "cli/modules/module.h"

#include "base/error.h"

#include <dlfcn.h>

namespace spherule {
namespace {

std::string last_error() {
  const char* message = ::dlerror();
  return message == nullptr ? "reason unknown" : message;
}

const void* load(const char* name) {
  const std::filesystem::path file = module_path(name);
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) throw Error(file.string(), "cannot be loaded: " + last_error());
  const void* functions = ::dlsym(module, "spherule_module");
  if (functions == nullptr) throw Error(file.string(), "is no part of spherule: " + last_error());
  return functions;
}

}  // namespace

std::filesystem::path module_path(const std::string& name) {
  const std::filesystem::path command = std::filesystem::read_symlink("/proc/self/exe");
  return (command.parent_path() / SPHERULE_MODULE_FOLDER / name).lexically_normal();
}

const LevelSetModule& level_set_module() {
  static const void* functions = load("spherule_level_set.so");
  return *static_cast<const LevelSetModule*>(functions);
}

}  // namespace spherule
