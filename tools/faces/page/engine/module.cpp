// The engine as a module of WebAssembly: a reactor, which is called and returns. A page writes a message into room(size),
// calls take(size), and reads what came of it: next() is the size of a message, or -1 after the last one, and message()
// where it is, until next() is called again.
#include <cstdint>
#include <deque>
#include <string>
#include <utility>

#include "tools/faces/page/engine/engine.hpp"

namespace s7200::tools::page {
namespace {

struct Module {
  std::string in{}, current{};
  std::deque<std::string> out{};
  Engine engine{[this](std::string message) { out.push_back(std::move(message)); }};
};

Module& module() {
  static Module the_only_one;
  return the_only_one;
}

}  // namespace
}  // namespace s7200::tools::page

extern "C" {

using s7200::tools::page::module;

[[clang::export_name("room")]] char* room(std::uint32_t size) {
  module().in.resize(size);
  return module().in.data();
}

[[clang::export_name("take")]] void take(std::uint32_t size) {
  module().engine.take(std::string_view(module().in).substr(0, size));
}

[[clang::export_name("next")]] std::int32_t next() {
  if (module().out.empty()) return -1;
  module().current = std::move(module().out.front());
  module().out.pop_front();
  return static_cast<std::int32_t>(module().current.size());
}

[[clang::export_name("message")]] const char* message() { return module().current.data(); }
}
