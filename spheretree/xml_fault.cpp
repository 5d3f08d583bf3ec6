// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/text.h"
#include "spheretree/text_fault.h"

#include <algorithm>
#include <initializer_list>
#include <set>
#include <string>
#include <vector>

namespace spherule::internal {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

// g++ 12 warns of sums of literals and temporary strings.
std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text += part;
  return text;
}

struct Fault {
  std::size_t at;
  std::string reason;
};

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  // Throws Fault.
  void run() {
    while (at_ < text_.size()) {
      const std::size_t tag = std::min(text_.find('<', at_), text_.size());
      const std::size_t words = text_.find_first_not_of(kBlanks, at_);
      if (words < tag && open_.empty()) {
        fail(words, has_root_ ? "a text after its end" : "a text where a tag is due");
      }
      at_ = tag;
      if (at_ < text_.size()) markup();
    }
    if (!open_.empty()) {
      fail(at_, joined({"it ends before <", open_.back().name, "> of ",
                        place_in(text_, open_.back().at), " is closed"}));
    }
    if (!has_root_) fail(at_, "nothing is in it");
  }

 private:
  struct Open {
    std::string_view name;
    std::size_t at;
  };

  [[noreturn]] static void fail(std::size_t at, std::string reason) {
    throw Fault{at, std::move(reason)};
  }
  std::string_view rest() const { return text_.substr(at_); }
  char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip_blanks() { at_ = std::min(text_.find_first_not_of(kBlanks, at_), text_.size()); }

  void markup() {
    if (rest().starts_with("<!--")) return skip_past("<!--", "-->", "a comment");
    if (rest().starts_with("<![CDATA[")) return skip_past("<![CDATA[", "]]>", "a CDATA section");
    if (rest().starts_with("<?")) return skip_past("<?", "?>", "a declaration");
    if (rest().starts_with("<!")) {
      const std::string_view first_part = rest().substr(0, rest().find('>'));
      const bool has_list = first_part.find('[') != std::string_view::npos;
      return skip_past("<!", has_list ? "]>" : ">", "a document type");
    }
    rest().starts_with("</") ? closing_tag() : opening_tag();
  }

  void skip_past(std::string_view begin, std::string_view end, const char* what) {
    const std::size_t found = text_.find(end, at_ + begin.size());
    if (found == std::string_view::npos)
      fail(at_, joined({what, " begins here that is not ended"}));
    at_ = found + end.size();
  }

  std::string_view name() {
    const std::size_t start = at_;
    at_ = std::min(text_.find_first_of(" \t\r\n/>=<\"'", at_), text_.size());
    return text_.substr(start, at_ - start);
  }

  void closing_tag() {
    const std::size_t start = at_;
    at_ += 2;
    const std::string tag = joined({"</", name(), ">"});
    skip_blanks();
    if (next() != '>') fail(start, tag.substr(0, tag.size() - 1) + " is not ended by '>'");
    ++at_;
    if (open_.empty()) fail(start, tag + " closes nothing");
    const Open& open = open_.back();
    if (tag != joined({"</", open.name, ">"})) {
      fail(start, joined({tag, " where </", open.name, "> is due",
                          is_on_line_of(open.at, start) ? "" : ", opened in ",
                          is_on_line_of(open.at, start) ? "" : line_of(open.at)}));
    }
    open_.pop_back();
  }

  bool is_on_line_of(std::size_t first, std::size_t second) const {
    return text_.substr(first, second - first).find('\n') == std::string_view::npos;
  }
  std::string line_of(std::size_t at) const {
    const std::string place = place_in(text_, at);
    return place.substr(0, place.find(','));
  }

  void opening_tag() {
    const std::size_t start = at_++;
    const std::string_view tag = name();
    if (tag.empty()) fail(start, "'<' without a name after it (in texts it is written as &lt;)");
    if (open_.empty() && has_root_) fail(start, "a second element after the end of the first");
    has_root_ = true;
    std::set<std::string_view> attributes;
    for (;;) {
      const std::size_t before = at_;
      skip_blanks();
      if (next() == '>' || rest().starts_with("/>")) break;
      if (at_ >= text_.size() || next() == '<')
        fail(start, joined({"<", tag, " is not ended by '>'"}));
      const std::size_t here = at_;
      const std::string_view attribute = name();
      if (attribute.empty())
        fail(here, joined({"'", text_.substr(here, 1), "' where an attribute is due"}));
      if (here == before)
        fail(here, joined({"a blank is missing before the attribute ", in_quotes(attribute)}));
      value_of(attribute, here);
      if (!attributes.insert(attribute).second) {
        fail(here, joined({"the attribute ", in_quotes(attribute), " is there twice"}));
      }
    }
    const bool is_empty = next() == '/';
    at_ += is_empty ? 2 : 1;
    if (!is_empty) open_.push_back({tag, start});
  }

  void value_of(std::string_view attribute, std::size_t here) {
    skip_blanks();
    if (next() != '=')
      fail(here, joined({"the attribute ", in_quotes(attribute), " has no value"}));
    ++at_;
    skip_blanks();
    const char quote = next();
    if (quote != '"' && quote != '\'') {
      fail(at_, joined({"the value of the attribute ", in_quotes(attribute), " is not in quotes"}));
    }
    const std::size_t end = text_.find(quote, at_ + 1);
    const std::size_t tag = text_.find('<', at_ + 1);
    if (end == std::string_view::npos || tag < end) {
      fail(at_, joined({"the value of the attribute ", in_quotes(attribute), " is not ended by ",
                        text_.substr(at_, 1)}));
    }
    at_ = end + 1;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool has_root_ = false;
  std::vector<Open> open_{};
};

}  // namespace

std::string xml_fault(std::string_view text) {
  try {
    Scanner(text).run();
  } catch (const Fault& fault) {
    return place_in(text, fault.at) + ": is not XML: " + fault.reason;
  }
  return {};
}

}  // namespace spherule::internal
