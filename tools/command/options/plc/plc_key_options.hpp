// The options that set a PLC: the rows of tools/plan/plc_keys.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "tools/plan/plc_keys.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

class PlcKeyOptions {
 public:
  /// Adds the options of the keys that can be read at this stage.
  void add_to(CLI::App& app, PlcKey::Stage stage);

  /// Whether the option of that key was given.
  bool given(std::string_view key) const;

  /// Reads what was given into the settings; `space` is null where there is no one program. False after a message.
  bool read(PlcSettings& settings, const AddressSpace* space) const;

 private:
  struct Given {
    const PlcKey* key;
    std::vector<std::string> values{};
  };
  std::deque<Given> given_;  // the options hold on to their places
};

}  // namespace s7200::tools
