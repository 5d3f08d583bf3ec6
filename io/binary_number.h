// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Numbers in binary mesh files.

#include "base/bytes.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace spherule::internal {

// In the order of glTF's component types, which count from 5120 and have no kInt32 and kDouble.
enum class NumberType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

inline std::size_t size_of(NumberType type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

template <class T>
double number_as(const char* bytes, std::endian order) {
  return number_at<T>(bytes, order);
}

inline double number_at(const char* bytes, NumberType type, std::endian order) {
  constexpr std::array kReaders = {number_as<std::int8_t>,  number_as<std::uint8_t>,
                                   number_as<std::int16_t>, number_as<std::uint16_t>,
                                   number_as<std::int32_t>, number_as<std::uint32_t>,
                                   number_as<float>,        number_as<double>};
  return kReaders[static_cast<std::size_t>(type)](bytes, order);
}

}  // namespace spherule::internal
