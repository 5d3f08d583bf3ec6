// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What objects are whose content was moved to others: a query of one says so, instead of reading
// what is not there.
//
// @code{.cpp}
// #include <spherule/base/moved_from.h>
// #include <cassert>
//
// spherule::internal::SharedContent<int> a(std::make_shared<const int>(7));
// const auto b = std::move(a);
// assert(*a == 7 && *b == 7);
// @endcode

#include <memory>
#include <utility>

namespace spherule::internal {

// Throws Error that names the type. Out of a query that cannot throw (noexcept) this ends the
// program, with that message.
[[noreturn]] void fail_moved_from(const char* type);

inline void require_content(bool is_there, const char* type) {
  if (!is_there) [[unlikely]]
    fail_moved_from(type);
}

// Shared content that is always there: an object that this one is moved from keeps its share.
template <class Content>
class SharedContent {
 public:
  // `content` is not null.
  explicit SharedContent(std::shared_ptr<const Content> content) : content_(std::move(content)) {}
  SharedContent(const SharedContent&) = default;
  SharedContent& operator=(const SharedContent&) = default;

  const Content& operator*() const { return *content_; }
  const Content* operator->() const { return content_.get(); }
  const std::shared_ptr<const Content>& pointer() const { return content_; }

 private:
  std::shared_ptr<const Content> content_;
};

}  // namespace spherule::internal
