// What keeps scenarios from being run, to be told in this order.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "interpreter/base/diagnostic.hpp"

namespace s7200::tools {

struct Message {
  enum class Kind : std::uint8_t { Error, Note, Diagnostics };

  Kind kind = Kind::Error;
  std::string text{};                                ///< of an error or note
  stl::Diagnostics diagnostics{};                    ///< of a text
  std::shared_ptr<const stl::SourceLines> source{};  ///< that text
};

using Messages = std::vector<Message>;

inline void add_error(Messages& messages, std::string text) { messages.push_back({.text = std::move(text)}); }

}  // namespace s7200::tools
