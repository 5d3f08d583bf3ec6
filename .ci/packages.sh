# SPDX-License-Identifier: BSD-3-Clause
# For scripts to source: the Debian packages that parts of the project need (functions that add to
# `packages`), and the generator of their builds.

packages=()

# Compiler and build tools, as far as there are none.
need_build_tools() {
  command -v cmake >/dev/null || packages+=(cmake)
  command -v "${CXX:-c++}" >/dev/null || packages+=(g++)
  command -v ninja >/dev/null || command -v make >/dev/null || packages+=(ninja-build)
}

# Libraries without the adapters and without CAD files.
need_libraries() {
  packages+=(libeigen3-dev zlib1g-dev libtbb-dev nlohmann-json3-dev libtinyxml2-dev
    libyaml-cpp-dev)
}

# The command, which draws with three.js. STEP and IGES are read by OpenCASCADE.
need_command() {
  need_libraries
  packages+=(libcli11-dev libjs-three)
}
need_cad() {
  packages+=(libocct-data-exchange-dev libocct-modeling-algorithms-dev)
}

# OMPL's CMake package names three libraries of Boost that its Debian package does not depend on.
need_adapters() {
  packages+=(libfcl-dev libccd-dev libompl-dev libboost-filesystem-dev libboost-serialization-dev
    libboost-system-dev)
}

# Assimp, KDL and urdfdom are oracles.
need_tests() {
  packages+=(libassimp-dev libgtest-dev libboost-dev libgmp-dev libmpfr-dev liborocos-kdl-dev
    liburdfdom-dev)
}

# The sanitized build is clang's.
need_sanitizers() {
  packages+=(clang libclang-rt-14-dev)
}

# The Python module, of the distribution's own Python.
need_python() {
  packages+=(python3-dev python3-numpy pybind11-dev)
}

# An example runs on several processes.
need_mpi() {
  packages+=(mpi-default-dev)
}

# Dask is what studies run on beside threads; matplotlib draws in an example.
need_python_tests() {
  need_python
  packages+=(python3-pytest mypy python3-distributed python3-matplotlib)
}

# The first table of bench/run: the engines that spherule is compared with.
need_bench_table() {
  need_libraries
  packages+=(libfcl-dev libccd-dev libbullet-dev)
}

# All of bench/. Boost is for OpenVDB's headers.
need_benchmarks() {
  need_bench_table
  need_command
  need_adapters
  packages+=(libbenchmark-dev libbullet-extras-dev libmeshoptimizer-dev libopenvdb-dev libboost-dev
    libqhull-dev)
}

# Selects Ninja for CMake, if it is installed; CMake reads the variable only when a build folder is made.
use_ninja() {
  if command -v ninja >/dev/null; then export CMAKE_GENERATOR=Ninja; fi
}
