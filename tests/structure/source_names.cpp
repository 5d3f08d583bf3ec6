// SPDX-License-Identifier: BSD-3-Clause
#include "tests/structure/source_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <iterator>
#include <vector>

namespace spherule {
namespace {

struct Token {
  std::string_view text;
  bool follows_space;
  bool is_on_unindented_line;
};

bool is_word_part(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

template <std::size_t N>
bool is_one_of(std::string_view word, const std::array<std::string_view, N>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Splits a source into names, numbers and signs; leaves out comments, texts and the lines of the
// preprocessor.
class Tokenizer {
 public:
  explicit Tokenizer(std::string_view text) : text_(text) {}

  std::vector<Token> run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      const std::string_view rest = text_.substr(at_);
      if (c == '\n') line_ = at_ + 1;
      if (std::isspace(static_cast<unsigned char>(c))) {
        ++at_;
      } else if (c == '#') {
        skip_directive();
      } else if (rest.starts_with("//")) {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (rest.starts_with("/*")) {
        skip_past("*/", at_ + 2);
      } else if (rest.starts_with("R\"")) {
        const std::size_t open = text_.find('(', at_);
        skip_past(")" + std::string(text_.substr(at_ + 2, open - at_ - 2)) + "\"", open);
      } else if (c == '"' || c == '\'') {
        skip_quoted(c);
      } else {
        take(length_of(rest));
      }
    }
    return tokens_;
  }

 private:
  static std::size_t length_of(std::string_view rest) {
    for (const std::string_view sign : {"::", "->", "..."}) {
      if (rest.starts_with(sign)) return sign.size();
    }
    if (!is_word_part(rest.front())) return 1;
    const bool is_number = std::isdigit(static_cast<unsigned char>(rest.front())) != 0;
    const auto ends = [&](char c) {
      return !is_word_part(c) && !(is_number && (c == '.' || c == '\''));
    };
    return static_cast<std::size_t>(std::find_if(rest.begin(), rest.end(), ends) - rest.begin());
  }

  void take(std::size_t length) {
    const bool spaced = at_ == 0 || std::isspace(static_cast<unsigned char>(text_[at_ - 1]));
    tokens_.push_back({text_.substr(at_, length), spaced, text_[line_] != ' '});
    at_ += length;
  }

  void skip_directive() {
    while (at_ < text_.size() && (text_[at_] != '\n' || text_[at_ - 1] == '\\')) ++at_;
  }

  void skip_past(std::string_view end, std::size_t from) {
    const std::size_t found = text_.find(end, from);
    at_ = found == text_.npos ? text_.size() : found + end.size();
  }

  void skip_quoted(char quote) {
    for (++at_; at_ < text_.size() && text_[at_] != quote; ++at_) {
      if (text_[at_] == '\\') ++at_;
    }
    ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
  std::vector<Token> tokens_;
};

constexpr std::array<std::string_view, 7> kTypeWords = {"class", "struct",  "enum",    "union",
                                                        "using", "concept", "typename"};
// After these a name is used.
constexpr std::array<std::string_view, 14> kStatementWords = {
    "return", "else", "new", "throw", "case", "goto", "co_return",
    "delete", "do",   "in",  "not",   "and",  "or",   "operator"};
// No names, though they stand where some do.
constexpr std::array<std::string_view, 16> kWords = {
    "alignas", "auto", "bool",     "char",     "class",    "const", "constexpr", "double",
    "float",   "int",  "noexcept", "operator", "requires", "short", "sizeof",    "void"};
// The namespaces of the project through which a name is used as if it stood alone.
constexpr std::array<std::string_view, 3> kNamespaces = {"spherule", "internal", "test"};

bool is_name(std::string_view text) {
  return !text.empty() && is_word_part(text.front()) &&
         !std::isdigit(static_cast<unsigned char>(text.front()));
}

bool is_constant(std::string_view name) {
  return name.size() > 1 && name[0] == 'k' && std::isupper(static_cast<unsigned char>(name[1]));
}

class Reader {
 public:
  explicit Reader(std::string_view text) : tokens_(Tokenizer(text).run()) {}

  SourceNames run() {
    for (at_ = 0; at_ < tokens_.size(); ++at_) {
      const std::string_view name = tokens_[at_].text;
      if (is_name(name) && near(-1) == "::") {
        names_.of_scope[std::string(first_scope())].emplace(name);
      } else if (near(-1) == "." || near(-1) == "->") {
        names_.of_scope["."].emplace(name);
      } else if (near(-1) == "namespace" && near(-2) != "using") {
        names_.namespaces.emplace(name);
      }
      if (!is_name(name) || is_one_of(name, kWords) || is_one_of(name, kNamespaces)) continue;
      if (is_declaration()) {
        names_.declared.emplace(name);
        offer(name);
      } else if (is_use()) {
        names_.used.emplace(name);
        if (near(1) == "(" || near(1) == "<") names_.called.emplace(name);
      }
    }
    return names_;
  }

 private:
  // The token so many places further on, or back; empty beyond the ends.
  std::string_view near(int places) const {
    const auto at = static_cast<std::ptrdiff_t>(at_) + places;
    return at < 0 || at >= std::ssize(tokens_) ? std::string_view()
                                               : tokens_[static_cast<std::size_t>(at)].text;
  }

  bool is_declaration() const {
    const std::string_view before = near(-1), after = near(1);
    if (before == "using") return after == "=";
    if (after == "::") return false;
    if (after == "__attribute__") return true;
    if (is_one_of(before, kTypeWords) || before == "...") return true;
    const bool ends_here =
        after.size() == 1 && std::string_view("(=;,){[:>").find(after) != after.npos;
    if (before == "::") return after == ";" && is_using_declaration();
    if (is_constant(near(0)) && (before == "{" || before == ",") &&
        (after == "," || after == "}" || after == "="))
      return true;
    if ((before == "[" || before == ",") && (after == "," || after == "]")) return true;
    if (!ends_here || !tokens_[at_].follows_space) return false;
    if (is_name(before)) return !is_one_of(before, kStatementWords);
    // `T& name`, unlike `a & name`.
    return (before == ">" || before == "&" || before == "*") && at_ > 0 &&
           !tokens_[at_ - 1].follows_space;
  }

  bool is_using_declaration() const {
    int back = -1;
    while (near(back) == "::" || (is_name(near(back)) && near(back + 1) == "::")) --back;
    return near(back) == "using";
  }

  std::string_view first_scope() const {
    int back = -2;
    while (near(back - 1) == "::") back -= 2;
    return near(back);
  }

  void offer(std::string_view name) {
    if (!tokens_[at_].is_on_unindented_line) return;
    const bool is_parameter = near(-2) == "<" || near(-2) == ",";  // of a template
    if (is_constant(name) || (is_one_of(near(-1), kTypeWords) && near(1) != ";" && !is_parameter)) {
      names_.offered.emplace(name);
    } else if (near(1) == "(") {
      names_.offered_functions.emplace(name);
    }
  }

  bool is_use() const {
    const std::string_view before = near(-1);
    if (before == "." || before == "->" || before == "namespace") return false;
    if (before == "::") return is_one_of(near(-2), kNamespaces);
    // The names of a test; the first of TEST_F is that of a class.
    return near(-2) != "TEST" && !near(-4).starts_with("TEST");
  }

  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  SourceNames names_;
};

}  // namespace

SourceNames names_in(std::string_view text) {
  return Reader(text).run();
}

}  // namespace spherule
