// What looks at a past that is played again.
#pragma once

#include <atomic>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// Sees every instruction, until a stop is asked for.
class Reader : public Observer {
 public:
  /// Of all stations. `stop_request` may be null; it is not owned.
  explicit Reader(StopToken stop_request) : stop_request_(stop_request) {}
  /// Of one station alone.
  Reader(std::size_t station, StopToken stop_request) : Observer(station), stop_request_(stop_request) {}

  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t) override { return !stop_request_.stop_requested(); }

 private:
  StopToken stop_request_;
};

}  // namespace s7200::tools
