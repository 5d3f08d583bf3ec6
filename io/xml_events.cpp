// SPDX-License-Identifier: BSD-3-Clause
#include "io/xml_events.h"

#include "base/error.h"
#include "base/parser_fault.h"

#include <exception>
#include <expat.h>
#include <limits>
#include <memory>

namespace spherule::internal {
namespace {

constexpr std::size_t kMaxNamespace = 1000;
constexpr int kMaxDepth = 200;

// Exceptions must not pass through the parser, which is C: they are kept until it has stopped.
class Parser {
 public:
  Parser(const std::string& subject, XmlHandler& handler)
      : parser_(XML_ParserCreateNS(nullptr, '|'), &XML_ParserFree),
        subject_(subject),
        handler_(handler) {
    if (!parser_) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(
        parser_.get(),
        [](void* self, const char* name, const char** attributes) {
          static_cast<Parser*>(self)->open(name, attributes);
        },
        [](void* self, const char*) { static_cast<Parser*>(self)->close(); });
    // expat copies the namespace for each name that has its prefix.
    XML_SetStartNamespaceDeclHandler(parser_.get(), [](void* self, const char*, const char* uri) {
      static_cast<Parser*>(self)->guarded([&](Parser& p) {
        if (uri != nullptr && std::string_view(uri).size() > kMaxNamespace) {
          throw Error(p.subject_, "an XML namespace of more than 1000 bytes");
        }
      });
    });
    XML_SetStartDoctypeDeclHandler(
        parser_.get(), [](void* self, const char*, const char*, const char*, int) {
          static_cast<Parser*>(self)->guarded(
              [&](Parser& p) { throw Error(p.subject_, "XML with a document type"); });
        });
  }

  void run(std::string_view text) {
    if (text.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
      throw Error(subject_, "XML of more than 2^31 bytes");
    }
    const std::string large = fault_of_large_tag(text);
    if (!large.empty()) throw Error(subject_, large);
    const XML_Status status =
        XML_Parse(parser_.get(), text.data(), static_cast<int>(text.size()), XML_TRUE);
    if (fault_) std::rethrow_exception(fault_);
    if (status != XML_STATUS_OK) {
      throw Error(subject_,
                  "line " + std::to_string(XML_GetCurrentLineNumber(parser_.get())) +
                      ": is not XML: " + XML_ErrorString(XML_GetErrorCode(parser_.get())));
    }
  }

 private:
  void open(const char* name, const char* const* attributes) {
    guarded([&](Parser& p) {
      if (++p.depth_ > kMaxDepth) throw Error(p.subject_, "XML nested more than 200 deep");
      const XML_Index position = XML_GetCurrentByteIndex(p.parser_.get());
      p.handler_.open(name, XmlAttributes(attributes), static_cast<std::size_t>(position));
    });
  }

  void close() {
    guarded([](Parser& p) {
      --p.depth_;
      p.handler_.close();
    });
  }

  template <class Call>
  void guarded(const Call& call) {
    if (fault_) return;  // an event that was due when the parser was stopped
    try {
      call(*this);
    } catch (...) {
      fault_ = std::current_exception();
      XML_StopParser(parser_.get(), XML_FALSE);
    }
  }

  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  const std::string& subject_;
  XmlHandler& handler_;
  std::exception_ptr fault_;
  int depth_ = 0;  // of the open elements
};

}  // namespace

std::optional<std::string_view> XmlAttributes::find(std::string_view name) const {
  for (const char* const* pair = pairs_; *pair != nullptr; pair += 2) {
    if (pair[0] == name) return pair[1];
  }
  return std::nullopt;
}

void parse_xml(std::string_view text, const std::string& subject, XmlHandler& handler) {
  Parser(subject, handler).run(text);
}

}  // namespace spherule::internal
